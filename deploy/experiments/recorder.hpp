// Watches a simulated flight, tick by tick, from outside: what the physics knows of links, joints and poses, and
// what the services believe. Contact wrenches are low-passed at 5 Hz, as the papers' are.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/robot/trajectory.hpp"
#include "deploy/experiments/experiment.hpp"

namespace eciton::deploy {

/// Means and greatest values since `Recorder::start`, over time and over what is named.
struct FlightFigures {
  double contact_force_N_mean = 0, contact_force_N_max = 0;  // of the links
  double contact_torque_Nm_mean = 0, contact_torque_Nm_max = 0;
  double contact_force_N_mean_estimated = 0, contact_torque_Nm_mean_estimated = 0;
  double joint_torque_Nm_mean = 0, joint_torque_Nm_max = 0;  // of the joints in the links
  double joint_speed_rad_s_max = 0;
  double position_error_m_mean = 0, position_error_m_max = 0;  // of what is followed
  double attitude_error_rad_mean = 0, attitude_error_rad_max = 0;
  double speed_m_s_max = 0;
};

class Recorder {
 public:
  /// Observes from now on, for as long as the simulation runs: it must outlive it or be made with it.
  explicit Recorder(Simulation& simulation);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Whose poses are held against which reference, as a function of the simulation's time.
  using Reference = std::function<robot::PoseReference(double elapsed_s)>;
  void follow(std::uint32_t module, Reference reference);
  void follow(std::uint32_t module, const robot::Pose& X_WM);

  /// Begins counting anew; series go on until `stop`.
  void start();
  void stop() { recording_ = false; }
  FlightFigures figures() const;
  /// 100 a second: time_s, contact_force_N_<k>, contact_torque_Nm_<k> with _estimated beside them,
  /// joint_torque_Nm_<j>, joint_rad_<j>, position_error_m, attitude_error_rad, and the followed module's place and
  /// speed.
  const std::map<std::string, std::vector<double>>& series() const { return series_; }

  /// Greatest over the links now, low-passed.
  double contact_force_N() const;
  double contact_torque_Nm() const;
  /// Since `start`, of each module's male link that holds: the mean wrench, world axes.
  std::vector<robot::Wrench> mean_wrenches() const;
  /// Whose wrenches the followed module counts as fresh, itself with them.
  std::size_t members_heard() const { return estimate_ ? estimate_->fresh : 0; }

 private:
  struct Link {
    std::size_t module = 0;  // of the male port
    bool held = false;
    robot::Wrench sum;  // since `start`, of so many ticks
    std::size_t count = 0;
    robot::Wrench wrench;                 // low-passed
    std::array<double, 2> joint_rad_s{};  // low-passed: the male's joint, then the female's
  };
  struct Sum {
    double sum = 0, max = 0;
    std::size_t count = 0;
    void add(double value);
    double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
  };

  void look(TimePoint now);
  void look_at_links();
  void note_links();
  std::vector<std::size_t> chain_order() const;
  void look_at_followed(double elapsed_s, bool sampled);
  void note(const std::string& name, double value) { series_[name].push_back(value); }

  Simulation& simulation_;
  std::vector<Link> links_;  // one per module: its male port
  std::optional<bus::Reader<msg::ContactWrench>> estimates_;
  std::optional<msg::ContactWrench> estimate_;
  std::uint32_t followed_ = 0;
  Reference reference_;
  bool recording_ = false;
  std::uint64_t ticks_ = 0;
  Sum force_, torque_, force_estimated_, torque_estimated_, joint_torque_, joint_speed_, position_, attitude_, speed_;
  std::map<std::string, std::vector<double>> series_;
};

}  // namespace eciton::deploy
