// What the generated headers state about a type, against values computed by hand from the XCDR1 rules and
// against Fast DDS's generator (fastdds_sizes.hpp).
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "idl/all.hpp"
#include "idl/every_kind.hpp"
#include "tests/idl/fastdds_sizes.hpp"

namespace eciton::bus {
namespace {

using eciton_test::wide::EveryKind;

template <class T>
std::vector<std::string> visited_names(bool key_only) {
  std::vector<std::string> names;
  const T sample{};
  const auto visitor = [&names](std::string_view name, const auto&) { names.emplace_back(name); };
  if (key_only) {
    TypeTraits<T>::visit_key(visitor, sample);
  } else {
    TypeTraits<T>::visit(visitor, sample);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(TypeTraitsTest, NamesTypesAsTheyAreCalledOnTheWire) {
  EXPECT_EQ(TypeTraits<msg::ModuleState>::name, "eciton::msg::ModuleState");
  EXPECT_EQ(TypeTraits<msg::Rotor>::name, "eciton::msg::Rotor");
  EXPECT_EQ(TypeTraits<EveryKind>::name, "eciton_test::wide::EveryKind");
}

TEST(TypeTraitsTest, TellsTopicsFromNestedStructsAndKeyedFromUnkeyed) {
  EXPECT_TRUE(TypeTraits<msg::ModuleState>::topic);
  EXPECT_TRUE(TypeTraits<msg::ModuleState>::keyed);
  EXPECT_FALSE(TypeTraits<msg::Rotor>::topic);
  EXPECT_FALSE(TypeTraits<msg::Rotor>::keyed);
  EXPECT_TRUE(TypeTraits<msg::Clock>::topic);
  EXPECT_FALSE(TypeTraits<msg::Clock>::keyed);
}

TEST(TypeTraitsTest, ComputesTheGreatestSizeOfAFixedSizeType) {
  // 4 header; id 0-4, stamp 8-16, mode 16-20, p 24-48, q 48-80, v 80-104, w 104-128, variance 128-224, age 224-232.
  EXPECT_EQ(TypeTraits<msg::ModuleState>::size_max, 4U + 232U);
  // Stamp 0-8, tick 8-16, flag 16-17: 21 bytes, padded to 24.
  EXPECT_EQ(TypeTraits<msg::Clock>::size_max, 24U);
}

TEST(TypeTraitsTest, CountsStringsWithLengthAndTerminator) {
  // id 0-4, goal 4-8, stamp 8-16, correlation 16-24, phase 24-28, reason 28: 4 + 127 + 1 to 160.
  EXPECT_EQ(TypeTraits<msg::GoalStatus>::size_max, 4U + 160U);
}

TEST(TypeTraitsTest, AlignsEachElementOfASequenceOfStructs) {
  // Beacon: id 0-4, mode 4-8, stamp 8-16, incarnation 16-24, mode 24-28, flags 28-30, count 32-36. Echoes: the first
  // 36-56 (id 36-40, then two int64), every further one 24 more (4 of padding after its id).
  EXPECT_EQ(TypeTraits<msg::Beacon>::size_max, 4U + 56U + 15U * 24U);
}

TEST(TypeTraitsTest, ComputesTheSizeOfEveryKindOfMember) {
  // key_a 0-2, key_b 2, key_c 8-16, flag 16, letter 17, raw 18, tiny 19, u16 20-22, i32 24-28, u32 28-32-36, i64
  // 40-48, u64 48-56, single 56-60, stamp 64-72, word 72-76, mode 76-80, vector 80-104, inners: count 104-108, first
  // 108, second 112-120, text 120-130; 130, 136-144, 144-154; pair: 154, 160-168, 168-178; 178, 184-192, 192-202;
  // texts 204-212-220; words: count 220-224, 224-231, 232-239, 240-247; keywords: count 248-252, to 264; bytes:
  // 264-268, to 273; numbers: count 276-280, to 296; last 296-297. With the header 301, padded to 304.
  EXPECT_EQ(TypeTraits<EveryKind>::size_max, 304U);
}

TEST(TypeTraitsTest, ComputesTheSizeOfTheKeyAlone) {
  EXPECT_EQ(TypeTraits<msg::ModuleState>::key_size, 4U);
  EXPECT_EQ(TypeTraits<msg::LinkClaim>::key_size, 8U);
  EXPECT_EQ(TypeTraits<msg::GoalStatus>::key_size, 8U);  // a number and an enum
  EXPECT_EQ(TypeTraits<msg::Clock>::key_size, 0U);
  EXPECT_EQ(TypeTraits<EveryKind>::key_size, 16U);  // int16 0-2, uint8 2-3, uint64 8-16
}

TEST(TypeTraitsTest, VisitsMembersInTheOrderOfTheWire) {
  EXPECT_EQ(visited_names<msg::ModuleState>(false), (Names{"module_id", "stamp_ns", "mode", "p_WM_m", "q_WM",
                                                           "v_WM_m_s", "w_WM_M_rad_s", "variance", "pose_age_s"}));
  EXPECT_EQ(visited_names<msg::ModuleState>(true), (Names{"module_id"}));
  EXPECT_EQ(visited_names<msg::LatchState>(true), (Names{"module_id", "port"}));
  EXPECT_EQ(visited_names<EveryKind>(true), (Names{"key_a", "key_b", "key_c"}));
  EXPECT_EQ(visited_names<msg::Clock>(true), Names{});
}

TEST(TypeTraitsTest, LetsAVisitorChangeTheSample) {
  msg::Clock clock;
  TypeTraits<msg::Clock>::visit(
      []<class T>(std::string_view name, T& value) {
        if (name == "tick") value = static_cast<T>(7);
      },
      clock);
  EXPECT_EQ(clock, (msg::Clock{.stamp_ns = 0, .tick = 7, .imu_sampled = false}));
}

TEST(TypeTraitsTest, MapsIdlTypesToPlainCpp) {
  EXPECT_TRUE((std::is_same_v<decltype(msg::ModuleState::p_WM_m), std::array<double, 3>>));
  EXPECT_TRUE((std::is_same_v<decltype(msg::ModuleInfo::name), BoundedString<31>>));
  EXPECT_TRUE((std::is_same_v<decltype(msg::Beacon::peers), BoundedVector<msg::PeerEcho, 16>>));
  EXPECT_TRUE((std::is_same_v<decltype(msg::LinkClaim::withdrawn), bool>));
  EXPECT_TRUE((std::is_same_v<decltype(EveryKind::mode), eciton_test::IMUMode>));
  EXPECT_TRUE((std::is_same_v<decltype(EveryKind::texts), std::array<BoundedString<3>, 2>>));
}

TEST(TypeTraitsTest, ServesMessagesAndNothingElse) {
  EXPECT_TRUE(Message<msg::Beacon>);
  EXPECT_TRUE(Message<msg::Rotor>);
  EXPECT_FALSE(Message<msg::FlightMode>);
  EXPECT_FALSE(Message<int>);
}

TEST(EnumTraitsTest, NamesTheValuesWithoutTheEnumsOwnName) {
  using Traits = EnumTraits<msg::EstimatorMode>;
  EXPECT_EQ(Traits::name, "eciton::msg::EstimatorMode");
  EXPECT_EQ(Traits::names, (std::array<std::string_view, 4>{"initialising", "ready", "dead_reckoning", "lost"}));
  EXPECT_EQ(static_cast<std::uint32_t>(msg::EstimatorMode::dead_reckoning), 2U);
}

TEST(EnumTraitsTest, TakesAnAcronymForOneWord) {
  EXPECT_EQ(EnumTraits<eciton_test::IMUMode>::names, (std::array<std::string_view, 2>{"off", "on_board2"}));
}

TEST(EnumTraitsTest, AppendsAnUnderscoreToKeywordsInCppOnly) {
  EXPECT_EQ(static_cast<std::uint32_t>(msg::FlightAction::goto_), 1U);
  EXPECT_EQ(EnumTraits<msg::FlightAction>::names[1], "goto");
}

template <class... T>
std::map<std::string_view, SerializedSize> own_sizes(std::type_identity<std::tuple<T...>>) {
  return {{TypeTraits<T>::name, {TypeTraits<T>::size_max, TypeTraits<T>::key_size}}...};
}

TEST(SizeTest, AgreesWithFastDdsOnEveryType) {
  auto own = own_sizes(std::type_identity<msg::AllTypes>{});
  own.merge(own_sizes(std::type_identity<std::tuple<EveryKind, eciton_test::wide::Unkeyed, eciton_test::Vector>>{}));
  const std::map<std::string_view, SerializedSize> theirs = fastdds_sizes();
  EXPECT_EQ(own.size(), theirs.size());
  for (const auto& [name, size] : theirs) {
    ASSERT_TRUE(own.contains(name)) << name;
    EXPECT_EQ(own.at(name).size_max, size.size_max) << name;
    EXPECT_EQ(own.at(name).key_size, size.key_size) << name;
  }
}

}  // namespace
}  // namespace eciton::bus
