// Messages as JSON and as text, against what a person wrote down.
#include "deploy/command/message_json.hpp"

#include <gtest/gtest.h>

#include "deploy/command/topic_catalogue.hpp"
#include "idl/topics.hpp"

namespace eciton::deploy {
namespace {

msg::RotorCommand two_rotors() {
  msg::RotorCommand command;
  command.module_id = 2;
  command.stamp_ns = 1'700'000'000'123'456'789;
  command.state_stamp_ns = -1;
  command.safe_output = static_cast<msg::SafeOutput>(1);
  command.rotors.push_back({.thrust_N = 12.8, .gimbal_rad = {0.25, -0.5}});
  command.rotors.push_back({.thrust_N = 1.0 / 3, .gimbal_rad = {}});
  return command;
}

TEST(MessageJsonTest, ShowsNestedSequencesEnumeratorsAndWholeIntegers) {
  const std::string second(bus::EnumTraits<msg::SafeOutput>::names[1]);
  EXPECT_EQ(to_json(two_rotors()).dump(),
            R"({"module_id":2,"stamp_ns":1700000000123456789,"state_stamp_ns":-1,"armed":false,"safe_output":")" +
                second +
                R"(","rotors":[{"thrust_N":12.8,"gimbal_rad":[0.25,-0.5]},)"
                R"({"thrust_N":0.3333333333333333,"gimbal_rad":[0.0,0.0]}]})");
}

TEST(MessageJsonTest, LaysItOutForPeople) {
  const std::string second(bus::EnumTraits<msg::SafeOutput>::names[1]);
  EXPECT_EQ(to_text(to_json(two_rotors())),
            "module_id: 2\nstamp_ns: 1700000000123456789\nstate_stamp_ns: -1\narmed: false\nsafe_output: " + second +
                "\nrotors:\n  - thrust_N: 12.8\n    gimbal_rad: [0.25, -0.5]\n"
                "  - thrust_N: 0.333333\n    gimbal_rad: [0, 0]\n");
}

TEST(MessageJsonTest, ShowsArraysStringsAndBooleans) {
  msg::Imu imu;
  imu.module_id = 3;
  imu.specific_force_M_m_s2 = {0.1, -2, 9.81};
  EXPECT_EQ(to_json(imu)["specific_force_M_m_s2"].dump(), "[0.1,-2.0,9.81]");
  EXPECT_NE(to_text(to_json(imu)).find("specific_force_M_m_s2: [0.1, -2, 9.81]\n"), std::string::npos);

  msg::ModuleInfo module;
  module.name = "seven \"of\" nine";
  EXPECT_EQ(to_json(module)["name"].dump(), R"("seven \"of\" nine")");

  msg::Beacon beacon;
  beacon.duplicate_id = true;
  EXPECT_EQ(to_json(beacon)["duplicate_id"].dump(), "true");
  EXPECT_EQ(to_json(beacon)["peers"].dump(), "[]");
}

TEST(MessageJsonTest, NamesTheKey) {
  msg::LatchState latch;
  latch.module_id = 4;
  latch.port = 1;
  EXPECT_EQ(key_text(key_to_json(latch)), "module_id 4, port 1");
  EXPECT_EQ(key_text(key_to_json(msg::Clock{})), "");
}

TEST(TopicCatalogueTest, HoldsEveryTopicOnceAndDecodesItsType) {
  std::size_t count = 0;
  topics::for_each([&](const auto& topic) {
    using Type = typename std::decay_t<decltype(topic)>::Type;
    ++count;
    const TopicEntry& entry = find_topic(std::string(topic.name));
    Type sample;
    sample.stamp_ns = 42;
    std::vector<std::uint8_t> bytes(bus::TypeTraits<Type>::size_max);
    const std::size_t size = bus::encode(sample, bytes);
    const auto decoded = entry.decode(std::span(bytes).first(size));
    ASSERT_TRUE(decoded.has_value()) << topic.name;
    EXPECT_EQ(decoded->stamp_ns, 42);
    EXPECT_EQ(decoded->message["stamp_ns"], 42);
    EXPECT_EQ(decoded->key.size(), entry.keys.size()) << topic.name;
    EXPECT_FALSE(entry.decode(std::span(bytes).first(size - 4)).has_value()) << topic.name;
  });
  EXPECT_EQ(topic_catalogue().size(), count);
}

}  // namespace
}  // namespace eciton::deploy
