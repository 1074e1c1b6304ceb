// What `eciton demo --hosts` plans: which process goes where, and what it refuses.
#include <gtest/gtest.h>

#include "deploy/command/demo_fleet.hpp"
#include "deploy/module_config.hpp"
#include "deploy/world_file.hpp"

namespace eciton::deploy {
namespace {

class DemoHostsTest : public ::testing::Test {
 protected:
  void SetUp() override { ::unsetenv("ECITON_DDS"); }
  static Result<DemoFleet> plan(DemoOptions options, const std::optional<net::NetSpec>& running = {}) {
    options.hosts = true;
    const Result<DemoOptions> resolved = resolve(std::move(options));
    if (!resolved) return resolved.error();
    return plan_demo(*resolved, "/opt/eciton/bin", "/run/eciton", running);
  }
};

TEST_F(DemoHostsTest, EveryModuleHasAHostAndTheWorldAndTheDemoHaveNone) {
  const auto fleet = plan({.modules = 2, .seed = 9});
  ASSERT_TRUE(fleet.ok()) << fleet.error().message;
  ASSERT_EQ(fleet->plans.size(), 4u);  // world, two modules, relay
  EXPECT_EQ(fleet->plans[0].processes[0].child.network_namespace, "");
  for (const std::size_t module : {1u, 2u}) {
    const std::string host = "/run/netns/eciton-m" + std::to_string(module);
    EXPECT_EQ(fleet->plans[module].network_namespace, host);
    EXPECT_EQ(fleet->plans[module].network_interface, "lo");
    ASSERT_EQ(fleet->plans[module].processes.size(), 2u);  // composed
    for (const PlannedProcess& process : fleet->plans[module].processes)
      EXPECT_EQ(process.child.network_namespace, host);
  }
  EXPECT_EQ(fleet->swarm_interface, "eth0");
  EXPECT_EQ(fleet->swarm_namespace, "/run/netns/eciton-operator");
  ASSERT_TRUE(fleet->own_net);
  EXPECT_EQ(fleet->own_net->modules, 2u);
  EXPECT_EQ(fleet->own_net->seed, 9u);
  EXPECT_EQ(fleet->plans[3].processes[0].child.network_namespace, "");
}

TEST_F(DemoHostsTest, ItFliesOnTheWallClockAndTellsTheWorldWhereTheModulesAre) {
  const auto fleet = plan({.net = "other"});
  ASSERT_TRUE(fleet.ok()) << fleet.error().message;
  EXPECT_NE(fleet->files[0].text.find("net: other"), std::string::npos) << fleet->files[0].text;
  EXPECT_NE(fleet->files[0].text.find("pace: wall"), std::string::npos);
  EXPECT_NE(fleet->files[1].text.find("interface: eth0"), std::string::npos) << fleet->files[1].text;
  const auto refused = plan({.clock = "lockstep"});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("expected wall"), std::string::npos);
}

TEST_F(DemoHostsTest, ANetThatIsUpIsUsedIfItIsLargeEnough) {
  const auto fleet = plan({.modules = 3}, net::NetSpec{.modules = 4});
  ASSERT_TRUE(fleet.ok()) << fleet.error().message;
  EXPECT_FALSE(fleet->own_net);
  EXPECT_EQ(fleet->plans.size(), 4u);  // no relay of its own
  const auto refused = plan({.modules = 3}, net::NetSpec{.modules = 2});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("2 module hosts, 3 are needed"), std::string::npos)
      << refused.error().message;
}

TEST_F(DemoHostsTest, IdsAreTakenInTheNetOnlySoThatOthersMayFlyBeside) {
  const auto fleet = plan({.modules = 2});
  ASSERT_TRUE(fleet.ok());
  EXPECT_EQ(fleet->plans[1].claims[0], "module id 1 of net eciton");
}

TEST_F(DemoHostsTest, WithoutHostsNothingChanges) {
  const auto options = resolve({});
  ASSERT_TRUE(options.ok());
  EXPECT_EQ(options->clock, "lockstep");
  EXPECT_EQ(options->layout, "services");
  const auto fleet = plan_demo(*options, "/bin", "/run/eciton");
  ASSERT_TRUE(fleet.ok());
  EXPECT_EQ(fleet->plans[1].network_namespace, "");
  EXPECT_EQ(fleet->swarm_interface, "lo");
}

}  // namespace
}  // namespace eciton::deploy
