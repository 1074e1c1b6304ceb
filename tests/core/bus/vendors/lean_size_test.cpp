// Messages as Fast DDS makes them, laid out by hand: which may go without their statistics.
#include "core/bus/vendors/fastdds/lean_size.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace eciton::bus::fastdds {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& message, const Bytes& more) { message.insert(message.end(), more.begin(), more.end()); }

/// The header, and one submessage of data with a payload.
Bytes message(const Bytes& payload) {
  Bytes all{'R', 'T', 'P', 'S', 2, 3, 1, 15};
  all.resize(20);
  append(all, {0x15, 0x05, static_cast<std::uint8_t>(payload.size() + 20), 0});
  all.resize(all.size() + 20);
  append(all, payload);
  return all;
}

Bytes with_statistics(Bytes all, bool little = true) {
  append(all, little ? Bytes{0x80, 1, 56, 0} : Bytes{0x80, 0, 0, 56});
  all.resize(all.size() + 56);
  return all;
}

std::uint32_t size_of(const Bytes& all) { return lean_size(all.data(), static_cast<std::uint32_t>(all.size())); }

TEST(LeanSizeTest, LeavesStatisticsOut) {
  const Bytes lean = message(Bytes(64, 7));
  EXPECT_EQ(size_of(with_statistics(lean)), lean.size());
  EXPECT_EQ(size_of(with_statistics(lean, false)), lean.size());
}

TEST(LeanSizeTest, TouchesNoMessageWithoutThem) {
  EXPECT_EQ(size_of(message(Bytes(64, 7))), message(Bytes(64, 7)).size());
  EXPECT_EQ(size_of(message({})), message({}).size());
  Bytes looks_so(64, 7);
  looks_so[4] = 0x80;  // 60 bytes before the end, but of another length
  EXPECT_EQ(size_of(message(looks_so)), message(looks_so).size());
}

TEST(LeanSizeTest, KeepsThemWhereTheVendorWouldTakeThePayloadForThem) {
  Bytes payload(64, 7);
  payload[4] = 0x80;  // where statistics would begin, once they are gone
  const Bytes whole = with_statistics(message(payload));
  EXPECT_EQ(size_of(whole), whole.size());
}

}  // namespace
}  // namespace eciton::bus::fastdds
