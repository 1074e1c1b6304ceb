// `eciton net` as its users meet it: twice the same is once, nothing is left behind, also after a kill, and what is
// wrong is said.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "deploy/net/net.hpp"
#include "deploy/net/requests.hpp"
#include "tests/deploy/command/process.hpp"
#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton {
namespace {

namespace fs = std::filesystem;
using deploy::eventually;

tests::Ended eciton_command(std::vector<std::string> words) {
  words.insert(words.begin(), std::string(ECITON_PROGRAMS) + "/eciton");
  return tests::run(words);
}

class NetCommandTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Status rights = net::check_rights();
    if (!rights) GTEST_SKIP() << rights.error().message;
  }
  void TearDown() override {
    [[maybe_unused]] const Status removed = net::take_down(name);
    EXPECT_EQ(left(), std::vector<std::string>{});
  }

  /// What there is of the net: files, namespaces, processes.
  std::vector<std::string> left() const {
    std::vector<std::string> found;
    std::error_code none;
    for (const fs::path& directory : {fs::path("/run/netns"), fs::path("/run/eciton-net")}) {
      for (const auto& entry : fs::directory_iterator(directory, none)) {
        const std::string file = entry.path().filename();
        if (file == name || file.starts_with(name + "-")) found.push_back(entry.path());
      }
    }
    for (const auto& entry : fs::directory_iterator("/proc", none)) {
      std::string words = deploy::text_of(entry.path() / "cmdline");
      std::replace(words.begin(), words.end(), '\0', ' ');
      if (words.find(" " + name + " ") != std::string::npos) found.push_back(words);
    }
    return found;
  }
  tests::Ended up(std::vector<std::string> words = {"2"}) {
    words.insert(words.begin(), {"net", "up"});
    words.insert(words.end(), {"--name", name});
    return eciton_command(words);
  }
  pid_t relay() const {
    const auto known = net::find_net(name);
    return known ? known->relay : 0;
  }

  const std::string name = "c" + std::to_string(::getpid());
};

TEST_F(NetCommandTest, TwiceUpIsOnceUpAndTwiceDownIsOnceDown) {
  const auto first = up();
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_NE(first.out.find("net " + name + " is up"), std::string::npos) << first.out;
  const pid_t pid = relay();
  EXPECT_GT(pid, 0);
  EXPECT_EQ(up().status, 0);
  EXPECT_EQ(relay(), pid);
  for (const char* host : {"m1", "m2", "operator"}) EXPECT_TRUE(fs::exists("/run/netns/" + name + "-" + host));
  EXPECT_EQ(eciton_command({"net", "down", "--name", name}).status, 0);
  EXPECT_EQ(left(), std::vector<std::string>{});
  const auto again = eciton_command({"net", "down", "--name", name});
  EXPECT_EQ(again.status, 0);
  EXPECT_NE(again.out.find("no net " + name + " is up"), std::string::npos) << again.out;
}

TEST_F(NetCommandTest, AnotherSizeOfARunningNetIsRefused) {
  ASSERT_EQ(up().status, 0);
  const auto larger = up({"3"});
  EXPECT_EQ(larger.status, 2);
  EXPECT_NE(larger.err.find("is up with 2 module hosts"), std::string::npos) << larger.err;
}

TEST_F(NetCommandTest, SetsAndShows) {
  ASSERT_EQ(up().status, 0);
  const auto set =
      eciton_command({"net", "set", "--name", name, "--from", "m1", "--to", "m2", "delay=20ms", "loss=10%"});
  EXPECT_EQ(set.status, 0) << set.err;
  const auto shown = eciton_command({"net", "show", "--name", name});
  EXPECT_EQ(shown.status, 0) << shown.err;
  EXPECT_NE(shown.out.find("m1 -> m2"), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("delay=20ms loss=10%"), std::string::npos) << shown.out;
  const auto wrong = eciton_command({"net", "set", "--name", name, "--from", "m7", "loss=10%"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("no host 'm7'; there are operator, m1, m2"), std::string::npos) << wrong.err;
}

TEST_F(NetCommandTest, DownRemovesWhatAKilledRelayLeft) {
  ASSERT_EQ(up().status, 0);
  // Someone still works in one of the hosts.
  const auto sleeper = deploy::ChildProcess::start({.arguments = {"/bin/sleep", "600"},
                                                    .log_file = "/dev/null",
                                                    .network_namespace = net::host_namespace(name, 1)});
  ASSERT_TRUE(sleeper.ok()) << sleeper.error().message;
  ASSERT_TRUE(eventually([&] { return net::processes_in({net::host_namespace(name, 1)}).size() == 1; }));
  const pid_t pid = relay();
  ASSERT_GT(pid, 1);
  ASSERT_EQ(::kill(pid, SIGKILL), 0);
  ASSERT_TRUE(eventually([&] { return !net::find_net(name)->up; }));
  EXPECT_NE(left(), std::vector<std::string>{});  // the control: there is something to be removed
  const auto set = eciton_command({"net", "set", "--name", name, "loss=10%"});
  EXPECT_EQ(set.status, 2);
  EXPECT_NE(set.err.find("was killed"), std::string::npos) << set.err;
  const auto down = eciton_command({"net", "down", "--name", name});
  EXPECT_EQ(down.status, 0) << down.err;
  EXPECT_EQ(left(), std::vector<std::string>{});
  EXPECT_TRUE(eventually([&] {
    return sleeper->pid() <= 0 || ::kill(sleeper->pid(), 0) != 0 ||
           deploy::text_of("/proc/" + std::to_string(sleeper->pid()) + "/cmdline").empty();
  }));
}

TEST_F(NetCommandTest, UpAfterAKillMakesItAnew) {
  ASSERT_EQ(up().status, 0);
  const pid_t pid = relay();
  ASSERT_GT(pid, 1);
  ASSERT_EQ(::kill(pid, SIGKILL), 0);
  ASSERT_TRUE(eventually([&] { return !net::find_net(name)->up; }));
  const auto again = up({"1"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_FALSE(fs::exists("/run/netns/" + name + "-m2"));
}

TEST_F(NetCommandTest, ARelayThatHangsIsKilledByDown) {
  ASSERT_EQ(up().status, 0);
  ASSERT_EQ(::kill(relay(), SIGSTOP), 0);
  EXPECT_EQ(eciton_command({"net", "down", "--name", name}).status, 0);
  EXPECT_EQ(left(), std::vector<std::string>{});
}

TEST_F(NetCommandTest, InTheForegroundItEndsWithItsParentAndTidiesUp) {
  auto shell = deploy::ChildProcess::start(
      {.arguments = {"/bin/sh", "-c",
                     std::string(ECITON_PROGRAMS) + "/eciton net up 1 --foreground --name " + name + " & wait"},
       .log_file = "/dev/null"});
  ASSERT_TRUE(shell.ok());
  ASSERT_TRUE(net::wait_until_up(name, std::chrono::seconds(20)).ok());
  ASSERT_EQ(::kill(shell->pid(), SIGKILL), 0);  // the shell alone
  EXPECT_TRUE(eventually([&] { return net::known_nets().empty() || !net::find_net(name); }));
  EXPECT_TRUE(eventually([&] { return left().empty(); }));
}

TEST_F(NetCommandTest, AKilledOwnerLeavesNothing) {
  const pid_t owner = ::fork();
  if (owner == 0) {
    // As a measuring program has them: the kernel tells of the death once per thread.
    std::vector<std::jthread> threads;
    for (int k = 0; k < 8; ++k) threads.emplace_back([] { ::pause(); });
    const auto net = net::OwnedNet::start({.name = name, .modules = 1}, ECITON_PROGRAMS);
    ::pause();
    ::_exit(1);
  }
  ASSERT_TRUE(net::wait_until_up(name, std::chrono::seconds(20)).ok());
  ASSERT_EQ(::kill(owner, SIGKILL), 0);
  ::waitpid(owner, nullptr, 0);
  EXPECT_TRUE(eventually([&] { return left().empty(); }));
}

/// Not the flight, which takes its time, but what is new about it.
TEST_F(NetCommandTest, TheDemoPutsEveryModuleIntoItsHostAndItsSwarmOnTheRadio) {
  const deploy::Scratch scratch;
  auto demo = deploy::ChildProcess::start(
      {.arguments = {std::string(ECITON_PROGRAMS) + "/eciton", "demo", "--hosts", "--modules", "2", "--net", name},
       .environment = {{"ECITON_RUNTIME_DIR", scratch.file("run")}},
       .log_file = scratch.file("log")});
  ASSERT_TRUE(demo.ok()) << demo.error().message;
  const auto count = [&](std::uint32_t host) { return net::processes_in({net::host_namespace(name, host)}).size(); };
  const auto counted = [&](const char* from, const char* to, const char* counter) -> std::uint64_t {
    const auto answer = net::ask_net(name, net::show_request);
    if (!answer) return 0;
    const auto json = nlohmann::json::parse(*answer);
    for (const auto& link : json["links"]) {
      if (link["from"] == from && link["to"] == to) return link[counter];
    }
    return 0;
  };
  EXPECT_TRUE(eventually([&] { return count(1) == 2 && count(2) == 2; }));
  for (const auto& [from, to] : {std::pair("m1", "m2"), {"m2", "m1"}, {"operator", "m1"}, {"m2", "operator"}}) {
    EXPECT_TRUE(eventually([&, from = from, to = to] { return counted(from, to, "delivered") > 20; }))
        << from << " to " << to;
  }
  EXPECT_EQ(counted("m1", "m2", "lost"), 0u);
  EXPECT_EQ(eciton_command({"net", "set", "--name", name, "loss=50%"}).status, 0);
  EXPECT_TRUE(eventually([&] { return counted("m1", "m2", "lost") > 5; }));
  demo->signal(SIGINT);
  std::optional<deploy::ProcessEnd> end;
  EXPECT_TRUE(eventually([&] { return (end = demo->take_end()).has_value(); }))
      << deploy::text_of(scratch.file("log"));
  EXPECT_EQ(end->exit_status, 130) << deploy::text_of(scratch.file("log"));
  EXPECT_EQ(left(), std::vector<std::string>{});
  EXPECT_FALSE(fs::exists(scratch.file("run")));
}

TEST_F(NetCommandTest, ForeignNamespacesAreLeftAlone) {
  const fs::path foreign = "/run/netns/" + name + "-m2";
  ASSERT_TRUE(net::make_namespace(foreign).ok());
  const auto refused = up();
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find(name + "-m2 is there already"), std::string::npos) << refused.err;
  EXPECT_EQ(eciton_command({"net", "down", "--name", name}).status, 0);
  EXPECT_EQ(left(), std::vector<std::string>{foreign});
  net::remove_namespace(foreign);
}

TEST_F(NetCommandTest, WithoutTheRightsItSaysSoAndMakesNothing) {
  for (const char* missing : {"-sys_admin", "-net_admin"}) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"net", "up", "2", "--name", name}, {"demo", "--hosts", "--net", name}}) {
      std::vector<std::string> call{"/usr/bin/setpriv", "--bounding-set", missing,
                                    std::string(ECITON_PROGRAMS) + "/eciton"};
      call.insert(call.end(), words.begin(), words.end());
      const auto ended = tests::run(call);
      EXPECT_EQ(ended.status, 2) << ended.err;
      EXPECT_NE(ended.err.find("run as root"), std::string::npos) << ended.err;
      EXPECT_EQ(left(), std::vector<std::string>{});
    }
  }
}

TEST_F(NetCommandTest, WrongWordsAreNamed) {
  const auto says = [](const tests::Ended& ended, const std::string& part) {
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find(part), std::string::npos) << "no '" << part << "' in: " << ended.err;
  };
  says(eciton_command({"net"}), "a command is missing; there are up, set, show, down");
  says(eciton_command({"net", "up"}), "N is required");
  says(eciton_command({"net", "up", "91"}), "91");
  says(eciton_command({"net", "up", "2", "--name", "My Net"}), "'My Net' is no name for a net");
  says(eciton_command({"net", "set", "--name", "nosuch", "loss=1%"}), "net nosuch is not up");
  says(eciton_command({"demo", "--hosts", "--clock", "lockstep"}), "expected wall");
}

}  // namespace
}  // namespace eciton
