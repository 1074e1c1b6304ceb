// What a vendor lost, rejected or replaced before the framework could take it is counted beside its own drops.
#include <mutex>

#include "core/bus/inline_reader.hpp"
#include "tests/conformance/peer_process.hpp"
#include "tests/conformance/ring.hpp"

namespace eciton::bus::conformance {
namespace {

class LossesConformance : public Conformance {};

/// Writes faster than the reader takes; in the end every number is accounted for.
template <Message T>
void expect_every_sample_accounted_for(Participant& from, Participant& to, const Topic<T>& topic) {
  auto writer = from.create_writer(topic);
  auto reader = to.create_reader(topic);
  ASSERT_TRUE(matched(writer, reader));
  T sample;
  std::int64_t newest = 0;
  const auto take_up_to = [&](std::int64_t number) {
    return eventually([&] {
      while (const auto taken = reader.take()) newest = taken->value.stamp_ns;
      return newest == number;
    });
  };
  sample.stamp_ns = 1;
  ASSERT_TRUE(writer.write(sample));
  ASSERT_TRUE(take_up_to(1));  // from here on the numbers tell what is missing
  constexpr std::int64_t last = 101;
  for (sample.stamp_ns = 2; sample.stamp_ns <= last; ++sample.stamp_ns) EXPECT_TRUE(writer.write(sample));
  ASSERT_TRUE(take_up_to(last));
  EXPECT_TRUE(eventually([&] {
    reader.take();
    const ReaderStatistics& count = reader.statistics();
    return count.received + count.vendor_replaced + count.vendor_lost == last;
  })) << reader.statistics().received
      << " received, " << reader.statistics().vendor_replaced << " replaced, " << reader.statistics().vendor_lost
      << " lost";
  EXPECT_EQ(reader.statistics().vendor_rejected, 0u);
  EXPECT_GT(reader.statistics().vendor_replaced, 0u) << "nothing was replaced: the test shows nothing";
}

TEST_P(LossesConformance, CountsWhatTheVendorReplacedOfASensor) {
  expect_every_sample_accounted_for(a, b, topics::module_state);
}
TEST_P(LossesConformance, CountsWhatTheVendorReplacedOfACommand) {
  expect_every_sample_accounted_for(a, b, topics::joint_command);
}

TEST_P(LossesConformance, CountsNothingForALateJoinersPast) {
  auto writer = a.create_writer(topics::link_claim);
  for (std::uint64_t number = 1; number <= 50; ++number)
    EXPECT_TRUE(writer.write(claim(1, static_cast<std::uint32_t>(number % 3), number)));
  auto joiner = b.create_reader(topics::link_claim);
  EXPECT_EQ(take_count(joiner, 3).size(), 3u);
  EXPECT_EQ(joiner.statistics().dropped_by_vendor(), 0u);
}

TEST_P(LossesConformance, CountsKeysOverTheBoundAsRejected) {
  Participant c(config_of(GetParam().writer));
  auto from_a = a.create_writer(topics::link_claim);
  auto from_c = c.create_writer(topics::link_claim);
  auto reader = b.create_reader(topics::link_claim);
  ASSERT_TRUE(matched(from_a, reader) && matched(from_c, reader));
  ASSERT_TRUE(eventually([&] { return reader.matched() == 2; }));
  for (std::uint32_t key = 0; key < 40; ++key) {  // 64 keys have room; Fast DDS has one to spare
    EXPECT_TRUE(from_a.write(claim(key, 0, 1)));
    EXPECT_TRUE(from_c.write(claim(100 + key, 0, 1)));
  }
  EXPECT_TRUE(eventually([&] {
    while (reader.take()) {
    }
    return reader.statistics().received + reader.statistics().vendor_rejected >= 80;  // refused again if sent again
  })) << reader.statistics().received
      << " received, " << reader.statistics().vendor_rejected << " rejected";
  EXPECT_GE(reader.statistics().vendor_rejected, 15u);
  EXPECT_GE(b.dropped(), 15u);
}

INSTANTIATE_TEST_SUITE_P(Losses, LossesConformance, ::testing::ValuesIn(all_pairs), name_of);

class LossesOnTheWay : public ::testing::TestWithParam<Pair> {};

/// Numbers that came, from a reader whose thread sleeps at the hundredth.
struct Sleeper {
  std::mutex mutex;
  std::int64_t first = 0, last = 0, count = 0;

  static void call(void* self, const msg::ModuleState& state) {
    auto& sleeper = *static_cast<Sleeper*>(self);
    {
      const std::lock_guard lock(sleeper.mutex);
      if (sleeper.count++ == 0) sleeper.first = state.stamp_ns;
      sleeper.last = state.stamp_ns;
      if (sleeper.count != 100) return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
};

// The vendor's thread sleeps until the kernel has no more room for what another process sends.
TEST_P(LossesOnTheWay, AreCountedByTheWritersNumbers) {
  Participant here(config_of(GetParam().reader));
  Sleeper sleeper;
  auto reader = here.create_inline_reader(topics::module_state, &Sleeper::call, &sleeper);
  {
    const PeerProcess peer(GetParam().writer, 1, 0);
    ASSERT_TRUE(eventually([&] {
      const std::lock_guard lock(sleeper.mutex);
      return sleeper.count > 3000 && sleeper.last - sleeper.first + 1 > sleeper.count;
    })) << "nothing was lost on the way";
  }
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(sleeper.mutex);
    const ReaderStatistics count = reader.statistics();
    return static_cast<std::int64_t>(count.vendor_lost + count.vendor_replaced) ==
           sleeper.last - sleeper.first + 1 - sleeper.count;
  }));
  EXPECT_GT(reader.statistics().vendor_lost, 0u);
  EXPECT_EQ(reader.statistics().vendor_rejected, 0u);
}

// sim_network has no processes; its losses are in its own tests.
INSTANTIATE_TEST_SUITE_P(Losses, LossesOnTheWay,
                         ::testing::Values(Pair{"fastdds", "fastdds"}, Pair{"cyclonedds", "cyclonedds"},
                                           Pair{"fastdds", "cyclonedds"}, Pair{"cyclonedds", "fastdds"}),
                         name_of);

}  // namespace
}  // namespace eciton::bus::conformance
