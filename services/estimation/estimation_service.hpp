// From IMU and pose to the module's state, from state and rotors to the external wrench, and from the
// members' wrenches to the contact wrenches of the chain.
#pragma once

#include <array>
#include <span>

#include "core/base/config.hpp"
#include "core/bus/participant.hpp"
#include "core/robot/actuator_lag.hpp"
#include "core/robot/kinematics.hpp"
#include "core/runtime/service.hpp"
#include "idl/topics.hpp"
#include "services/estimation/contact_wrench.hpp"
#include "services/estimation/error_state_filter.hpp"
#include "services/estimation/momentum_observer.hpp"
#include "services/estimation/sensor_watch.hpp"
#include "services/estimation/zeroing.hpp"

namespace eciton::estimation {

struct EstimationConfig {
  std::uint32_t module_id = 0;
  double wrench_rate_Hz = 100;
  double observer_gain_1_s = 10;
  bool zeroing = true;         // false: a controller on wrenches that were never zeroed (an experiment's control)
  bool refuses_frozen = true;  // false: for a world whose sensors have no noise
  double imu_silent_s = 0.05;  // without a good sample: the state is lost

  template <class V>
  void visit_fields(V& v) {
    v("wrench_rate_Hz", wrench_rate_Hz, in_range(10, 500));
    v("observer_gain_1_s", observer_gain_1_s, in_range(0.5, 50));
    v("zeroing", zeroing);
    v("refuses_frozen", refuses_frozen);
    v("imu_silent_s", imu_silent_s, in_range(0.01, 0.1));
  }
};

class EstimationService final : public runtime::Service {
 public:
  EstimationService(bus::Participant& ring, const EstimationConfig& config, const robot::Airframe& airframe);

  std::string_view name() const override { return "estimation"; }
  runtime::Schedule schedule() override {
    using namespace std::chrono_literals;
    return runtime::on(imu_, 5ms, runtime::Phase::estimate);
  }
  void step(TimePoint now) noexcept override;
  void describe(msg::Heartbeat& heartbeat) const noexcept override;
  /// The zero, which cannot be measured again in a chain.
  std::uint32_t state_version() const noexcept override { return 1; }
  void save_state(runtime::StateWriter& writer) const noexcept override { writer(last_step_, zeroing_); }
  void load_state(runtime::StateReader& reader) noexcept override;

 private:
  void take_actuators(TimePoint now) noexcept;
  void take_chain(TimePoint now) noexcept;
  void take_zero_requests(TimePoint now) noexcept;
  void take_sensors(TimePoint now) noexcept;
  void take_imu(const msg::Imu& imu, TimePoint now) noexcept;
  void take_pose(const msg::PoseMeasurement& pose, TimePoint now) noexcept;
  void watch_silence(TimePoint now) noexcept;
  void watch_bus(TimePoint now) noexcept;
  void observe(TimePoint now) noexcept;
  void zero(const robot::BiasJacobian& jacobian_M, double dt_s, TimePoint now) noexcept;
  void publish_state(TimePoint now) noexcept;
  void publish_external_wrench(TimePoint now) noexcept;
  void publish_contact_wrench(TimePoint now) noexcept;
  /// Why the wrench cannot be zeroed now, or null.
  const char* not_free() const;
  std::span<const double> joint_angles() const { return std::span(joint_rad_).first(airframe_.joints.size()); }
  void report_mode(TimePoint now) noexcept;
  void publish_model_errors(TimePoint now) noexcept;
  void report_zeroing(ZeroingPhase before, TimePoint now) noexcept;
  void report_refusals(TimePoint now) noexcept;
  void answer_zero(std::uint64_t correlation_id, msg::GoalPhase phase, std::string_view reason,
                   TimePoint now) noexcept;

  /// Whose samples are refused.
  enum class Device { imu, pose, joints, rotors, peers, output, count };
  RefusalSpell& spell(Device device) { return spells_[static_cast<std::size_t>(device)]; }

  EstimationConfig config_;
  robot::Airframe airframe_;
  Duration wrench_period_;
  ErrorStateFilter filter_;
  MomentumObserver observer_;
  Zeroing zeroing_;
  ImuCheck imu_check_;
  PoseCheck pose_check_;
  std::array<RefusalSpell, static_cast<std::size_t>(Device::count)> spells_;
  robot::ActuatorLag rotors_;
  std::array<robot::RotorOutput, robot::rotors_max> rotor_command_{};
  bool armed_ = false;
  std::array<double, robot::joints_max> joint_rad_{};
  struct CentreOfMass {
    robot::Vector3 p_WM = robot::Vector3::Zero();
    robot::Vector3 v_WM = robot::Vector3::Zero();
  };
  Estimate estimate_;
  CentreOfMass state_;
  robot::Wrench external_W_;  // about the composite centre of mass, bias removed
  msg::ExternalWrench own_;

  msg::ChainView view_;                          // the active one
  bool touching_ = false;                        // or about to: the zero stays as it is
  std::array<msg::ExternalWrench, 16> heard_{};  // by place in the chain
  std::array<TimePoint, 16> heard_at_{};

  bool zero_asked_ = false;
  std::uint64_t zero_goal_ = 0;  // to answer; 0: none
  std::uint64_t zero_answered_ = 0;
  bool zeroing_interrupted_ = false;
  std::optional<TimePoint> imu_heard_, pose_heard_;   // good or not, to 10 ms
  bus::ReaderStatistics imu_dropped_, pose_dropped_;  // by the bus, when last looked at
  std::int64_t observed_ns_ = 0;                      // the state the observer last saw

  TimePoint last_step_{};
  TimePoint saved_at_{};  // of the checkpoint it goes on from
  TimePoint wrench_due_{};
  bool first_step_ = true;
  msg::EstimatorMode reported_mode_ = msg::EstimatorMode::initialising;

  bus::Reader<msg::Imu> imu_;
  bus::Reader<msg::PoseMeasurement> pose_;
  bus::Reader<msg::RotorCommand> rotor_commands_;
  bus::Reader<msg::JointState> joint_state_;
  bus::Reader<msg::ChainView> chain_view_;
  bus::Reader<msg::DockingState> docking_state_;
  bus::Reader<msg::ExternalWrench> external_wrenches_;
  bus::Reader<msg::ModeRequest> mode_request_;
  bus::Writer<msg::ModuleState> module_state_;
  bus::Writer<msg::ExternalWrench> external_wrench_;
  bus::Writer<msg::ContactWrench> contact_wrench_;
  bus::Writer<msg::ModelErrors> model_errors_;
  bus::Writer<msg::GoalStatus> goal_status_;
  bus::Writer<msg::Event> event_;
  bus::Writer<msg::Fault> fault_;
};

}  // namespace eciton::estimation
