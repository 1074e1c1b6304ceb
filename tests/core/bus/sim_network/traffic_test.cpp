// Delivery without faults: matching, QoS, keep last, late joiners, order and bounds, in virtual time.
#include <dlfcn.h>

#include "tests/core/bus/sim_network/endpoints.hpp"

namespace eciton::bus::sim_network::testing {
namespace {

using Numbers = std::vector<std::uint32_t>;

TEST_F(VirtualNetwork, DeliversAtOnceWithoutDelay) {
  TestParticipant a("a"), b("b");
  int wakes = 0;
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(
      b, plain_type(), best_effort_deep,
      {.signal = [](void* context) { ++*static_cast<int*>(context); }, .sample = nullptr, .context = &wakes});
  EXPECT_TRUE(writer.write(1));
  EXPECT_TRUE(writer.write(2));
  EXPECT_EQ(wakes, 2);
  EXPECT_EQ(reader.take(), (Numbers{1, 2}));
  EXPECT_EQ(reader.take(), Numbers{});
  EXPECT_FALSE(network().next_delivery());
}

TEST_F(VirtualNetwork, TakesNoMoreThanAskedFor) {
  TestParticipant a("a"), b("b");
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep);
  for (std::uint32_t k = 0; k < 5; ++k) writer.write(k);
  EXPECT_EQ(reader.take(2), (Numbers{0, 1}));
  EXPECT_EQ(reader.take(), (Numbers{2, 3, 4}));
}

TEST_F(VirtualNetwork, NeverDeliversWithinAParticipantOrToAnotherTopicOrDomain) {
  TestParticipant a("a"), b("b"), elsewhere("b", domain + 1);
  TestWriter writer(a, plain_type(), reliable_deep);
  TestReader own(a, plain_type(), reliable_deep);
  TestReader other_topic(b, plain_type(), reliable_deep, {}, "u");
  TestReader other_domain(elsewhere, plain_type(), reliable_deep);
  writer.write(1);
  EXPECT_EQ(writer.matched(), 0u);
  for (TestReader* reader : {&own, &other_topic, &other_domain}) {
    EXPECT_EQ(reader->matched(), 0u);
    EXPECT_EQ(reader->take(), Numbers{});
  }
}

TEST_F(VirtualNetwork, MatchesAsDdsDoesAndCountsWhatDoesNotFit) {
  TestParticipant a("a"), b("b");
  const eciton_qos unkeyed_best_effort{.reliable = 0, .transient_local = 0, .depth = 1, .instances_max = 1};
  TestWriter lesser(a, plain_type(), unkeyed_best_effort, "unreliable");
  TestReader demanding(b, plain_type(), reliable_deep, {}, "unreliable");
  TestWriter no_history(a, keyed_type(), reliable, "volatile");
  TestReader late(b, keyed_type(), transient_local, {}, "volatile");
  TestWriter one_type(a, plain_type("test::One"), unkeyed_best_effort, "type");
  TestReader other_type(b, plain_type("test::Other"), unkeyed_best_effort, {}, "type");
  TestWriter unkeyed(a, plain_type("test::Same"), unkeyed_best_effort, "key");
  TestReader keyed(b, keyed_type("test::Same"), best_effort, {}, "key");
  for (TestReader* reader : {&demanding, &late, &other_type, &keyed}) EXPECT_EQ(reader->matched(), 0u);
  EXPECT_EQ(network().mismatched(), 4u);

  TestWriter better(a, keyed_type(), transient_local, "better");
  TestReader content(b, keyed_type(), best_effort, {}, "better");
  EXPECT_EQ(content.matched(), 1u);
  EXPECT_EQ(better.matched(), 1u);
  EXPECT_EQ(network().mismatched(), 4u);
}

TEST_F(VirtualNetwork, KeepsTheLastOfEachKeyInOrderOfArrival) {
  TestParticipant a("a"), b("b");
  TestWriter writer(a, keyed_type(), best_effort);
  TestReader reader(b, keyed_type(), best_effort);
  writer.write(10, 1);
  writer.write(20, 2);
  writer.write(11, 1);
  EXPECT_EQ(reader.take(), (Numbers{20, 11}));
  EXPECT_EQ(network().statistics().replaced, 1u);
  EXPECT_EQ(reader.losses().replaced, 1u);
}

TEST_F(VirtualNetwork, GivesAnInlineReaderEverySampleWhenItIsDue) {
  struct Heard {
    Network& network;
    std::vector<std::pair<std::uint32_t, bool>> numbers;  // and whether it was the last in flight
    static void call(void* self, const std::uint8_t* cdr, std::uint32_t) {
      std::uint32_t number = 0;
      std::memcpy(&number, cdr + 8, 4);
      auto& heard = *static_cast<Heard*>(self);
      heard.numbers.emplace_back(number, !heard.network.next_delivery());
    }
  } heard{network(), {}};
  network().set_default_link({.delay = 3ms});
  TestParticipant a("a"), b("b");
  TestWriter writer(a, keyed_type(), best_effort);
  TestReader reader(b, keyed_type(), best_effort, {.signal = nullptr, .sample = &Heard::call, .context = &heard});
  writer.write(1);
  network().advance(TimePoint{1ms});
  writer.write(2);
  network().advance(TimePoint{2ms});
  EXPECT_TRUE(heard.numbers.empty());
  network().advance(TimePoint{10ms});  // over both: a queue that keeps one would have lost the first
  EXPECT_EQ(heard.numbers, (std::vector<std::pair<std::uint32_t, bool>>{{1, false}, {2, true}}));
  EXPECT_EQ(reader.losses().replaced, 0u);
}

TEST_F(VirtualNetwork, RefusesAndCountsKeysOverTheBound) {
  TestParticipant a("a"), b("b"), c("c");
  TestWriter bounded(a, keyed_type(), reliable), free(c, keyed_type(), best_effort);
  TestReader reader(b, keyed_type(), best_effort);
  for (std::uint32_t key = 0; key < 8; ++key) EXPECT_TRUE(bounded.write(key, key));
  EXPECT_FALSE(bounded.write(99, 99));  // its history has no room for a ninth key
  EXPECT_EQ(network().writes_refused(), 1u);
  EXPECT_TRUE(free.write(99, 99));  // without a history it may write, but the reader has no room
  EXPECT_EQ(network().statistics("c", "b").dropped, 1u);
  EXPECT_EQ(reader.losses().rejected, 1u);
  EXPECT_EQ(reader.take().size(), 8u);
}

TEST_F(VirtualNetwork, RefusesWhatIsTooLargeOrHasNoKey) {
  TestParticipant a("a");
  TestWriter writer(a, keyed_type(), best_effort);
  EXPECT_FALSE(writer.write_bytes(std::vector<std::uint8_t>(16)));
  EXPECT_FALSE(writer.write_bytes({0, 1, 0, 0}));
  EXPECT_FALSE(writer.write_bytes({0}));
  EXPECT_EQ(network().writes_refused(), 3u);
}

TEST_F(VirtualNetwork, GivesALateJoinerTheHistoryOfEachKey) {
  TestParticipant a("a"), b("b");
  TestWriter writer(a, keyed_type(), transient_local);
  for (std::uint32_t k = 1; k <= 5; ++k) writer.write(k, k % 2);
  TestReader joiner(b, keyed_type(), transient_local);
  TestReader forgetful(b, keyed_type(), reliable);
  EXPECT_EQ(joiner.take(), (Numbers{2, 3, 4, 5}));
  EXPECT_EQ(forgetful.take(), Numbers{});
  writer.write(6, 0);
  EXPECT_EQ(joiner.take(), Numbers{6});
  EXPECT_EQ(forgetful.take(), Numbers{6});
}

TEST_F(VirtualNetwork, DeliversInOrderOfTimeThenOfWriting) {
  network().set_link("a", "c", {.delay = 3ms});
  network().set_link("b", "c", {.delay = 2ms});
  TestParticipant a("a"), b("b"), c("c");
  TestWriter from_a(a, plain_type(), best_effort_deep), from_b(b, plain_type(), best_effort_deep);
  TestReader reader(c, plain_type(), best_effort_deep);
  from_a.write(1);  // due at 3 ms
  from_b.write(2);  // due at 2 ms
  advance(1ms);
  from_b.write(3);  // due at 3 ms, after number 1
  from_a.write(4);  // due at 4 ms
  EXPECT_EQ(network().next_delivery(), TimePoint{2ms});
  EXPECT_EQ(reader.take(), Numbers{});
  advance(3ms);
  EXPECT_EQ(reader.take(), (Numbers{2, 1, 3}));
  advance(10ms);
  EXPECT_EQ(reader.take(), Numbers{4});
}

TEST_F(VirtualNetwork, TimeNeverGoesBack) {
  network().set_default_link({.delay = 1ms});
  TestParticipant a("a"), b("b");
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep);
  advance(5ms);
  advance(2ms);
  writer.write(1);
  EXPECT_EQ(network().next_delivery(), TimePoint{6ms});
}

TEST_F(VirtualNetwork, CountsSamplesOverTheBoundInFlight) {
  network().set_default_link({.delay = 1s});
  TestParticipant a("a"), b("b");
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep);
  for (std::uint32_t k = 0; k < 600; ++k) EXPECT_TRUE(writer.write(k));
  EXPECT_EQ(network().statistics().dropped, 600u - 512u);
  advance(1s);
  EXPECT_EQ(reader.take().size(), 512u);
  writer.write(1000);  // and goes on
  advance(2s);
  EXPECT_EQ(reader.take(), Numbers{1000});
}

TEST_F(VirtualNetwork, WhatIsInFlightEndsWithItsEndpoint) {
  network().set_default_link({.delay = 1ms});
  TestParticipant a("a"), b("b"), c("c");
  TestReader reader(c, plain_type(), best_effort_deep);
  TestWriter staying(b, plain_type(), best_effort_deep);
  {
    TestWriter leaving(a, plain_type(), best_effort_deep);
    leaving.write(1);
    staying.write(2);
    EXPECT_EQ(reader.matched(), 2u);
  }
  EXPECT_EQ(reader.matched(), 1u);
  {
    TestReader also_leaving(a, plain_type(), best_effort_deep);
    staying.write(3);
  }
  advance(1ms);
  EXPECT_EQ(reader.take(), (Numbers{2, 3}));
}

TEST_F(VirtualNetwork, SaysWhatIsWrongWithAParticipantOrAnEndpoint) {
  TestParticipant a("a"), again("a");
  EXPECT_FALSE(again.exists());
  EXPECT_STREQ(again.error.data(),
               "sim_network: a participant named 'a' is already in domain 3; the name is the address: give each "
               "participant its own");
  TestWriter writer(a, plain_type(), {.reliable = 1, .transient_local = 0, .depth = 0, .instances_max = 1});
  EXPECT_FALSE(writer.exists());
  EXPECT_STREQ(
      writer.error.data(),
      "sim_network: writer of topic 't' in participant 'a', domain 3: depth 0 and instances_max 1 must be at "
      "least 1");
  EXPECT_THROW(network().configure(1, Pacing::virtual_time), std::logic_error);
  EXPECT_THROW(Network::reset_all(), std::logic_error);
}

TEST_F(VirtualNetwork, LoadedByNameItIsTheLibraryThatIsLinked) {
  Dl_info info{};
  ASSERT_NE(::dladdr(reinterpret_cast<void*>(&eciton_dds_plugin), &info), 0);
  void* library = ::dlopen(info.dli_fname, RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(library, nullptr) << ::dlerror();
  const auto entry = reinterpret_cast<const eciton_plugin* (*)()>(::dlsym(library, ECITON_PLUGIN_ENTRY));
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry(), eciton_dds_plugin());
  ::dlclose(library);
}

}  // namespace
}  // namespace eciton::bus::sim_network::testing
