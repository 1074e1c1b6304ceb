// Flying a fleet of processes step by step: sends goals as an operator does, waits for what they lead to, and ends
// with the first step that fails. What the steps are is the demo's or the chaos run's.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/runtime/stop_signal.hpp"
#include "deploy/command/demo_ears.hpp"
#include "deploy/command/demo_fleet.hpp"
#include "deploy/command/demo_view.hpp"
#include "deploy/operator/operator.hpp"

namespace eciton::deploy {

/// Why a flight did not come to its end.
struct FlightFailure {
  std::string step;
  std::string why;
  std::set<std::string> processes;  // "m2/control": those whose logs may tell more
  bool interrupted = false;
};

/// "1-2-3"
std::string members_text(const msg::ChainView& view);

class FleetFlight {
 public:
  FleetFlight(const DemoFleet& fleet, Launches& launches, const runtime::StopFlag& stop, DemoView& view);
  virtual ~FleetFlight() = default;
  FleetFlight(const FleetFlight&) = delete;
  FleetFlight& operator=(const FleetFlight&) = delete;

  const std::vector<std::unique_ptr<DemoEar>>& ears() const { return ears_; }
  /// The last faults and refusals that modules told of.
  const std::vector<std::string>& faults() const { return faults_; }

 protected:
  using Goals = std::vector<std::uint64_t>;

  // Steps; each throws FlightFailure.
  void wait_for_modules();
  void arm_and_take_off();
  void hover_until_zeroed();
  /// To the nearer end of the first module's chain, asking again while it is refused for want of zeroing.
  std::uint64_t dock(std::uint32_t follower);
  /// The end of the first module's chain that is nearer to the follower.
  std::uint32_t target_for(std::uint32_t follower) const;
  /// Until the first so many modules all fly by one view of just themselves.
  void agree(std::size_t members);
  void undock_all();
  /// All modules, apart, to where they hovered first.
  void go_home();
  std::array<double, 3> home_m(std::size_t module) const;
  void spread_and_land();

  /// A process ended by itself. A failure, unless someone meant it to.
  virtual void on_end(Launch& launch, const ChildReport& report);

  /// One look at everything; throws when a process ended or someone asked for the end.
  void pump();
  void begin(const std::string& step, DemoPhase phase);
  [[noreturn]] void fail(const std::string& why, std::set<std::string> processes = {});
  void wait_until(const std::function<bool()>& done, double timeout_s, const std::function<std::string()>& lacks);
  void hover(double seconds);
  void finish(const Goals& goals, double timeout_s);
  /// Until none of them is under way; refused ones are left to the caller.
  void follow(const Goals& goals, double timeout_s);
  double now_s() const;
  template <class Make>
  Goals for_each_module(Make make) {
    Goals goals;
    for (std::size_t k = 0; k < ids_.size(); ++k) goals.push_back(make(ids_[k], k));
    return goals;
  }
  const msg::ChainView* view_of(std::uint32_t id) const;
  std::set<std::string> logs_of(std::uint32_t id) const;

  DemoFleet fleet_;
  Launches& launches_;
  const runtime::StopFlag& stop_;
  DemoView& view_;
  bus::Participant swarm_;
  Operator operator_;
  std::vector<std::unique_ptr<DemoEar>> ears_;
  std::vector<std::uint32_t> ids_;
  std::string step_;
  DemoPhase phase_ = DemoPhase::grounded;
  DemoFigures figures_;
  Duration wall_begin_{};

 private:
  void take_faults();
  void draw(Duration monotonic);

  bus::Reader<msg::Fault> fault_;
  std::vector<std::string> faults_;
  std::optional<TimePoint> time_begin_;
  TimePoint advanced_to_{};  // the modules' clock ...
  Duration advanced_at_{};   // ... and when it last moved
  Duration speed_wall_{};
  double speed_simulated_s_ = 0;
  double speed_factor_ = 0;
};

}  // namespace eciton::deploy
