// Peers that die and return, and what a wrong vendor, plugin or interface is answered with.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "tests/conformance/peer_process.hpp"
#include "tests/conformance/ring.hpp"

namespace eciton::bus::conformance {
namespace {

/// sim_network has no processes: its peer's participant is destroyed.
class PeerParticipant {
 public:
  explicit PeerParticipant(int incarnation) : participant_(config_of("sim_network", test_domain(), short_lease)) {
    auto mine = claim(7, 0, 1);
    mine.incarnation = static_cast<std::uint64_t>(incarnation);
    claims_.write(mine);
    states_.write(state_at(7, 0));
  }

 private:
  Participant participant_;
  Writer<msg::LinkClaim> claims_ = participant_.create_writer(topics::link_claim);
  Writer<msg::ModuleState> states_ = participant_.create_writer(topics::module_state);
};

class FailureConformance : public ::testing::TestWithParam<Pair> {
 protected:
  Participant here{config_of(GetParam().reader, test_domain(), short_lease)};
};

/// One or the other, as the vendor has it.
class Peer {
 public:
  Peer(const std::string& vendor, int incarnation) {
    if (vendor == "sim_network") {
      participant_.emplace(incarnation);
    } else {
      process_.emplace(vendor, incarnation);
    }
  }

 private:
  std::optional<PeerProcess> process_;
  std::optional<PeerParticipant> participant_;
};

TEST_P(FailureConformance, APeerThatDiesIsNoticedAndHeardAgainWhenItReturns) {
  auto claims = here.create_reader(topics::link_claim);
  auto states = here.create_reader(topics::module_state);
  for (int incarnation = 1; incarnation <= 2; ++incarnation) {
    std::optional<Peer> peer(std::in_place, GetParam().writer, incarnation);
    std::vector<msg::LinkClaim> heard;
    EXPECT_TRUE(take_until(claims, heard, [&](const auto& all) { return !all.empty(); })) << "life " << incarnation;
    EXPECT_TRUE(eventually([&] { return states.take().has_value(); })) << "life " << incarnation;
    ASSERT_FALSE(heard.empty());
    EXPECT_EQ(heard.back().incarnation, static_cast<std::uint64_t>(incarnation));
    EXPECT_TRUE(eventually([&] { return claims.matched() == 1; }));
    peer.reset();
    EXPECT_TRUE(eventually([&] { return claims.matched() == 0 && states.matched() == 0; })) << "life " << incarnation;
  }
}

TEST_P(FailureConformance, AllWritersOfAParticipantHaveOneOriginAndItsNextLifeHasAnother) {
  auto claims = here.create_reader(topics::link_claim);
  auto states = here.create_reader(topics::module_state);
  claims.tell_origins(), states.tell_origins();
  std::uint64_t before = 0;
  for (int incarnation = 1; incarnation <= 2; ++incarnation) {
    const Peer peer(GetParam().writer, incarnation);
    std::uint64_t of_claim = 0, of_state = 0;
    EXPECT_TRUE(eventually([&] {
      while (const auto claim = claims.take()) {
        if (claim->value.incarnation == static_cast<std::uint64_t>(incarnation)) of_claim = claim->origin;
      }
      // States of the last life may still be there.
      while (const auto state = states.take()) of_state = state->origin;
      return of_claim != 0 && of_state == of_claim;
    })) << "life "
        << incarnation << ": claim " << of_claim << ", state " << of_state;
    EXPECT_NE(of_claim, before);
    before = of_claim;
  }
}

TEST_P(FailureConformance, AParticipantsOwnSamplesAreKnownAsItsOwn) {
  auto writer = here.create_writer(topics::link_claim);
  auto reader = here.create_reader(topics::link_claim);
  writer.write(claim(1, 0, 1));
  const auto silent = reader.take();
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->origin, 0u) << "it was not asked to tell";
  reader.tell_origins();
  writer.write(claim(1, 0, 2));
  const auto own = reader.take();
  ASSERT_TRUE(own);
  EXPECT_EQ(own->origin, ReaderCore::own_origin);
}

INSTANTIATE_TEST_SUITE_P(Failure, FailureConformance, ::testing::ValuesIn(all_pairs), name_of);

/// The message of the BadInput that joining with this vendor ends in.
std::string refusal(const ParticipantConfig& config) {
  try {
    Participant participant(config);
  } catch (const BadInput& bad) {
    return bad.error.message;
  }
  return "no error";
}

/// Looks for plugins in `directory` first, until the end of the test.
class PluginPath {
 public:
  explicit PluginPath(const std::string& directory) : before_(std::getenv("ECITON_PLUGIN_PATH")) {
    ::setenv("ECITON_PLUGIN_PATH", (directory + ":" + (before_ ? before_ : "")).c_str(), 1);
  }
  ~PluginPath() {
    if (before_) {
      ::setenv("ECITON_PLUGIN_PATH", std::string(before_).c_str(), 1);
    } else {
      ::unsetenv("ECITON_PLUGIN_PATH");
    }
  }

 private:
  const char* before_;
};

TEST(PluginErrorTest, AnUnknownVendorIsNamedWithThosethatThereAre) {
  EXPECT_EQ(refusal(config_of("opendds")).rfind("DDS vendor 'opendds': no libeciton_dds_opendds.so in ", 0), 0u)
      << refusal(config_of("opendds"));
  EXPECT_NE(refusal(config_of("opendds")).find("available: cyclonedds, fastdds, sim_network"), std::string::npos)
      << refusal(config_of("opendds"));
  EXPECT_EQ(refusal(config_of("../fastdds")).rfind("DDS vendor '../fastdds' is not a vendor's name; available: ", 0),
            0u);
  EXPECT_EQ(refusal(config_of("")).rfind("DDS vendor '' is not a vendor's name; available: ", 0), 0u);
}

TEST(PluginErrorTest, APluginOfAnotherAbiIsRefused) {
  const PluginPath path(ECITON_BAD_PLUGINS);
  EXPECT_EQ(refusal(config_of("wrong_abi")),
            "DDS plugin " ECITON_BAD_PLUGINS
            "/libeciton_dds_wrong_abi.so has ABI version 999, this program needs 3: install the plugin of the same "
            "Eciton release");
}

TEST(PluginErrorTest, ALibraryThatIsNoPluginIsRefused) {
  const PluginPath path(ECITON_BAD_PLUGINS);
  EXPECT_EQ(refusal(config_of("no_entry")),
            "DDS plugin " ECITON_BAD_PLUGINS
            "/libeciton_dds_no_entry.so exports no function eciton_dds_plugin: it is not an Eciton plugin");
}

TEST(PluginErrorTest, AFileThatDoesNotLoadIsRefused) {
  const auto directory = std::filesystem::temp_directory_path() / ("eciton_plugins_" + std::to_string(::getpid()));
  std::filesystem::create_directory(directory);
  std::ofstream(directory / "libeciton_dds_garbage.so") << "not a library";
  {
    const PluginPath path(directory.string());
    const std::string message = refusal(config_of("garbage"));
    EXPECT_EQ(
        message.rfind("DDS plugin " + (directory / "libeciton_dds_garbage.so").string() + " does not load: ", 0), 0u)
        << message;
  }
  std::filesystem::remove_all(directory);
}

TEST(PluginErrorTest, AnUnknownInterfaceIsNamedWithThoseThatThereAre) {
  for (const char* vendor : {"fastdds", "cyclonedds"}) {
    ParticipantConfig config = config_of(vendor);
    config.network_interface = "no_such_if0";
    const std::string message = refusal(config);
    EXPECT_EQ(message.rfind(std::string(vendor) + ", domain ", 0), 0u) << message;
    EXPECT_NE(message.find("no_such_if0"), std::string::npos) << message;
    EXPECT_NE(message.find("lo"), std::string::npos) << message;
  }
}

TEST(PluginErrorTest, AnImpossibleDomainIsRefused) {
  for (const char* vendor : {"fastdds", "cyclonedds"}) {
    const std::string message = refusal(config_of(vendor, 240));
    EXPECT_NE(message.find("240"), std::string::npos) << message;
    EXPECT_NE(message.find("232"), std::string::npos) << message;
  }
}

TEST(PluginErrorTest, ASecondParticipantOfOneNameOnTheSimulatedNetworkIsRefused) {
  const ParticipantConfig config = config_of("sim_network");
  const Participant first(config);
  EXPECT_NE(refusal(config).find("'" + config.name + "' is already in domain"), std::string::npos) << refusal(config);
}

}  // namespace
}  // namespace eciton::bus::conformance
