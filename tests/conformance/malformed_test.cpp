// What a stray or hostile peer sends under a proper topic and type is counted, and never delivered.
#include <limits>

#include "tests/conformance/ring.hpp"

namespace eciton::bus::conformance {
namespace {

class MalformedConformance : public Conformance {
 protected:
  using Bytes = std::vector<std::uint8_t>;

  static Bytes bytes_of(std::uint32_t module_id, double push_N = 0) {
    msg::DockingState state;
    state.module_id = module_id;
    state.push_N = push_N;
    Bytes bytes(TypeTraits<msg::DockingState>::size_max);
    bytes.resize(encode(state, bytes));
    return bytes;
  }
};

TEST_P(MalformedConformance, IsCountedAndNeverDelivered) {
  auto writer = a.create_raw_writer(info(topics::docking_state));
  auto reader = b.create_reader(topics::docking_state);
  ASSERT_TRUE(matched(writer, reader));
  // Each under a key of its own, so that none replaces another on the way.
  std::vector<Bytes> malformed = {bytes_of(1, std::numeric_limits<double>::quiet_NaN()),
                                  bytes_of(2, -std::numeric_limits<double>::infinity()), bytes_of(3), bytes_of(4),
                                  bytes_of(5)};
  malformed[2][16] = 200;  // phase: no such enumerator (header 4, key 4, stamp at 12 behind its padding ends at 20)
  malformed[2][20] = 200;
  malformed[3].resize(malformed[3].size() - 8);  // the last number is missing
  for (std::size_t k = 8; k < malformed[4].size(); ++k) malformed[4][k] = 0xff;
  for (const Bytes& bytes : malformed) EXPECT_TRUE(writer.write(bytes));
  EXPECT_TRUE(writer.write(bytes_of(6)));
  std::vector<msg::DockingState> got;
  ASSERT_TRUE(take_until(
      reader, got,
      [&](const auto&) { return reader.statistics().dropped_malformed == malformed.size() && !got.empty(); }))
      << reader.statistics().dropped_malformed << " of " << malformed.size() << " were counted";
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].module_id, 6u);
  EXPECT_EQ(b.dropped(), malformed.size());
}

TEST_P(MalformedConformance, WhatIsNotEvenCdrIsRefusedAtTheWriter) {
  auto writer = a.create_raw_writer(info(topics::docking_state));
  Bytes xcdr2 = bytes_of(1), too_large = bytes_of(1);
  xcdr2[1] = 7;
  too_large.resize(TypeTraits<msg::DockingState>::size_max + 4);
  for (const Bytes& bytes : {Bytes{}, Bytes{0, 1}, Bytes{0, 1, 0, 0}, xcdr2, too_large})
    EXPECT_FALSE(writer.write(bytes)) << bytes.size() << " bytes";
}

TEST_P(MalformedConformance, RawReadersCountItToo) {
  // Local delivery, past the plugin's own checks.
  auto writer = a.create_raw_writer(info(topics::docking_state));
  auto reader = a.create_raw_reader(info(topics::docking_state));
  writer.write(Bytes{0, 1, 0, 0});
  int given = 0;
  reader.take([](void* count, std::span<const std::uint8_t>) { ++*static_cast<int*>(count); }, &given);
  EXPECT_EQ(given, 0);
  EXPECT_EQ(reader.statistics().dropped_malformed, 1u);
}

INSTANTIATE_TEST_SUITE_P(Malformed, MalformedConformance, ::testing::ValuesIn(all_pairs), name_of);

}  // namespace
}  // namespace eciton::bus::conformance
