// What the demo writes for its processes, and what it refuses before anything starts.
#include "deploy/command/demo_fleet.hpp"

#include <gtest/gtest.h>

#include <set>

#include "deploy/module_config.hpp"
#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton::deploy {
namespace {

class DemoFleetTest : public ::testing::Test {
 protected:
  void SetUp() override { ::unsetenv("ECITON_DDS"); }
  Result<DemoFleet> plan(DemoOptions options) {
    const Result<DemoOptions> resolved = resolve(std::move(options));
    if (!resolved) return resolved.error();
    return plan_demo(*resolved, "/opt/eciton/bin", "/run/eciton");
  }
  std::string refusal(DemoOptions options) {
    const auto fleet = plan(std::move(options));
    return fleet ? "accepted" : fleet.error().message;
  }
  static std::size_t processes(const DemoFleet& fleet) {
    std::size_t count = 0;
    for (const LaunchPlan& p : fleet.plans) count += p.processes.size();
    return count;
  }
};

TEST_F(DemoFleetTest, RunsNineteenProcessesForThreeModules) {
  const auto fleet = plan({});
  ASSERT_TRUE(fleet.ok()) << fleet.error().message;
  EXPECT_EQ(processes(*fleet), 19u);
  EXPECT_EQ(fleet->plans[0].processes[0].child.arguments[0], "/opt/eciton/bin/eciton-world");
  EXPECT_EQ(fleet->plans[2].name, "m2");
  EXPECT_EQ(fleet->plans[2].domain, 12u);
  std::vector<std::string> names;
  for (const PlannedProcess& process : fleet->plans[1].processes) names.push_back(process.name);
  EXPECT_EQ(names, (std::vector<std::string>{"hardware", "estimation", "control", "docking", "joints", "radio"}));
}

TEST_F(DemoFleetTest, RunsTwoProcessesAModuleWhenComposed) {
  const auto fleet = plan({.modules = 2, .layout = "composed"});
  ASSERT_TRUE(fleet.ok()) << fleet.error().message;
  EXPECT_EQ(processes(*fleet), 5u);
  const auto& arguments = fleet->plans[1].processes[1].child.arguments;
  EXPECT_EQ((std::vector<std::string>(arguments.begin() + 1, arguments.begin() + 6)),
            (std::vector<std::string>{"estimation", "control", "docking", "joints", "radio"}));
}

TEST_F(DemoFleetTest, WritesConfigsThatTheProcessesAccept) {
  Scratch scratch;
  DemoOptions options{.modules = 4, .dds = "mixed", .clock = "wall", .assignments = {"law=paper", "wakes=off"}};
  const auto fleet = plan_demo(*resolve(options), "/bin", scratch.path());
  ASSERT_TRUE(fleet.ok()) << fleet.error().message;
  ASSERT_EQ(fleet->files.size(), 5u);
  std::filesystem::create_directory(scratch.path() / "demo");
  for (const DemoFile& file : fleet->files) std::ofstream(file.path) << file.text;
  for (std::uint32_t id = 1; id <= 4; ++id) {
    const auto config = load_module_config({fleet->files[id].path}, {});
    ASSERT_TRUE(config.ok()) << config.error().message;
    EXPECT_EQ(config->id, id);
    EXPECT_EQ(config->clock, "wall");
    EXPECT_EQ(config->control.law, "paper");
    EXPECT_EQ(config->hal.socket, (scratch.path() / "demo" / "world.sock").string());
  }
  EXPECT_NE(fleet->files[0].text.find("wakes: off"), std::string::npos) << fleet->files[0].text;
}

TEST_F(DemoFleetTest, AlternatesVendorsWithinAndAcrossModules) {
  const auto fleet = plan({.dds = "mixed"});
  ASSERT_TRUE(fleet.ok()) << fleet.error().message;
  for (std::size_t m = 1; m < fleet->plans.size(); ++m) {
    const auto& processes_of = fleet->plans[m].processes;
    for (std::size_t k = 1; k < processes_of.size(); ++k) {
      EXPECT_NE(processes_of[k].vendor, processes_of[k - 1].vendor);
      if (m > 1) {
        EXPECT_NE(processes_of[k].vendor, fleet->plans[m - 1].processes[k].vendor);
      }
    }
  }
}

TEST_F(DemoFleetTest, KeepsModulesApartAtTheStart) {
  const auto fleet = plan({.modules = 8});
  ASSERT_TRUE(fleet.ok());
  for (std::size_t k = 1; k < fleet->start_m.size(); ++k) {
    EXPECT_GT(fleet->start_m[k][0] - fleet->start_m[k - 1][0], 1.6);
  }
}

TEST_F(DemoFleetTest, TakesItsOwnOptionsAsKeysToo) {
  const auto options = resolve({.assignments = {"modules=4", "dds=fastdds", "wakes=off"}});
  ASSERT_TRUE(options.ok());
  EXPECT_EQ(options->modules, 4u);
  EXPECT_EQ(options->dds, "fastdds");
  EXPECT_EQ(options->assignments, (std::vector<std::string>{"wakes=off"}));
}

TEST_F(DemoFleetTest, NamesWhatIsWrongAndWhereItStands) {
  EXPECT_NE(refusal({.assignments = {"modules=40"}}).find("from 2 to 8"), std::string::npos);
  EXPECT_NE(refusal({.assignments = {"dds=opendds"}}).find("cyclonedds"), std::string::npos);
  const std::string key = refusal({.assignments = {"control.lav=local"}});
  EXPECT_NE(key.find("--set control.lav=local"), std::string::npos) << key;
  EXPECT_NE(key.find("unknown key 'control.lav'"), std::string::npos) << key;
  const std::string value = refusal({.assignments = {"law=best"}});
  EXPECT_NE(value.find("local"), std::string::npos) << value;
  const std::string world = refusal({.assignments = {"world.gust_N=90"}});
  EXPECT_NE(world.find("gust_N"), std::string::npos) << world;
  const std::string form = refusal({.assignments = {"law"}});
  EXPECT_NE(form.find("key=value"), std::string::npos) << form;
}

TEST_F(DemoFleetTest, RefusesASocketPathThatNoSocketCanHave) {
  const auto fleet = plan_demo(*resolve({}), "/bin", "/" + std::string(120, 'x'));
  ASSERT_FALSE(fleet.ok());
  EXPECT_NE(fleet.error().message.find("ECITON_RUNTIME_DIR"), std::string::npos);
}

}  // namespace
}  // namespace eciton::deploy
