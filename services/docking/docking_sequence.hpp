// The follower's side of a docking and of an undocking: align in front of the target's port, approach, push
// until the latch reports, and fall back and try again where it goes wrong. maths.md section 3.
// Either port may be the target's: all gaps count along the target's port axis, outward.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/chain/claim.hpp"
#include "services/docking/approach_path.hpp"

namespace eciton::docking {

using chain::LatchStatus;

/// Standoff, tolerances and the dual condition: maths.md section 3. The rest are bounds on waiting.
struct DockingConfig {
  ApproachPathConfig path;
  double standoff_m = 0.30;
  double align_axial_m = 0.025;
  double align_radial_m = 0.025;
  double align_attitude_rad = 0.06;
  double align_hold_s = 0.3;
  double align_time_out_s = 30;
  double chain_align_time_out_s = 90;  // a chain turns slowly

  double approach_speed_m_s = 0.3;
  double gap_m_min = -0.10;  // how far the reference goes on beyond contact, to push
  double recover_radial_m = 0.05;
  double push_time_out_s = 2.0;  // at the end of the ramp, neither declared nor latched
  double recover_speed_m_s = 0.6;
  double chain_recover_speed_m_s = 0.3;
  std::uint32_t recoveries_max = 20;

  double declare_axial_m = 0.0125;
  double declare_radial_m = 0.025;
  double declare_push_N = 3.0;
  double declare_push_gap_m = 0.15;  // commanded
  double latch_time_out_s = 1.0;     // declared, but the latch does not report: a false declaration
  double settle_s = 0.5;             // from pushing to a gap of zero, once latched
  double view_time_out_s = 10;       // latched, but there is no view with both in it

  double release_time_out_s = 5;  // until both latches report open and the view has let go
  double retreat_acceleration_m_s2 = 0.5;
  double retreat_speed_m_s = 0.2;
  double retreat_gap_m = 0.5;
};

enum class DockingPhase : std::uint8_t { idle, align, approach, assembly, docked, recover, release, retreat };
enum class DeclaredBy : std::uint8_t { nothing, pose, wrench };
enum class Failure : std::uint8_t {
  none,
  aborted,
  target_silent,
  align_time_out,
  too_many_recoveries,
  no_view,     // latched, but the members did not agree
  latch_stuck  // a latch did not report open, or the view did not let go: still holding
};
std::string_view to_text(Failure failure);

enum class Outcome : std::uint8_t { none, running, docked, undocked, failed };

struct DockingInputs {
  Pose X_TF;                              // as measured; the last known while the target is silent
  double push_N = 0;                      // see push_N() in port_relation.hpp; bias removed
  LatchStatus latch = LatchStatus::open;  // of the follower's port
  LatchStatus target_latch = LatchStatus::open;
  bool target_fresh = false;
  bool view_active = false;           // a view with both modules in it is active here
  bool abort = false;                 // asked for; acts until the latch has closed
  std::span<const Vector3> bodies_T;  // centres of other bodies to stay clear of on the way, m
};

struct DockingOutputs {
  DockingPhase phase = DockingPhase::idle;
  Outcome outcome = Outcome::none;
  Failure failure = Failure::none;
  Pose X_TF_reference;                       // where the follower's port shall be
  Vector3 v_TF_reference = Vector3::Zero();  // axes of T
  Vector3 w_TF_reference = Vector3::Zero();
  double gap_m_commanded = 0;
  bool engage_latch = false;  // of the follower's port; the last word stands after the end
  PortRelation measured;
  DeclaredBy declared_by = DeclaredBy::nothing;
  std::uint32_t recoveries = 0;
  std::uint32_t false_declarations = 0;
};

/// Real-time safe. One object per module; `start_*` begins anew whatever went before.
class DockingSequence {
 public:
  explicit DockingSequence(const DockingConfig& config) : config_(config), path_(config.path) {}

  /// `bodies_F`: centres of the rest of the follower's chain, axes and origin of F; they stay clear of others too.
  void start_docking(PortKind target_port, const Pose& X_TF, std::span<const Vector3> bodies_F = {});
  void start_undocking(PortKind target_port, const Pose& X_TF);
  const DockingOutputs& update(double dt_s, const DockingInputs& in);
  const DockingOutputs& outputs() const { return out_; }

 private:
  void begin(PortKind target_port, const Pose& X_TF);
  void enter(DockingPhase phase);
  void align(double dt_s, const DockingInputs& in);
  void approach(double dt_s, const DockingInputs& in);
  void assemble(double dt_s, const DockingInputs& in);
  void recover(double dt_s);
  void release(const DockingInputs& in);
  void retreat(double dt_s);

  bool give_up(const DockingInputs& in);
  void fail_by_retreat(Failure failure);
  void finish(Outcome outcome, Failure failure);
  DeclaredBy declaration(const DockingInputs& in) const;
  void try_again();
  void move_gap(double dt_s, double to_m, double speed_m_s);

  DockingConfig config_;
  ApproachPath path_;
  PortKind target_port_ = PortKind::male;
  DockingOutputs out_;
  double in_phase_s_ = 0;
  double aligned_s_ = 0;
  double pushing_s_ = 0;    // at the end of the ramp
  double unlatched_s_ = 0;  // since the declaration
  double latched_s_ = 0;
  Failure pending_ = Failure::none;
};

}  // namespace eciton::docking
