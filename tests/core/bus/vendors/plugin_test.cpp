// What every vendor's plugin must do with bytes, writer and reader on the same vendor and on two, in one process.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "tests/core/bus/vendors/plugin_handles.hpp"

namespace eciton::bus {
namespace {

using Vendors = std::tuple<const char*, const char*>;  // of the writer and of the reader

class PluginTest : public testing::TestWithParam<Vendors> {
 protected:
  TestParticipant writing_{std::get<0>(GetParam())};
  TestParticipant reading_{std::get<1>(GetParam())};
};

TEST_P(PluginTest, CarriesBytesUntouched) {
  for (const eciton_type* type : {&kKeyed, &kUnkeyed}) {
    for (const eciton_qos* qos : {&kSensor, &kCommand, &kState, &kEvent}) {
      const char* topic = type == &kKeyed ? "keyed_bytes" : "bytes";
      TestWriter writer(writing_, topic, *type, *qos);
      TestReader reader(reading_, topic, *type, *qos);
      ASSERT_TRUE(writer.created() && reader.created()) << writer.error() << reader.error();
      ASSERT_TRUE(connected(writer, reader));
      const Cdr sent = sample(7, 42, std::string(901, 'x'));
      ASSERT_TRUE(writer.write(sent));
      ASSERT_TRUE(reader.wait_until_taken(1)) << type->name << " reliable " << int{qos->reliable};
      EXPECT_EQ(reader.taken[0], sent);
      EXPECT_GE(reader.signals(), 1u);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

TEST_P(PluginTest, CarriesBigEndianBytesUntouched) {
  TestWriter writer(writing_, "big_endian", kKeyed, kEvent);
  TestReader reader(reading_, "big_endian", kKeyed, kEvent);
  ASSERT_TRUE(connected(writer, reader));
  ASSERT_TRUE(writer.write(big_endian_sample(3, 4)));
  ASSERT_TRUE(reader.wait_until_taken(1));
  EXPECT_EQ(reader.taken[0], big_endian_sample(3, 4));
}

TEST_P(PluginTest, KeepsTheNewestSampleOfEachKey) {
  TestWriter writer(writing_, "newest", kKeyed, kCommand);
  TestReader reader(reading_, "newest", kKeyed, kCommand);
  TestReader observer(reading_, "newest", kKeyed, {1, 0, 64, 8});
  ASSERT_TRUE(connected(writer, reader) && connected(writer, observer));
  for (std::uint32_t count = 1; count <= 5; ++count) {
    for (const std::uint32_t key : {0u, 1u, 2u}) {  // 0 has an all-zero key hash
      ASSERT_TRUE(writer.write(sample(key, count)));
      ASSERT_TRUE(observer.wait_until_taken(3 * (count - 1) + key + 1));
    }
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  reader.take();
  std::map<std::uint32_t, std::uint32_t> count_by_key;
  for (const Cdr& cdr : reader.taken) count_by_key[key_of(cdr)] = count_of(cdr);
  EXPECT_EQ(count_by_key, (std::map<std::uint32_t, std::uint32_t>{{0, 5}, {1, 5}, {2, 5}}));
  EXPECT_EQ(reader.taken.size(), 3u);
}

TEST_P(PluginTest, KeepsTheLast64EventsOfEachKeyInOrder) {
  TestWriter writer(writing_, "depth", kKeyed, kEvent);
  for (std::uint32_t count = 1; count <= 100; ++count) {
    ASSERT_TRUE(writer.write(sample(1, count)));
    ASSERT_TRUE(writer.write(sample(2, count)));
  }
  TestReader late(reading_, "depth", kKeyed, kEvent);
  ASSERT_TRUE(late.wait_until_taken(128));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  late.take();
  ASSERT_EQ(late.taken.size(), 128u);
  std::map<std::uint32_t, std::uint32_t> next = {{1, 37}, {2, 37}};
  for (const Cdr& cdr : late.taken) EXPECT_EQ(count_of(cdr), next[key_of(cdr)]++);
}

TEST_P(PluginTest, GivesALateReaderTheStateOfEveryKey) {
  TestWriter writer(writing_, "late", kKeyed, kState);
  for (const std::uint32_t key : {1u, 2u, 3u}) {
    ASSERT_TRUE(writer.write(sample(key, 1)));
    ASSERT_TRUE(writer.write(sample(key, 2)));
  }
  TestReader late(reading_, "late", kKeyed, kState);
  ASSERT_TRUE(late.wait_until_taken(3));
  for (const Cdr& cdr : late.taken) EXPECT_EQ(count_of(cdr), 2u);
}

TEST_P(PluginTest, GivesALateReaderOfAVolatileTopicNothing) {
  TestWriter writer(writing_, "volatile", kKeyed, kCommand);
  ASSERT_TRUE(writer.write(sample(1, 1)));
  TestReader late(reading_, "volatile", kKeyed, kCommand);
  ASSERT_TRUE(connected(writer, late));
  ASSERT_TRUE(writer.write(sample(1, 2)));
  ASSERT_TRUE(late.wait_until_taken(1));
  EXPECT_EQ(count_of(late.taken[0]), 2u);
}

TEST_P(PluginTest, NeverReturnsSamplesOfItsOwnParticipant) {
  TestWriter own(reading_, "own", kKeyed, kEvent);
  TestWriter other(writing_, "own", kKeyed, kEvent);
  TestReader reader(reading_, "own", kKeyed, kEvent);
  ASSERT_TRUE(connected(other, reader));
  EXPECT_EQ(reader.matched(), 1u) << "own endpoints do not count";
  EXPECT_EQ(own.matched(), 0u);
  for (std::uint32_t count = 1; count <= 10; ++count) {
    ASSERT_TRUE(own.write(sample(1, 100 + count)));
    ASSERT_TRUE(other.write(sample(1, count)));
  }
  ASSERT_TRUE(reader.wait_until_taken(10));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  reader.take();
  ASSERT_EQ(reader.taken.size(), 10u);
  for (std::uint32_t k = 0; k < 10; ++k) EXPECT_EQ(count_of(reader.taken[k]), k + 1);
}

TEST_P(PluginTest, RefusesKeysBeyondTheBoundAndGoesOnWithTheOthers) {
  const eciton_qos two_keys = {1, 0, 64, 2};
  TestWriter writer(writing_, "keys", kKeyed, kEvent);
  TestReader reader(reading_, "keys", kKeyed, two_keys);
  ASSERT_TRUE(connected(writer, reader));
  for (std::uint32_t count = 1; count <= 3; ++count) {
    for (const std::uint32_t key : {1u, 2u, 3u, 4u, 5u}) ASSERT_TRUE(writer.write(sample(key, count)));
  }
  ASSERT_TRUE(reader.wait_until_taken(6)) << "samples of refused keys must not hold up the others";
  ASSERT_TRUE(writer.write(sample(1, 4)));
  ASSERT_TRUE(reader.wait_until_taken(7));
  std::set<std::uint32_t> keys;
  for (const Cdr& cdr : reader.taken) keys.insert(key_of(cdr));
  EXPECT_LE(keys.size(), 3u);  // Fast DDS keeps one instance to spare, for malformed samples
  EXPECT_TRUE(keys.contains(1) && keys.contains(2));

  TestWriter bounded(writing_, "bounded", kKeyed, two_keys);
  EXPECT_TRUE(bounded.write(sample(1, 1)));
  EXPECT_TRUE(bounded.write(sample(2, 1)));
  EXPECT_FALSE(bounded.write(sample(3, 1)));
  EXPECT_TRUE(bounded.write(sample(1, 2)));
}

TEST_P(PluginTest, RefusesToWriteWhatIsNoSample) {
  TestWriter writer(writing_, "bad", kKeyed, kCommand);
  EXPECT_FALSE(writer.write({}));
  EXPECT_FALSE(writer.write({0, 1}));
  EXPECT_FALSE(writer.write({0, 1, 0, 0, 1, 0}));                        // no whole key
  EXPECT_FALSE(writer.write({0, 7, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));      // XCDR2
  EXPECT_FALSE(writer.write(sample(1, 1, std::string(kSizeMax, 'x'))));  // too long
}

TEST_P(PluginTest, DropsMalformedSamplesOfAPeer) {
  eciton_type careless = kKeyed;
  careless.key_hash = careless_key_hash;
  careless.size_max = 4 * kSizeMax;
  const eciton_qos qos = {1, 0, 64, 8};
  TestWriter writer(writing_, "malformed", careless, qos);
  TestParticipant third(std::get<1>(GetParam()));
  TestReader reader(third, "malformed", kKeyed, qos);
  TestWriter good(reading_, "malformed", kKeyed, qos);
  ASSERT_TRUE(wait_for([&] { return writer.matched() > 0 && good.matched() > 0 && reader.matched() == 2; }));
  for (int k = 0; k < 400; ++k) {             // more than any history holds
    ASSERT_TRUE(writer.write({0, 1, 0, 0}));  // no key
    ASSERT_TRUE(good.write(sample(1, static_cast<std::uint32_t>(k))));
    if (k == 200) {
      ASSERT_TRUE(writer.write(sample(1, 0, std::string(2 * kSizeMax, 'x'))));
    }
    if (k % 50 == 0) reader.take();
  }
  ASSERT_TRUE(wait_for([&] {
    reader.take();
    return !reader.taken.empty() && count_of(reader.taken.back()) == 399;
  }));
  for (const Cdr& cdr : reader.taken) EXPECT_EQ(cdr, sample(1, count_of(cdr)));
}

TEST_P(PluginTest, TakesNoMoreThanAskedFor) {
  TestWriter writer(writing_, "count", kKeyed, kEvent);
  TestReader reader(reading_, "count", kKeyed, kEvent);
  ASSERT_TRUE(connected(writer, reader));
  for (std::uint32_t count = 1; count <= 40; ++count) ASSERT_TRUE(writer.write(sample(1, count)));
  ASSERT_TRUE(wait_for([&] {
    EXPECT_LE(reader.take(3), 3u);
    return reader.taken.size() == 40;
  }));
  for (std::uint32_t k = 0; k < 40; ++k) EXPECT_EQ(count_of(reader.taken[k]), k + 1);
  EXPECT_EQ(reader.take(), 0u);
}

TEST_P(PluginTest, CountsMatchedPeersDownWhenTheyGo) {
  TestWriter writer(writing_, "matched", kKeyed, kSensor);
  {
    TestReader reader(reading_, "matched", kKeyed, kSensor);
    ASSERT_TRUE(connected(writer, reader));
  }
  EXPECT_TRUE(wait_for([&] { return writer.matched() == 0; }));
}

TEST_P(PluginTest, NeverMatchesKeyedWithUnkeyed) {
  TestWriter writer(writing_, "mixed", kKeyed, kSensor);
  TestReader reader(reading_, "mixed", kUnkeyed, kSensor);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(writer.matched() + reader.matched(), 0u);
}

TEST_P(PluginTest, SignalsNothingAfterItsReaderIsDestroyed) {
  TestWriter writer(writing_, "signals", kKeyed, kSensor);
  std::atomic<bool> stop{false};
  std::thread hammer([&] {
    for (std::uint32_t count = 0; !stop; ++count) {
      writer.write(sample(count % 8, count));
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  });
  for (int round = 0; round < 5; ++round) {
    TestReader reader(reading_, "signals", kKeyed, kSensor);
    EXPECT_TRUE(wait_for([&] { return reader.signals() > 10; }));
    reader.destroy();
    const std::uint32_t at_destruction = reader.signals();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(reader.signals(), at_destruction);
  }
  stop = true;
  hammer.join();
}

std::string name_of(const testing::TestParamInfo<Vendors>& info) {
  return std::string(std::get<0>(info.param)) + "_to_" + std::get<1>(info.param);
}

INSTANTIATE_TEST_SUITE_P(Vendors, PluginTest,
                         testing::Combine(testing::Values("fastdds", "cyclonedds"),
                                          testing::Values("fastdds", "cyclonedds")),
                         name_of);

}  // namespace
}  // namespace eciton::bus
