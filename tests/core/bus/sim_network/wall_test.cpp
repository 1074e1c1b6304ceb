// The network on the steady clock: delays in real time, several threads at once (also under the thread
// sanitizer). Nothing here asserts an upper bound on time.
#include <atomic>
#include <thread>

#include "tests/core/bus/sim_network/endpoints.hpp"

namespace eciton::bus::sim_network::testing {
namespace {

using Steady = std::chrono::steady_clock;

class WallNetwork : public ::testing::Test {
 protected:
  ~WallNetwork() override { Network::reset_all(); }
  static Network& network() { return Network::of(domain); }
};

template <class Condition>
bool eventually(Condition&& condition) {
  for (const auto end = Steady::now() + std::chrono::seconds(30); Steady::now() < end;) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return false;
}

TEST_F(WallNetwork, DeliversAtOnceWithoutDelay) {
  TestParticipant a("a"), b("b");
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep);
  writer.write(1);
  EXPECT_EQ(reader.take().size(), 1u);
}

TEST_F(WallNetwork, DeliversNoSoonerThanTheDelayAndWakesTheReader) {
  network().set_default_link({.delay = 20ms});
  TestParticipant a("a"), b("b");
  std::atomic<int> wakes = 0;
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep,
                    {.signal = [](void* context) { ++*static_cast<std::atomic<int>*>(context); },
                     .sample = nullptr,
                     .context = &wakes});
  const auto start = Steady::now();
  writer.write(1);
  writer.write(2);
  ASSERT_TRUE(eventually([&] { return wakes == 2; }));
  EXPECT_GE(Steady::now() - start, 20ms);
  EXPECT_EQ(reader.take(), (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(WallNetwork, ASoonerSampleOvertakesOnAFasterLink) {
  network().set_link("slow", "b", {.delay = 200ms});
  network().set_link("quick", "b", {.delay = 1ms});
  TestParticipant slow("slow"), quick("quick"), b("b");
  TestWriter from_slow(slow, plain_type(), best_effort_deep), from_quick(quick, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep);
  from_slow.write(1);
  from_quick.write(2);
  std::vector<std::uint32_t> got;
  ASSERT_TRUE(eventually([&] {
    for (const std::uint32_t number : reader.take()) got.push_back(number);
    return got.size() == 2;
  }));
  EXPECT_EQ(got, (std::vector<std::uint32_t>{2, 1}));
}

TEST_F(WallNetwork, CarriesSamplesBetweenThreadsWhileEndpointsComeAndGo) {
  constexpr std::uint32_t samples = 2000;
  network().set_default_link({.delay = 100us, .jitter = 100us});
  TestParticipant a("a"), b("b"), c("c"), d("d");
  TestWriter event_a(a, plain_type(), reliable_deep), event_b(b, plain_type(), reliable_deep);
  TestReader reader(c, plain_type(), {.reliable = 1, .transient_local = 0, .depth = 8192, .instances_max = 1});
  std::atomic<bool> done = false;
  const auto send = [](TestWriter& writer) {
    for (std::uint32_t k = 0; k < samples; ++k) {
      writer.write(k);
      if (k % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  std::thread first([&] { send(event_a); });
  std::thread second([&] { send(event_b); });
  std::thread visitor([&] {
    while (!done) {
      TestReader passing(d, plain_type(), best_effort_deep);
      passing.take();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // or it keeps the lock from all others
    }
  });
  std::thread meddler([&] {
    while (!done) {
      network().set_link("a", "d", {.delay = 50us});
      network().partition({{"d"}});
      network().heal();
      network().statistics();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  std::uint64_t got = 0, sum = 0;
  const bool all = eventually([&] {
    const auto [count, of_numbers] = reader.take_sum();
    got += count;
    sum += of_numbers;
    return got + network().statistics("a", "c").dropped + network().statistics("b", "c").dropped == 2 * samples;
  });
  done = true;
  for (std::thread* thread : {&first, &second, &visitor, &meddler}) thread->join();
  EXPECT_TRUE(all);
  if (network().statistics("a", "c").dropped + network().statistics("b", "c").dropped == 0) {
    EXPECT_EQ(sum, std::uint64_t{samples} * (samples - 1));
  }
}

}  // namespace
}  // namespace eciton::bus::sim_network::testing
