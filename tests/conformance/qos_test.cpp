// The four classes of service, and the times and bounds the framework keeps by itself.
#include <map>

#include "tests/conformance/ring.hpp"

namespace eciton::bus::conformance {
namespace {

class QosConformance : public Conformance {};

TEST_P(QosConformance, ALateJoinerGetsTheLastStateOfEachKey) {
  auto writer = a.create_writer(topics::link_claim);
  for (std::uint64_t number = 1; number <= 5; ++number)
    for (std::uint32_t port = 0; port < 3; ++port) EXPECT_TRUE(writer.write(claim(4, port, 10 * port + number)));
  auto joiner = b.create_reader(topics::link_claim);
  std::map<std::uint32_t, std::uint64_t> last;
  for (const auto& sample : take_count(joiner, 3)) last[sample.port] = sample.sequence_number;
  EXPECT_EQ(last, (std::map<std::uint32_t, std::uint64_t>{{0, 5}, {1, 15}, {2, 25}}));
  EXPECT_EQ(joiner.statistics().received, 3u);
}

TEST_P(QosConformance, ALateJoinerGetsTheLast64EventsInOrder) {
  auto writer = a.create_writer(topics::event);
  for (int number = 1; number <= 100; ++number) EXPECT_TRUE(writer.write(event_number(2, number)));
  auto joiner = b.create_reader(topics::event);
  std::vector<msg::Event> got;
  ASSERT_TRUE(take_until(joiner, got, [](const auto& all) { return !all.empty() && all.back().stamp_ns == 100; }));
  ASSERT_EQ(got.size(), 64u);
  for (int k = 0; k < 64; ++k) EXPECT_EQ(got[k], event_number(2, 37 + k));
}

/// A reader that joins late gets nothing of a volatile topic's past.
template <Message T>
void expect_no_past(Participant& from, Participant& to, const Topic<T>& topic) {
  auto writer = from.create_writer(topic);
  T past, present;
  past.stamp_ns = 1;
  present.stamp_ns = 2;
  EXPECT_TRUE(writer.write(past));
  auto joiner = to.create_reader(topic);
  ASSERT_TRUE(matched(writer, joiner));
  std::vector<T> got;
  ASSERT_TRUE(eventually([&] {
    writer.write(present);
    if (const auto sample = joiner.take()) got.push_back(sample->value);
    return !got.empty();
  }));
  EXPECT_EQ(got.front().stamp_ns, 2);
}

TEST_P(QosConformance, ALateJoinerGetsNothingOfASensorsPast) { expect_no_past(a, b, topics::joint_state); }
TEST_P(QosConformance, ALateJoinerGetsNothingOfACommandsPast) { expect_no_past(a, b, topics::joint_command); }

TEST_P(QosConformance, OfEachKeyTheNewestAlwaysArrivesAndNeverAnOlderOneAfterIt) {
  auto writer = a.create_writer(topics::joint_command);
  auto reader = b.create_reader(topics::joint_command);
  ASSERT_TRUE(matched(writer, reader));
  for (int number = 1; number <= 200; ++number) {
    msg::JointCommand command;
    command.module_id = static_cast<std::uint32_t>(number % 4);
    command.stamp_ns = number;
    EXPECT_TRUE(writer.write(command));
  }
  std::map<std::uint32_t, std::int64_t> last;
  ASSERT_TRUE(eventually([&] {
    while (const auto sample = reader.take()) {
      EXPECT_GT((*sample)->stamp_ns, last[(*sample)->module_id]);
      last[(*sample)->module_id] = (*sample)->stamp_ns;
    }
    return last == std::map<std::uint32_t, std::int64_t>{{0, 200}, {1, 197}, {2, 198}, {3, 199}};
  }));
  const ReaderStatistics& count = reader.statistics();
  EXPECT_EQ(count.received, count.delivered + count.replaced + count.dropped());
}

TEST_P(QosConformance, SixtyFourKeysHaveRoom) {
  auto writer = a.create_writer(topics::link_claim);
  auto reader = b.create_reader(topics::link_claim);
  ASSERT_TRUE(matched(writer, reader));
  for (std::uint32_t k = 0; k < 64; ++k) EXPECT_TRUE(writer.write(claim(k / 4, k % 4, k)));
  EXPECT_EQ(take_count(reader, 64).size(), 64u);
  EXPECT_FALSE(writer.write(claim(99, 0, 1))) << "a 65th key is refused, and counted";
  EXPECT_EQ(writer.refused(), 1u);
}

TEST_P(QosConformance, KnowsTheAgeOfASample) {
  auto writer = a.create_writer(topics::docking_state);
  auto reader = b.create_reader(topics::docking_state);
  b.set_now(from_ns(5'000'000'000));
  b.set_clock_offset(2, 100ms);  // module 2's clock is ahead of ours
  msg::DockingState state;
  state.stamp_ns = 4'990'000'000;
  for (const std::uint32_t module_id : {1u, 2u}) {
    state.module_id = module_id;
    EXPECT_TRUE(writer.write(state));
    std::optional<Sample<msg::DockingState>> sample;
    ASSERT_TRUE(eventually([&] { return (sample = reader.take()).has_value(); }));
    EXPECT_EQ(sample->age, module_id == 1 ? 10ms : 110ms);
  }
}

TEST_P(QosConformance, DropsWhatOutlivedItsLifespanAndCountsIt) {
  auto writer = a.create_writer(topics::rotor_command);  // lifespan 50 ms
  auto reader = b.create_reader(topics::rotor_command);
  ASSERT_TRUE(matched(writer, reader));
  b.set_now(from_ns(1'000'000'000));
  msg::RotorCommand old, fresh;
  old.module_id = 1;
  old.stamp_ns = 1'000'000'000 - 50'000'001;
  fresh.module_id = 2;
  fresh.stamp_ns = 1'000'000'000 - 50'000'000;
  std::vector<msg::RotorCommand> got;
  ASSERT_TRUE(eventually([&] {
    writer.write(old);
    writer.write(fresh);
    while (const auto sample = reader.take()) got.push_back(sample->value);
    return reader.statistics().dropped_expired > 0 && !got.empty();
  }));
  for (const auto& sample : got) EXPECT_EQ(sample.module_id, 2u);
}

TEST_P(QosConformance, KnowsWhenATopicIsOverdue) {
  auto writer = a.create_writer(topics::imu);  // deadline 10 ms
  auto reader = b.create_reader(topics::imu);
  ASSERT_TRUE(matched(writer, reader));
  b.set_now(from_ns(1'000'000'000));
  EXPECT_TRUE(reader.overdue()) << "nothing came yet";
  msg::Imu imu;
  imu.stamp_ns = 1'000'000'000;
  ASSERT_TRUE(eventually([&] {
    writer.write(imu);
    return reader.take().has_value();
  }));
  EXPECT_FALSE(reader.overdue());
  b.set_now(from_ns(1'010'000'000));
  EXPECT_FALSE(reader.overdue());
  b.set_now(from_ns(1'010'000'001));
  EXPECT_TRUE(reader.overdue());
}

TEST_P(QosConformance, CountsWhatItsOwnQueueDrops) {
  // Inside one participant, where nothing but the queue is between writer and reader.
  auto sensor_writer = a.create_writer(topics::module_state);
  auto event_writer = a.create_writer(topics::event);
  auto sensor = a.create_reader(topics::module_state);
  auto event = a.create_reader(topics::event);
  a.set_now(from_ns(1000));
  for (int k = 1; k <= 5; ++k) sensor_writer.write(state_at(1, k));
  EXPECT_EQ(sensor.take()->value.stamp_ns, 5);
  EXPECT_FALSE(sensor.take());
  EXPECT_EQ(sensor.statistics().replaced, 4u);
  sensor_writer.write(state_at(1, 4));  // overtaken by number 5
  EXPECT_FALSE(sensor.take());
  EXPECT_EQ(sensor.statistics().dropped_late, 1u);

  for (int k = 1; k <= 100; ++k) event_writer.write(event_number(1, k));
  for (int k = 37; k <= 100; ++k) EXPECT_EQ(event.take()->value.stamp_ns, k);
  EXPECT_FALSE(event.take());
  EXPECT_EQ(event.statistics().dropped_overflow, 36u);
  EXPECT_EQ(a.dropped(), 37u);
}

TEST_P(QosConformance, AFullQueueGivesWayOnlyToWhatItTakesIn) {
  auto writer = a.create_raw_writer(info(topics::link_claim));
  auto reader = a.create_reader(topics::link_claim);
  std::array<std::uint8_t, TypeTraits<msg::LinkClaim>::size_max> bytes{};
  const auto write = [&](std::uint32_t key, std::uint64_t number, std::size_t missing = 0) {
    const auto size = encode(claim(key, 0, number), bytes);
    writer.write(std::span(bytes).first(size - missing));
  };
  for (std::uint32_t key = 0; key < 64; ++key) write(key, 1);
  write(99, 1, 8);  // malformed
  write(5, 2);      // replaces its own
  EXPECT_EQ(reader.statistics().dropped_malformed, 1u);
  EXPECT_EQ(reader.statistics().replaced, 1u);
  EXPECT_EQ(reader.statistics().dropped_overflow, 0u);
  write(98, 1);  // a key more than there is room for: the oldest goes
  EXPECT_EQ(reader.statistics().dropped_overflow, 1u);
  for (std::uint32_t key = 1; key < 64; ++key) EXPECT_EQ(reader.take()->value, claim(key, 0, key == 5 ? 2 : 1));
  EXPECT_EQ(reader.take()->value, claim(98, 0, 1));
  EXPECT_FALSE(reader.take());
}

INSTANTIATE_TEST_SUITE_P(Qos, QosConformance, ::testing::ValuesIn(all_pairs), name_of);

}  // namespace
}  // namespace eciton::bus::conformance
