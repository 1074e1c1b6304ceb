// The life of a link: magnet, seat, capture, weld, release.
#include "hal/sim/couplings.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::hal::sim {
namespace {

using robot::Matrix3;
using robot::Pose;
using robot::Vector3;
using RowMatrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// The magnets' pull and where the latch closes: LEGION's hardware.
constexpr double magnet_N = 265, magnet_gap_m = 0.0015, magnet_N_max = 20, magnet_reach_m = 0.030;
constexpr double seat_axial_m = 0.006, seat_radial_m = 0.008, seat_angle_rad = 0.2;
/// After a release the tip is inside the cone: contacts come back when it has left.
constexpr double parted_m = 0.050;
// Capture: the weld takes hold where the parts are, softly, and slides to its seat while it hardens.
// A hard weld at once shows 2.7 kN; this way the peak stays below the coupling's 300 N by far.
constexpr int capture_steps = 200;
constexpr double soft_s = 0.050, hard_s = 0.004;

}  // namespace

Couplings::Couplings(WorldModel& world, bool weld_off) : world_(world), weld_off_(weld_off) {
  const mjModel* m = world.model.get();
  ports_.resize(world.ports.size());
  pairs_.resize(world.pairs.size());
  contype_.assign(m->geom_contype, m->geom_contype + m->ngeom);
  conaffinity_.assign(m->geom_conaffinity, m->geom_conaffinity + m->ngeom);
  row_force_.assign(static_cast<std::size_t>(m->njmax), 0.0);
  joint_force_.assign(static_cast<std::size_t>(m->nv), 0.0);
}

Pose Couplings::body_pose(int body) const {
  const mjData* d = world_.data.get();
  return {Eigen::Map<const Vector3>(d->xpos + 3 * body), Eigen::Map<const RowMatrix3>(d->xmat + 9 * body)};
}

Pose Couplings::port_pose_W(std::size_t port) const {
  return body_pose(world_.ports[port].link_body) * world_.ports[port].X_LP;
}

void Couplings::command(std::size_t port, LatchCommand command) {
  if (command == LatchCommand::engage) ports_[port].engaged = true;
  if (command == LatchCommand::release) {
    ports_[port].engaged = false;
    ports_[port].reports = false;
  }
}

LatchReading Couplings::reading(std::size_t port) const {
  if (ports_[port].reports) return LatchReading::latched;
  return ports_[port].engaged ? LatchReading::ready : LatchReading::open;
}

std::optional<std::size_t> Couplings::pair_of(std::size_t port) const {
  const PortState& state = ports_[port];
  if (!state.occupied || pairs_[state.pair].phase == Phase::parting) return std::nullopt;
  return state.pair;
}

void Couplings::step() {
  for (std::size_t p = 0; p < ports_.size(); ++p) ports_[p].X_WP = port_pose_W(p);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const PairIndex& pair = world_.pairs[k];
    const bool engaged = ports_[pair.male].engaged && ports_[pair.female].engaged;
    switch (pairs_[k].phase) {
      case Phase::open:
        if (engaged) step_open(k);
        break;
      case Phase::capturing:
        step_capture(k);
        [[fallthrough]];
      case Phase::held:
        if (!engaged) open(k);
        break;
      case Phase::parting:
        if ((ports_[pair.male].X_WP.p - ports_[pair.female].X_WP.p).norm() < parted_m) break;
        for (const std::size_t port : {pair.male, pair.female}) {
          ports_[port].occupied = false;
          set_contact(port, true);
        }
        pairs_[k].phase = Phase::open;
        break;
    }
  }
}

void Couplings::step_open(std::size_t k) {
  const PairIndex& pair = world_.pairs[k];
  PortState &male = ports_[pair.male], &female = ports_[pair.female];
  if (male.occupied || female.occupied) return;
  if (male.reports || female.reports) return;  // a broken latch: neither its magnet nor its hook holds
  if ((male.X_WP.p - female.X_WP.p).squaredNorm() > magnet_reach_m * magnet_reach_m) return;
  pull(pair);
  if (!seated(pair)) return;
  male.reports = female.reports = true;
  if (!weld_off_) close(k);
}

/// The magnets draw the two docking points together.
void Couplings::pull(const PairIndex& pair) {
  const Vector3 a = ports_[pair.male].X_WP.p, b = ports_[pair.female].X_WP.p;
  const double gap_m = (b - a).norm();
  const double share = 1 + gap_m / magnet_gap_m;
  const Vector3 force = std::min(magnet_N / (share * share), magnet_N_max) / std::max(gap_m, 1e-4) * (b - a);
  const Vector3 reaction = -force;
  mjData* d = world_.data.get();
  const mjModel* m = world_.model.get();
  mj_applyFT(m, d, force.data(), nullptr, a.data(), world_.ports[pair.male].link_body, d->qfrc_applied);
  mj_applyFT(m, d, reaction.data(), nullptr, b.data(), world_.ports[pair.female].link_body, d->qfrc_applied);
}

bool Couplings::seated(const PairIndex& pair) const {
  const Pose X_MF = ports_[pair.male].X_WP.inverse() * ports_[pair.female].X_WP;
  return std::abs(X_MF.p.x()) < seat_axial_m && std::hypot(X_MF.p.y(), X_MF.p.z()) < seat_radial_m &&
         robot::log_so3(X_MF.R).norm() < seat_angle_rad;
}

void Couplings::close(std::size_t k) {
  const PairIndex& pair = world_.pairs[k];
  const PortIndex &male = world_.ports[pair.male], &female = world_.ports[pair.female];
  pairs_[k] = {.phase = Phase::capturing,
               .steps = 0,
               .X_AB = body_pose(male.link_body).inverse() * body_pose(female.link_body)};
  for (const std::size_t port : {pair.male, pair.female}) {
    ports_[port].occupied = true;
    ports_[port].pair = k;
    set_contact(port, false);
  }
  write_weld(k, 0);
  world_.model->eq_active[pair.equality] = 1;
  ++held_;
}

void Couplings::step_capture(std::size_t k) {
  PairState& state = pairs_[k];
  ++state.steps;
  const double x = std::min(1.0, static_cast<double>(state.steps) / capture_steps);
  write_weld(k, x);
  if (state.steps >= capture_steps) state.phase = Phase::held;
}

void Couplings::open(std::size_t k) {
  const PairIndex& pair = world_.pairs[k];
  world_.model->eq_active[pair.equality] = 0;
  ports_[pair.male].reports = ports_[pair.female].reports = false;
  pairs_[k].phase = Phase::parting;
  --held_;
}

void Couplings::set_contact(std::size_t port, bool on) {
  const PortIndex& index = world_.ports[port];
  mjModel* m = world_.model.get();
  for (int g = index.geom_first; g < index.geom_first + index.geom_count; ++g) {
    m->geom_contype[g] = on ? contype_[static_cast<std::size_t>(g)] : 0;
    m->geom_conaffinity[g] = on ? conaffinity_[static_cast<std::size_t>(g)] : 0;
  }
}

/// The weld `share` of the way from where it took hold to its seat. MuJoCo 2.2.2 keeps for a weld: a point
/// on the second body, the same point on the first, the second's attitude in the first, and the torque
/// scale; so the constraint acts at the docking point itself.
void Couplings::write_weld(std::size_t k, double share) {
  const PairIndex& pair = world_.pairs[k];
  const Pose& X_AM = world_.ports[pair.male].X_LP;
  const Pose& X_BF = world_.ports[pair.female].X_LP;
  const double s = share * share * (3 - 2 * share);  // starts and ends without a jerk
  const Vector3 p_AF = (1 - s) * (pairs_[k].X_AB * X_BF.p) + s * X_AM.p;
  const robot::Quaternion q_start(pairs_[k].X_AB.R), q_seat(Matrix3(X_AM.R * X_BF.R.transpose()));
  const robot::Quaternion q_AB = q_start.slerp(s, q_seat);
  mjModel* m = world_.model.get();
  double* data = m->eq_data + mjNEQDATA * pair.equality;
  Eigen::Map<Vector3>(data + 0) = X_BF.p;
  Eigen::Map<Vector3>(data + 3) = p_AF;
  data[6] = q_AB.w();
  data[7] = q_AB.x();
  data[8] = q_AB.y();
  data[9] = q_AB.z();
  data[10] = 1;
  m->eq_solref[mjNREF * pair.equality] = soft_s * std::pow(hard_s / soft_s, share);
  m->eq_solref[mjNREF * pair.equality + 1] = 1;
}

LinkForce Couplings::force(std::size_t k) {
  const PairIndex& pair = world_.pairs[k];
  const mjModel* m = world_.model.get();
  mjData* d = world_.data.get();
  LinkForce out{.p_W_m = port_pose_W(pair.male).p, .wrench_P_W = {}};
  // The weld's rows alone, through the transposed Jacobian, onto the six free dofs of the female's module:
  // there stands exactly what the link does to it as a whole.
  bool any = false;
  for (int row = 0; row < d->nefc; ++row) {
    const bool mine = d->efc_type[row] == mjCNSTR_EQUALITY && d->efc_id[row] == pair.equality;
    row_force_[static_cast<std::size_t>(row)] = mine ? d->efc_force[row] : 0.0;
    any = any || mine;
  }
  if (!any) return out;
  mj_mulJacTVec(m, d, joint_force_.data(), row_force_.data());
  const ModuleIndex& female = world_.modules[world_.ports[pair.female].module];
  const double* q = joint_force_.data() + female.dof;
  const Pose X_WB = body_pose(female.body);  // of the step that the rows belong to
  const robot::Wrench about_B{Eigen::Map<const Vector3>(q), X_WB.R * Eigen::Map<const Vector3>(q + 3)};
  out.wrench_P_W = robot::shift(about_B, X_WB.p - out.p_W_m);
  return out;
}

}  // namespace eciton::hal::sim
