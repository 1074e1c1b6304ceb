// Inline readers: a call in the vendor's own thread for every sample, whatever the plugin.
#include "core/bus/inline_reader.hpp"

#include <mutex>

#include "tests/conformance/ring.hpp"

namespace eciton::bus::conformance {
namespace {

class InlineConformance : public Conformance {};

/// What was called, from whichever thread.
template <class T>
class Heard {
 public:
  static void call(void* self, const T& sample) {
    auto& heard = *static_cast<Heard*>(self);
    const std::lock_guard lock(heard.mutex_);
    heard.samples_.push_back(sample);
  }
  std::vector<T> samples() {
    const std::lock_guard lock(mutex_);
    return samples_;
  }
  [[nodiscard]] bool came(std::size_t count) {
    return eventually([&] { return samples().size() >= count; });
  }

 private:
  std::mutex mutex_;
  std::vector<T> samples_;
};

TEST_P(InlineConformance, CallsForEverySampleWithoutATake) {
  Heard<msg::LinkClaim> heard;
  auto writer = a.create_writer(topics::link_claim);
  auto reader = b.create_inline_reader(topics::link_claim, &Heard<msg::LinkClaim>::call, &heard);
  ASSERT_TRUE(matched(writer, reader));
  std::vector<msg::LinkClaim> sent;
  for (std::uint64_t number = 1; number <= 20; ++number) {
    sent.push_back(claim(static_cast<std::uint32_t>(number % 3), 0, number));
    EXPECT_TRUE(writer.write(sent.back()));
    ASSERT_TRUE(heard.came(sent.size()));
  }
  EXPECT_EQ(heard.samples(), sent);
  EXPECT_EQ(reader.statistics().delivered, sent.size());
  EXPECT_EQ(reader.statistics().dropped() + reader.statistics().dropped_by_vendor(), 0u);
  EXPECT_FALSE(b.waker().wait(Duration::zero())) << "an inline reader wakes nobody";
}

TEST_P(InlineConformance, CallsForWhatALateJoinerIsGiven) {
  auto writer = a.create_writer(topics::link_claim);
  for (std::uint32_t port = 0; port < 3; ++port) EXPECT_TRUE(writer.write(claim(1, port, port)));
  Heard<msg::LinkClaim> heard;
  auto reader = b.create_inline_reader(topics::link_claim, &Heard<msg::LinkClaim>::call, &heard);
  EXPECT_TRUE(heard.came(3));
}

TEST_P(InlineConformance, GivesTheVeryBytes) {
  struct Bytes {
    std::mutex mutex;
    std::vector<std::uint8_t> got;
  } bytes;
  auto writer = a.create_raw_writer(info(topics::link_claim));
  auto reader = b.create_inline_raw_reader(
      info(topics::link_claim),
      [](void* context, std::span<const std::uint8_t> cdr) {
        auto& into = *static_cast<Bytes*>(context);
        const std::lock_guard lock(into.mutex);
        into.got.assign(cdr.begin(), cdr.end());
      },
      &bytes);
  ASSERT_TRUE(matched(writer, reader));
  std::vector<std::uint8_t> sent(TypeTraits<msg::LinkClaim>::size_max);
  sent.resize(encode(claim(1, 2, 3), sent));
  EXPECT_TRUE(writer.write(sent));
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(bytes.mutex);
    return bytes.got == sent;
  }));
}

TEST_P(InlineConformance, MayAnswerInTheCall) {
  struct Echo {
    Writer<msg::GoalStatus> writer;
    static void answer(void* self, const msg::DockingState& asked) {
      msg::GoalStatus status;
      status.module_id = asked.module_id;
      status.stamp_ns = asked.stamp_ns;
      static_cast<Echo*>(self)->writer.write(status);
    }
  } echo{b.create_writer(topics::goal_status)};
  Heard<msg::GoalStatus> answers;
  auto listening = a.create_inline_reader(topics::goal_status, &Heard<msg::GoalStatus>::call, &answers);
  auto asking = a.create_writer(topics::docking_state);
  auto answering = b.create_inline_reader(topics::docking_state, &Echo::answer, &echo);
  ASSERT_TRUE(matched(asking, answering) && matched(echo.writer, listening));
  for (std::int64_t k = 1; k <= 50; ++k) {
    msg::DockingState state;
    state.module_id = 1;
    state.stamp_ns = k;
    EXPECT_TRUE(asking.write(state));
    ASSERT_TRUE(answers.came(static_cast<std::size_t>(k)));
    EXPECT_EQ(answers.samples().back().stamp_ns, k);
  }
}

TEST_P(InlineConformance, CallsInsideItsOwnParticipantAtOnceAndExactlyOnce) {
  Heard<msg::LinkClaim> own, other;
  auto writer = a.create_writer(topics::link_claim);
  auto at_a = a.create_inline_reader(topics::link_claim, &Heard<msg::LinkClaim>::call, &own);
  auto at_b = b.create_inline_reader(topics::link_claim, &Heard<msg::LinkClaim>::call, &other);
  ASSERT_TRUE(matched(writer, at_b));
  for (std::uint64_t number = 1; number <= 5; ++number) {
    EXPECT_TRUE(writer.write(claim(1, 0, number)));
    ASSERT_EQ(own.samples().size(), number);
    ASSERT_TRUE(other.came(number));
  }
  EXPECT_EQ(own.samples().size(), 5u);
}

TEST_P(InlineConformance, CountsWhatIsMalformedAndDoesNotCall) {
  Heard<msg::DockingState> heard;
  auto writer = a.create_raw_writer(info(topics::docking_state));
  auto reader = b.create_inline_reader(topics::docking_state, &Heard<msg::DockingState>::call, &heard);
  ASSERT_TRUE(matched(writer, reader));
  msg::DockingState state;
  state.module_id = 1;
  std::vector<std::uint8_t> bytes(TypeTraits<msg::DockingState>::size_max);
  const std::size_t size = encode(state, bytes);
  EXPECT_TRUE(writer.write(std::span(bytes).first(size - 8)));  // the last number is missing
  EXPECT_TRUE(eventually([&] { return reader.statistics().dropped_malformed == 1; }));
  EXPECT_TRUE(writer.write(std::span(bytes).first(size)));
  EXPECT_TRUE(heard.came(1));
  EXPECT_EQ(heard.samples().size(), 1u);
  EXPECT_GE(b.dropped(), 1u);
}

TEST_P(InlineConformance, NeverCallsAfterItIsGone) {
  auto writer = a.create_writer(topics::joint_command);
  std::atomic<bool> stop{false};
  std::thread hammer([&] {
    for (msg::JointCommand command; !stop; ++command.stamp_ns) {
      writer.write(command);
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  });
  for (int round = 0; round < 5; ++round) {
    std::atomic<int> calls{0};
    {
      auto reader = b.create_inline_reader(
          topics::joint_command,
          +[](void* count, const msg::JointCommand&) { ++*static_cast<std::atomic<int>*>(count); }, &calls);
      EXPECT_TRUE(eventually([&] { return calls > 10; }));
    }
    const int at_the_end = calls;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(calls, at_the_end);
  }
  stop = true;
  hammer.join();
}

INSTANTIATE_TEST_SUITE_P(Inline, InlineConformance, ::testing::ValuesIn(all_pairs), name_of);

}  // namespace
}  // namespace eciton::bus::conformance
