// After start-up the framework's way from a writer to a reader leaves the heap alone, whatever the plugin.
// What the vendors' own libraries do is counted apart, and recorded.
#include "tests/allocation_guard/allocation_guard.hpp"

#include <optional>

#include "core/bus/inline_reader.hpp"
#include "tests/conformance/ring.hpp"

namespace eciton::bus::conformance {
namespace {

using eciton::testing::AllocationGuard;

class AllocationConformance : public Conformance {};

/// One topic of each class.
struct Traffic {
  Traffic(Participant& from, Participant& to)
      : sensor_writer(from.create_writer(topics::module_state)),
        command_writer(from.create_writer(topics::joint_command)),
        state_writer(from.create_writer(topics::link_claim)),
        event_writer(from.create_writer(topics::event)),
        sensor(to.create_reader(topics::module_state)),
        command(to.create_reader(topics::joint_command)),
        state(to.create_reader(topics::link_claim)),
        event(to.create_reader(topics::event)),
        own(from.create_reader(topics::module_state)) {}

  bool all_matched() const {
    return sensor_writer.matched() == 1 && command_writer.matched() == 1 && state_writer.matched() == 1 &&
           event_writer.matched() == 1 && sensor.matched() == 1 && command.matched() == 1 && state.matched() == 1 &&
           event.matched() == 1;
  }
  void write() {
    ++number;
    const std::uint32_t module_id = number % 4;
    joint_command.module_id = module_id;
    an_event.module_id = module_id;
    sensor_writer.write(state_at(module_id, number));
    command_writer.write(joint_command);
    state_writer.write(claim(module_id, 0, number));
    event_writer.write(an_event);
  }
  /// Takes what there is; returns how many samples.
  int take() {
    int taken = 0;
    while (sensor.take()) ++taken;
    while (command.take()) ++taken;
    while (state.take()) ++taken;
    while (event.take()) ++taken;
    while (own.take()) ++taken;
    return taken;
  }
  /// Rounds of a write and takes until something came, the reader never more than a few samples behind.
  int run(std::uint32_t rounds) {
    int taken = 0;
    for (std::uint32_t k = 0; k < rounds; ++k) {
      write();
      int in_this_round = 0;
      for (int polls = 0; polls < 200 && in_this_round < 5; ++polls) {
        in_this_round += take();
        if (in_this_round < 5) std::this_thread::sleep_for(std::chrono::microseconds(50));
      }
      taken += in_this_round;
    }
    return taken;
  }

  Writer<msg::ModuleState> sensor_writer;
  Writer<msg::JointCommand> command_writer;
  Writer<msg::LinkClaim> state_writer;
  Writer<msg::Event> event_writer;
  Reader<msg::ModuleState> sensor;
  Reader<msg::JointCommand> command;
  Reader<msg::LinkClaim> state;
  Reader<msg::Event> event;
  Reader<msg::ModuleState> own;
  std::uint32_t number = 0;
  msg::JointCommand joint_command;
  msg::Event an_event = event_number(1, 1);
};

TEST_P(AllocationConformance, WriteAndTakeLeaveTheHeapAlone) {
  if (!AllocationGuard::available()) GTEST_SKIP() << "the sanitizers bring a heap of their own";
  Traffic traffic(a, b);
  ASSERT_TRUE(eventually([&] { return traffic.all_matched(); }));
  traffic.run(100);
  AllocationGuard guard;
  traffic.run(200);
  const auto framework = guard.framework(), vendor = guard.vendor();
  EXPECT_EQ(framework, 0u) << guard.describe();
  for (const auto* count : {&traffic.sensor.statistics(), &traffic.command.statistics(), &traffic.state.statistics(),
                            &traffic.event.statistics(), &traffic.own.statistics()})
    EXPECT_GT(count->delivered, 20u);
  RecordProperty("vendor_heap_uses", std::to_string(vendor));
  std::printf(
      "%ju uses of the heap by the vendor, on this thread; delivered: sensor %ju, command %ju, state %ju, event "
      "%ju\n",
      std::uintmax_t{vendor}, std::uintmax_t{traffic.sensor.statistics().delivered},
      std::uintmax_t{traffic.command.statistics().delivered}, std::uintmax_t{traffic.state.statistics().delivered},
      std::uintmax_t{traffic.event.statistics().delivered});
}

/// Guards the thread it is called in from one call to a later one: all that the framework does there in between.
class GuardedCalls {
 public:
  static void call(void* self, const msg::ModuleState&) { static_cast<GuardedCalls*>(self)->count(); }
  bool done() const { return done_; }
  std::uint64_t framework() const { return framework_; }
  const std::string& description() const { return description_; }

 private:
  static constexpr int from = 100, to = 400;
  void count() {
    if (done_) return;
    if (++calls_ == from) {
      thread_ = std::this_thread::get_id();
      guard_.emplace();
    } else if (calls_ >= to && thread_ == std::this_thread::get_id()) {
      framework_ = guard_->framework();
      if (framework_ > 0) description_ = guard_->describe();
      guard_.reset();
      done_ = true;
    }
  }

  int calls_ = 0;
  std::thread::id thread_;
  std::optional<AllocationGuard> guard_;
  std::uint64_t framework_ = 0;
  std::string description_;
  std::atomic<bool> done_{false};
};

TEST_P(AllocationConformance, AnInlineReaderLeavesTheHeapAlone) {
  if (!AllocationGuard::available()) GTEST_SKIP() << "the sanitizers bring a heap of their own";
  GuardedCalls calls;
  auto writer = a.create_writer(topics::module_state);
  auto reader = b.create_inline_reader(topics::module_state, &GuardedCalls::call, &calls);
  ASSERT_TRUE(matched(writer, reader));
  for (int k = 0; k < 20'000 && !calls.done(); ++k) {
    writer.write(state_at(1, k));
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  ASSERT_TRUE(calls.done());
  EXPECT_EQ(calls.framework(), 0u) << calls.description();
}

INSTANTIATE_TEST_SUITE_P(Allocation, AllocationConformance, ::testing::ValuesIn(all_pairs), name_of);

}  // namespace
}  // namespace eciton::bus::conformance
