// Our codec against the serializers of fastddsgen and idlc: the same values must become the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "core/bus/participant.hpp"
#include "idl/topics.hpp"
#include "tests/native_peers/child_process.hpp"
#include "tests/native_peers/our_pattern.hpp"

namespace eciton::native_peers {
namespace {

using Golden = std::map<std::pair<std::string, std::uint64_t>, std::string>;

Golden golden_of(const std::string& vendor) {
  ChildProcess peer({beside_this_program("native_" + vendor + "_peer"), "golden"});
  EXPECT_TRUE(peer.wait_until_end(std::chrono::seconds(30)));
  EXPECT_EQ(peer.exit_status(), 0);
  Golden golden;
  std::istringstream lines(peer.output());
  std::string topic;
  std::uint64_t seed = 0;
  std::string bytes;
  while (lines >> topic >> seed >> bytes) golden[{topic, seed}] = bytes;
  return golden;
}

/// Hexadecimal without the options of the header (where a vendor may note the padding at the end).
std::string without_options(std::string hexadecimal) { return hexadecimal.replace(4, 4, ""); }

std::string to_hexadecimal(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

class GoldenTest : public testing::TestWithParam<const char*> {};

TEST_P(GoldenTest, OurCodecMakesTheSameBytesOfEveryType) {
  const Golden golden = golden_of(GetParam());
  std::size_t topics = 0;
  topics::for_each([&](const auto& topic) {
    ++topics;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto found = golden.find({std::string(topic.name), seed});
      ASSERT_NE(found, golden.end()) << topic.name << ": not in topics.def";
      std::string ours = to_hexadecimal(our_bytes(our_sample(topic, seed)));
      std::string theirs = found->second;
      // Ours ends at a multiple of four bytes, as what Cyclone DDS puts on the wire does.
      ASSERT_LE(theirs.size(), ours.size()) << topic.name;
      theirs.resize(ours.size(), '0');
      ASSERT_LT(ours.size() - found->second.size(), 8u) << topic.name;
      EXPECT_EQ(without_options(ours), without_options(theirs)) << topic.name << ", seed " << seed;
    }
  });
  EXPECT_EQ(golden.size(), topics * kSeeds) << "topics.def has topics that idl/topics.hpp has not";
}

TEST_P(GoldenTest, OurCodecReadsTheirBytesOfEveryType) {
  const Golden golden = golden_of(GetParam());
  topics::for_each([&](const auto& topic) {
    using T = typename std::remove_cvref_t<decltype(topic)>::Type;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto found = golden.find({std::string(topic.name), seed});
      ASSERT_NE(found, golden.end()) << topic.name;
      std::vector<std::uint8_t> bytes(found->second.size() / 2);
      for (std::size_t k = 0; k < bytes.size(); ++k) {
        bytes[k] = static_cast<std::uint8_t>(std::stoul(found->second.substr(2 * k, 2), nullptr, 16));
      }
      T sample;
      ASSERT_TRUE(bus::decode(bytes, sample)) << topic.name << ", seed " << seed;
      EXPECT_EQ(our_bytes(sample), our_bytes(our_sample(topic, seed))) << topic.name;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Vendors, GoldenTest, testing::Values("fastdds", "cyclonedds"),
                         [](const auto& vendor) { return std::string(vendor.param); });

struct ForeignTopic {
  std::string type;
  bool reliable;
  bool transient_local;
  std::uint32_t depth;
};

TEST(ForeignTopicsTest, AreThoseOfTheFramework) {
  std::map<std::string_view, ForeignTopic> foreign;
#define TOPIC(name, type, reliable, transient_local, depth) \
  foreign[#name] = {"eciton::msg::" #type, reliable, transient_local, depth};
#include "tests/native_peers/topics.def"
#undef TOPIC
  topics::for_each([&](const auto& topic) {
    using T = typename std::remove_cvref_t<decltype(topic)>::Type;
    ASSERT_TRUE(foreign.contains(topic.name)) << topic.name;
    const ForeignTopic& other = foreign[topic.name];
    const eciton_qos qos = bus::plugin_qos(topic.qos, true);
    EXPECT_EQ(other.type, bus::TypeTraits<T>::name) << topic.name;
    EXPECT_EQ(other.reliable, qos.reliable != 0) << topic.name;
    EXPECT_EQ(other.transient_local, qos.transient_local != 0) << topic.name;
    EXPECT_EQ(other.depth, qos.depth) << topic.name;
  });
}

}  // namespace
}  // namespace eciton::native_peers
