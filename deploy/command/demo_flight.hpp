// The flight of a demo, step by step: sends goals as an operator does, waits for what they lead to, and ends
// with the first step that fails.
#pragma once

#include <functional>
#include <map>
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

struct DockingRecord {
  std::uint32_t follower = 0;
  std::uint32_t target = 0;
  double time_s = 0;  // from accepted to succeeded, on the modules' clock
  std::string declared_by;
  std::uint32_t recoveries = 0;
};

/// What a flight has shown.
struct DemoResult {
  std::vector<DockingRecord> dockings;
  DemoFigures figures;
  bool assembled = false;
  bool morphed = false;
  bool separated = false;
  double simulated_s = 0;
  double wall_s = 0;
};

/// Why a flight did not come to its end.
struct DemoFailure {
  std::string step;
  std::string why;
  std::set<std::string> processes;  // "m2/control": those whose logs may tell more
  bool interrupted = false;
};

class DemoFlight {
 public:
  DemoFlight(const DemoFleet& fleet, Launches& launches, const runtime::StopFlag& stop, DemoView& view);

  /// Nothing when all went well.
  std::optional<DemoFailure> fly();

  const DemoResult& result() const { return result_; }
  const std::vector<std::unique_ptr<DemoEar>>& ears() const { return ears_; }
  /// The last faults and refusals that modules told of.
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  using Goals = std::vector<std::uint64_t>;

  // Steps; each throws DemoFailure.
  void wait_for_modules();
  void arm_and_take_off();
  void hover_until_zeroed();
  void dock_all();
  void dock(std::uint32_t follower);
  /// Until the first so many modules all fly by one view of just themselves.
  void agree(std::size_t members);
  void hover_as_one_body();
  void morph();
  void undock_all();
  void spread_and_land();

  /// One look at everything; throws when a process ended or someone asked for the end.
  void pump();
  void take_faults();
  void draw(Duration monotonic);
  void begin(const std::string& step, DemoPhase phase);
  [[noreturn]] void fail(const std::string& why, std::set<std::string> processes = {});
  void wait_until(const std::function<bool()>& done, double timeout_s, const std::function<std::string()>& lacks);
  void hover(double seconds);
  void finish(const Goals& goals, double timeout_s);
  /// Until none of them is under way; refused ones are left to the caller.
  void follow(const Goals& goals, double timeout_s);
  double now_s() const;
  template <class Make>
  Goals for_each_module(Make make);
  const msg::ChainView* view_of(std::uint32_t id) const;
  std::set<std::string> logs_of(std::uint32_t id) const;

  DemoFleet fleet_;
  Launches& launches_;
  const runtime::StopFlag& stop_;
  DemoView& view_;
  bus::Participant swarm_;
  Operator operator_;
  bus::Reader<msg::Fault> fault_;
  std::vector<std::unique_ptr<DemoEar>> ears_;
  std::vector<std::uint32_t> ids_;

  std::string step_;
  DemoPhase phase_ = DemoPhase::grounded;
  DemoResult result_;
  std::vector<std::string> faults_;
  Duration wall_begin_{};
  std::optional<TimePoint> time_begin_;
  TimePoint advanced_to_{};  // the modules' clock ...
  Duration advanced_at_{};   // ... and when it last moved
  Duration speed_wall_{};
  double speed_simulated_s_ = 0;
  double speed_factor_ = 0;
};

}  // namespace eciton::deploy
