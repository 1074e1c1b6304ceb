// The world's step, and what may be asked of it.
#include "hal/sim/world.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "core/robot/kinematics.hpp"
#include "hal/sim/module.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;
using robot::Wrench;

constexpr Duration step_duration = 1ms;
constexpr int air_period_steps = 2;  // gusts and wakes are slow beside 2 ms
/// Closer than this, at the start, two modules' frames would be inside each other.
constexpr double start_distance_m_min = 0.4;

void check(const robot::Airframe& airframe, const std::vector<ModuleStart>& starts) {
  const auto refuse = [](const std::string& message) { throw BadInput{Error{"simulated world: " + message}}; };
  if (starts.empty() || starts.size() > max_modules) {
    refuse(std::to_string(starts.size()) + " modules; it takes 1 to " + std::to_string(max_modules));
  }
  if (airframe.rotors.size() > max_rotors || airframe.joints.size() > max_joints ||
      airframe.ports.size() > max_ports) {
    refuse("airframe " + airframe.name + " has more than 8 rotors, 8 joints or 4 ports");
  }
  for (const robot::PortGeometry& port : airframe.ports) {
    if (port.joint < 0 || static_cast<std::size_t>(port.joint) >= airframe.joints.size()) {
      refuse("airframe " + airframe.name + " has a port on joint " + std::to_string(port.joint) + ", which it lacks");
    }
  }
  for (std::size_t i = 0; i < starts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::string both = "modules " + std::to_string(starts[j].id) + " and " + std::to_string(starts[i].id);
      if (starts[i].id == starts[j].id) refuse("two modules have the id " + std::to_string(starts[i].id));
      const Vector3 apart = Vector3(starts[i].p_WB_m.data()) - Vector3(starts[j].p_WB_m.data());
      if (apart.norm() < start_distance_m_min) refuse(both + " start less than 0.4 m apart");
    }
  }
}

}  // namespace

struct World::Impl {
  Impl(const WorldConfig& config_in, const robot::Airframe& airframe_in, const std::vector<ModuleStart>& starts);

  void step();
  void read_motion();
  void update_air();
  Wrench jets_on(std::size_t i) const;
  double wake_deviation_on(std::size_t i) const;
  void apply_forces();
  void find_fault();
  std::size_t index(std::uint32_t id) const;

  WorldConfig config;
  robot::Airframe airframe;
  WorldModel world;
  std::vector<std::uint32_t> ids;
  std::vector<SimModule> modules;
  std::optional<Couplings> couplings;
  std::vector<Vector3> v_before;
  std::vector<robot::Pose> X_WB;  // at the beginning of the step
  Vector3 wind_W_N;
  TimePoint now;
  std::uint64_t steps = 0;
  std::optional<Error> fault;
};

World::Impl::Impl(const WorldConfig& config_in, const robot::Airframe& airframe_in,
                  const std::vector<ModuleStart>& starts)
    : config(config_in),
      airframe(airframe_in),
      v_before(starts.size(), Vector3::Zero()),
      X_WB(starts.size()),
      wind_W_N(config_in.wind_N.data()),
      now(from_ns(static_cast<std::int64_t>(config_in.start_ns))) {
  check(airframe, starts);
  std::vector<Mismatch> mismatch(starts.size());
  if (config.world != "ideal") {
    for (std::size_t i = 0; i < starts.size(); ++i) {
      mismatch[i] =
          draw_mismatch(airframe, Random(config.seed, starts[i].id, Purpose::mismatch), config.full_joint_offset);
    }
  }
  world = value_or_throw(build_model(config, airframe, starts, mismatch));
  modules.reserve(starts.size());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    ids.push_back(starts[i].id);
    modules.emplace_back(config, airframe, starts[i], world.modules[i], mismatch[i]);
  }
  couplings.emplace(world, config.break_what == "weld-off");
  mj_forward(world.model.get(), world.data.get());
  read_motion();
  update_air();
  apply_forces();
  mj_forward(world.model.get(), world.data.get());
  for (SimModule& module : modules) module.start_sensors(now, world.data.get());
}

std::size_t World::Impl::index(std::uint32_t id) const {
  const auto found = std::find(ids.begin(), ids.end(), id);
  ECITON_EXPECT(found != ids.end(), "the simulated world has no such module");
  return found == ids.end() ? 0 : static_cast<std::size_t>(found - ids.begin());
}

void World::Impl::step() {
  mjModel* m = world.model.get();
  mjData* d = world.data.get();
  read_motion();
  mj_step1(m, d);
  std::fill_n(d->qfrc_applied, m->nv, 0.0);
  for (SimModule& module : modules) module.step_actuators(d);
  couplings->step();
  if (steps % air_period_steps == 0) update_air();
  apply_forces();
  mj_step2(m, d);
  ++steps;
  now += step_duration;
  for (std::size_t i = 0; i < modules.size(); ++i) modules[i].step_sensors(now, d, v_before[i], X_WB[i].R);
  find_fault();
}

void World::Impl::read_motion() {
  for (std::size_t i = 0; i < modules.size(); ++i) {
    X_WB[i] = modules[i].X_WB(world.data.get());
    v_before[i] = modules[i].v_WB(world.data.get());
  }
}

void World::Impl::apply_forces() {
  for (std::size_t i = 0; i < modules.size(); ++i) {
    const SimModule& module = modules[i];
    module.apply(module.rotor_wrench_B_W(X_WB[i].R) + module.air + module.external, X_WB[i].R, world.data.get());
  }
}

void World::Impl::update_air() {
  const double dt_s = air_period_steps * step_s;
  for (std::size_t i = 0; i < modules.size(); ++i) {
    SimModule& module = modules[i];
    // Both processes always run, so that switching one on does not shift the other's numbers.
    const Vector3 gust = module.gust.step(dt_s, gust_time_s), wake = module.wake.step(dt_s, wake_time_s);
    module.air = {};
    module.air.force = wind_W_N + config.gust_N * gust.cwiseProduct(Vector3(1, 1, 0.5));
    if (!config.wakes) continue;
    module.air.force += wake_deviation_on(i) * wake;
    module.air += jets_on(i);
  }
}

double World::Impl::wake_deviation_on(std::size_t i) const {
  const double hover_N = airframe.hover_thrust_N() * static_cast<double>(airframe.rotors.size());
  double variance = 0;
  for (std::size_t j = 0; j < modules.size(); ++j) {
    if (j == i) continue;
    const double distance_m = (X_WB[i].p - X_WB[j].p).norm();
    const double deviation_N = wake_deviation_N(distance_m, modules[j].thrust_N() / hover_N);
    variance += deviation_N * deviation_N;
  }
  return std::sqrt(variance);
}

/// The jets of all other modules' rotors on this one: on its middle and on each of its rotors' housings.
Wrench World::Impl::jets_on(std::size_t i) const {
  const robot::Pose& X_WM = X_WB[i];
  Wrench sum;
  for (std::size_t j = 0; j < modules.size(); ++j) {
    if (j == i) continue;
    const robot::Pose& X_WN = X_WB[j];
    if ((X_WN.p - X_WM.p).squaredNorm() > 25.0) continue;  // a jet of 5 m length is down to 4 m/s
    for (std::size_t k = 0; k < airframe.rotors.size(); ++k) {
      const RotorActuator& rotor = modules[j].rotors()[k];
      const JetSource jet{X_WN * airframe.rotors[k].p_BR_m, -(X_WN.R * rotor.direction_B()), rotor.thrust_N()};
      sum.force += jet_force_N(jet, X_WM.p);
      for (const robot::RotorGeometry& patch : airframe.rotors) {
        const Vector3 lever = X_WM.R * patch.p_BR_m;
        sum += robot::shift({jet_force_N(jet, X_WM.p + lever), Vector3::Zero()}, lever);
      }
    }
  }
  return sum;
}

/// MuJoCo answers a state that is no number by a silent reset; that must not pass for physics.
void World::Impl::find_fault() {
  const mjData* d = world.data.get();
  for (const int warning : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC, mjWARN_CNSTRFULL, mjWARN_CONTACTFULL}) {
    if (d->warning[warning].number == 0) continue;
    fault = Error{"the simulated world broke down " + std::to_string(steps) + " ms after its start: " +
                  mju_warningText(warning, d->warning[warning].lastinfo) + " seed " + std::to_string(config.seed)};
    return;
  }
}

World::World(const WorldConfig& config, const robot::Airframe& airframe, const std::vector<ModuleStart>& starts)
    : impl_(std::make_unique<Impl>(config, airframe, starts)) {}
World::~World() = default;

TimePoint World::now() const { return impl_->now; }

void World::advance(TimePoint until) {
  while (impl_->now + step_duration <= until) {
    if (impl_->fault) {
      impl_->now += step_duration;
    } else {
      impl_->step();
    }
  }
}

void World::skip(Duration duration) { impl_->now += duration; }

std::span<const std::uint32_t> World::modules() const { return impl_->ids; }
bool World::has(std::uint32_t module) const {
  return std::find(impl_->ids.begin(), impl_->ids.end(), module) != impl_->ids.end();
}
const robot::Airframe& World::airframe() const { return impl_->airframe; }

SensorFrame World::sense(std::uint32_t module) const {
  const std::size_t i = impl_->index(module);
  SensorFrame frame;
  frame.stamp = impl_->now;
  impl_->modules[i].fill(frame);
  const std::size_t ports = impl_->airframe.ports.size();
  for (std::size_t p = 0; p < ports; ++p) frame.latches[p] = impl_->couplings->reading(i * ports + p);
  return frame;
}

void World::actuate(std::uint32_t module, const ActuatorFrame& frame) {
  const std::size_t i = impl_->index(module);
  impl_->modules[i].command() = frame;
  const std::size_t ports = impl_->airframe.ports.size();
  for (std::size_t p = 0; p < ports; ++p) impl_->couplings->command(i * ports + p, frame.latches[p]);
}

void World::cut(std::uint32_t module) {
  ActuatorFrame& command = impl_->modules[impl_->index(module)].command();
  command.armed = false;
  command.joints_powered = false;
}

TruthPose World::truth_pose(std::uint32_t module) const {
  const SimModule& m = impl_->modules[impl_->index(module)];
  const mjData* d = impl_->world.data.get();
  const robot::Airframe& airframe = impl_->airframe;
  std::array<double, max_joints> joint_rad{};
  m.joint_angles(d, joint_rad);
  const Vector3 c_B = robot::com_offset_B(airframe, std::span(joint_rad).first(airframe.joints.size()));
  Vector3 c_dot_B = Vector3::Zero();
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
    const robot::JointGeometry& joint = airframe.joints[k];
    const Vector3 p_L = Eigen::AngleAxisd(joint_rad[k], joint.axis_B) * joint.p_JL_m;
    c_dot_B += joint.link_mass_kg / airframe.mass_kg * d->qvel[m.index().joint_dof[k]] * joint.axis_B.cross(p_L);
  }
  TruthPose truth;
  truth.stamp = impl_->now;
  truth.X_WB = m.X_WB(d);
  truth.v_WB_m_s = m.v_WB(d);
  truth.w_WM_M_rad_s = m.w_WB_B(d);
  truth.p_WM_m = truth.X_WB * c_B;
  truth.v_WM_m_s = truth.v_WB_m_s + truth.X_WB.R * (truth.w_WM_M_rad_s.cross(c_B) + c_dot_B);
  return truth;
}

JointReading World::truth_joint(std::uint32_t module, std::size_t joint) const {
  const SimModule& m = impl_->modules[impl_->index(module)];
  const mjData* d = impl_->world.data.get();
  return {.position_rad = d->qpos[m.index().joint_qpos[joint]],
          .velocity_rad_s = d->qvel[m.index().joint_dof[joint]],
          .torque_Nm = m.joint(joint).torque_Nm()};
}

std::optional<TruthContact> World::truth_contact(std::uint32_t module, std::size_t port) const {
  const std::size_t male = impl_->index(module) * impl_->airframe.ports.size() + port;
  if (impl_->world.ports[male].kind != robot::PortKind::male) return std::nullopt;
  const std::optional<std::size_t> pair = impl_->couplings->pair_of(male);
  if (!pair) return std::nullopt;
  const std::size_t female = impl_->world.pairs[*pair].female;
  const LinkForce link = impl_->couplings->force(*pair);
  TruthContact truth;
  truth.stamp = impl_->now;
  truth.module_id = module;
  truth.port = static_cast<std::uint32_t>(port);
  truth.peer_id = impl_->ids[impl_->world.ports[female].module];
  truth.peer_port = static_cast<std::uint32_t>(impl_->world.ports[female].port);
  truth.p_W_m = link.p_W_m;
  truth.wrench_P_W = link.wrench_P_W;
  truth.gap_m = (impl_->couplings->port_pose_W(female).p - link.p_W_m).norm();
  return truth;
}

double World::true_mass_kg(std::uint32_t module) const {
  return impl_->modules[impl_->index(module)].mismatch().mass_scale * impl_->airframe.mass_kg;
}

int World::latched_links() const { return impl_->couplings->held(); }

std::vector<double> World::posture() const {
  std::vector<double> out;
  const mjData* d = impl_->world.data.get();
  for (const SimModule& module : impl_->modules) {
    const double* free_joint = d->qpos + module.index().qpos;
    out.insert(out.end(), free_joint, free_joint + 7);
    for (std::size_t k = 0; k < impl_->airframe.joints.size(); ++k) {
      out.push_back(d->qpos[module.index().joint_qpos[k]]);
    }
    for (const RotorActuator& rotor : module.rotors()) {
      out.insert(out.end(), rotor.gimbal_rad().begin(), rotor.gimbal_rad().end());
    }
  }
  return out;
}

void World::set_external_wrench(std::uint32_t module, const Wrench& wrench_B_W) {
  impl_->modules[impl_->index(module)].external = wrench_B_W;
}

void World::set_wind(const Vector3& force_W_N) { impl_->wind_W_N = force_W_N; }

void World::break_sensor(std::uint32_t module, SimSensor sensor, const SensorFault& fault) {
  impl_->modules[impl_->index(module)].break_sensor(sensor, fault, impl_->now);
}

const std::optional<Error>& World::fault() const { return impl_->fault; }

}  // namespace eciton::hal::sim
