// Participants of either vendor: their life, their place on the network, and what they say when it is wrong.
#include <gtest/gtest.h>

#include "tests/core/bus/vendors/plugin_handles.hpp"

namespace eciton::bus {
namespace {

class ParticipantTest : public testing::TestWithParam<const char*> {};

TEST_P(ParticipantTest, SaysWhatItIs) {
  const eciton_plugin& abi = plugin(GetParam());
  EXPECT_EQ(abi.abi_version, ECITON_PLUGIN_ABI_VERSION);
  EXPECT_EQ(abi.struct_size, sizeof(eciton_plugin));
  EXPECT_STREQ(abi.vendor, GetParam());
  EXPECT_GT(std::string(abi.version).size(), 2u);
}

TEST_P(ParticipantTest, NamesAnUnknownInterfaceAndThoseThatExist) {
  const TestParticipant participant(GetParam(), domain_of_this_run(), {}, "wlan9");
  ASSERT_EQ(participant.handle(), nullptr);
  EXPECT_NE(participant.error().find("\"wlan9\" does not exist"), std::string::npos) << participant.error();
  EXPECT_NE(participant.error().find("lo"), std::string::npos) << participant.error();
}

TEST_P(ParticipantTest, NamesAPeerThatCannotBe) {
  const TestParticipant participant(GetParam(), domain_of_this_run(), {"127.0.0.1", "300.1.2.3"});
  ASSERT_EQ(participant.handle(), nullptr);
  EXPECT_NE(participant.error().find("\"300.1.2.3\""), std::string::npos) << participant.error();
}

TEST_P(ParticipantTest, NamesADomainThatCannotBe) {
  const TestParticipant participant(GetParam(), 240);
  ASSERT_EQ(participant.handle(), nullptr);
  EXPECT_NE(participant.error().find("domain 240"), std::string::npos) << participant.error();
}

TEST_P(ParticipantTest, CutsMessagesToTheCallersBuffer) {
  const eciton_participant_config config = {1, "test", "wlan9", nullptr, 0, 3000};
  char error[8] = "";
  EXPECT_EQ(plugin(GetParam()).participant_create(&config, error, sizeof error), nullptr);
  EXPECT_EQ(std::string(error).size(), 7u);
  EXPECT_EQ(plugin(GetParam()).participant_create(&config, nullptr, 0), nullptr);
}

TEST_P(ParticipantTest, NamesAnEndpointThatCannotBe) {
  TestParticipant participant(GetParam());
  eciton_type long_key = kKeyed;
  long_key.key_size = 20;
  const TestWriter writer(participant, "goals", long_key, kState);
  EXPECT_FALSE(writer.created());
  EXPECT_NE(writer.error().find("\"goals\""), std::string::npos) << writer.error();
  const eciton_qos no_depth = {1, 1, 0, 8};
  const TestReader reader(participant, "goals", kKeyed, no_depth);
  EXPECT_FALSE(reader.created());
  EXPECT_NE(reader.error().find("depth"), std::string::npos) << reader.error();
}

TEST_P(ParticipantTest, CanBeCreatedAgainAndAgain) {
  for (int round = 0; round < 5; ++round) {
    TestParticipant one(GetParam());
    TestParticipant two(GetParam());
    TestWriter writer(one, "again", kKeyed, kState);
    ASSERT_TRUE(writer.write(sample(1, static_cast<std::uint32_t>(round))));
    TestReader reader(two, "again", kKeyed, kState);
    ASSERT_TRUE(reader.wait_until_taken(1));
    EXPECT_EQ(count_of(reader.taken[0]), static_cast<std::uint32_t>(round));
  }
}

TEST_P(ParticipantTest, DiscoversUnicastPeersWithoutMulticast) {
  TestParticipant one(GetParam(), domain_of_this_run() + 20, {"127.0.0.1"});
  ASSERT_NE(one.handle(), nullptr) << one.error();
  for (const char* other_vendor : {"fastdds", "cyclonedds"}) {
    TestParticipant two(other_vendor, domain_of_this_run() + 20, {"127.0.0.1"});
    ASSERT_NE(two.handle(), nullptr) << two.error();
    TestWriter writer(one, "unicast", kKeyed, kState);
    TestReader reader(two, "unicast", kKeyed, kState);
    ASSERT_TRUE(writer.write(sample(1, 2)));
    EXPECT_TRUE(reader.wait_until_taken(1)) << GetParam() << " to " << other_vendor;
  }
}

TEST_P(ParticipantTest, IsNotLedAstrayByTheVendorsEnvironment) {
  setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='wlan9'/>", 1);
  setenv("FASTRTPS_DEFAULT_PROFILES_FILE", "/nowhere.xml", 1);
  setenv("ROS_DISCOVERY_SERVER", "127.0.0.1:11811", 1);
  {
    TestParticipant one(GetParam());
    TestParticipant two(GetParam());
    ASSERT_NE(one.handle(), nullptr) << one.error();
    TestWriter writer(one, "environment", kKeyed, kState);
    TestReader reader(two, "environment", kKeyed, kState);
    ASSERT_TRUE(writer.write(sample(1, 1)));
    EXPECT_TRUE(reader.wait_until_taken(1));
  }
  unsetenv("CYCLONEDDS_URI");
  unsetenv("FASTRTPS_DEFAULT_PROFILES_FILE");
  unsetenv("ROS_DISCOVERY_SERVER");
}

TEST_P(ParticipantTest, CarriesTwoDomainsInOneProcessApart) {
  TestParticipant module(GetParam());
  TestParticipant swarm(GetParam(), domain_of_this_run() + 1);
  TestParticipant peer(GetParam(), domain_of_this_run() + 1);
  TestWriter writer(swarm, "rings", kKeyed, kState);
  TestReader on_module(module, "rings", kKeyed, kState);
  TestReader on_swarm(peer, "rings", kKeyed, kState);
  ASSERT_TRUE(writer.write(sample(1, 1)));
  ASSERT_TRUE(on_swarm.wait_until_taken(1));
  EXPECT_EQ(on_module.take(), 0u);
}

TEST(CycloneDomainTest, NamesBothConfigurationsWhenTheyDiffer) {
  TestParticipant first("cyclonedds");
  TestParticipant second("cyclonedds", domain_of_this_run(), {"127.0.0.1"});
  EXPECT_EQ(second.handle(), nullptr);
  EXPECT_NE(second.error().find("multicast"), std::string::npos) << second.error();
  EXPECT_NE(second.error().find("peers 127.0.0.1"), std::string::npos) << second.error();
}

INSTANTIATE_TEST_SUITE_P(Vendors, ParticipantTest, testing::Values("fastdds", "cyclonedds"),
                         [](const auto& vendor) { return std::string(vendor.param); });

}  // namespace
}  // namespace eciton::bus
