// The supervisor over children that hang, in every way a process can, and over those that only seem to.
#include <gtest/gtest.h>

#include "core/base/wall_clock.hpp"
#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton::deploy {
namespace {

using namespace std::chrono_literals;

class WatchedTest : public ::testing::Test {
 protected:
  static ChildSpec child(const std::string& what) {
    return {.name = what,
            .arguments = {program_beside("watched_child"), what},
            .environment = {},
            .network_namespace = {},
            .watchdog = 400ms};
  }
  static std::string program_beside(const std::string& name) {
    return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
  }
  /// As `eciton up` does: ten looks a second, and at once when a child ends.
  void watch(
      Supervisor& supervisor, Duration span, const std::function<bool()>& done = [] { return false; }) {
    for (const Duration end = monotonic_now() + span; monotonic_now() < end && !done();) {
      std::vector<pollfd> descriptors;
      supervisor.add_descriptors(descriptors);
      wait_for(descriptors, 100ms);
      supervisor.check([&](const ChildReport& report) { ends_.push_back(report); });
    }
  }
  /// Starts it, and gives it until it hangs or `limit`; how long that was noticed after it hung.
  Duration hang(Supervisor& supervisor, const std::string& what) {
    EXPECT_TRUE(supervisor.start(child(what)).ok());
    const auto hangs = [&] { return text_of(supervisor.log_file(what)).find("about to hang") != std::string::npos; };
    watch(supervisor, 20s, hangs);
    const Duration begin = monotonic_now();
    watch(supervisor, 20s, [&] { return !ends_.empty(); });
    return monotonic_now() - begin;
  }

  Scratch scratch_;
  SupervisorConfig config_{.log_directory = scratch_.path()};
  std::vector<ChildReport> ends_;
};

class HangingTest : public WatchedTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(HangingTest, IsKilledAndStartedAgainAtOnce) {
  Supervisor supervisor(config_);
  const Duration noticed = hang(supervisor, GetParam());
  ASSERT_EQ(ends_.size(), 1u);
  EXPECT_TRUE(ends_[0].hung);
  EXPECT_EQ(ends_[0].last_end->signal, SIGKILL);
  EXPECT_EQ(ends_[0].hangs, 1u);
  EXPECT_GT(noticed, 200ms);
  EXPECT_LT(noticed, 5s) << "on a machine that may be busy";
  RecordProperty("noticed_ms", static_cast<int>(noticed / 1ms));
  EXPECT_LE(*supervisor.next_restart(), monotonic_now());
  supervisor.check();
  EXPECT_TRUE(supervisor.all_running());
  EXPECT_EQ(supervisor.reports()[0].restarts, 1u);
  EXPECT_NE(supervisor.reports()[0].pid, ends_[0].pid);
}

INSTANTIATE_TEST_SUITE_P(Hang, HangingTest, ::testing::Values("stops", "deadlocks"),
                         [](const auto& what) { return std::string(what.param); });

TEST_F(WatchedTest, NamesWhatDoesNotStepInALoopThatHangs) {
  Supervisor supervisor(config_);
  hang(supervisor, "deadlocks");
  ASSERT_EQ(ends_.size(), 1u);
  EXPECT_NE(ends_[0].last_words.find("the loop has not stepped for"), std::string::npos) << ends_[0].last_words;
}

TEST_F(WatchedTest, LeavesAChildAloneThatWasNeverReady) {
  Supervisor supervisor(config_);
  ASSERT_TRUE(supervisor.start(child("starts")).ok());
  ChildSpec mute = shell("mute", "sleep 60");
  mute.watchdog = 400ms;
  ASSERT_TRUE(supervisor.start(mute).ok());
  watch(supervisor, 1500ms);
  EXPECT_TRUE(ends_.empty());
  EXPECT_TRUE(supervisor.all_running());
}

TEST_F(WatchedTest, LeavesAChildAloneThatIsNotWatched) {
  Supervisor supervisor(config_);
  ChildSpec unwatched = child("stops");
  unwatched.watchdog = {};
  ASSERT_TRUE(supervisor.start(unwatched).ok());
  watch(supervisor, 1500ms);
  EXPECT_TRUE(ends_.empty());
  const Duration begin = monotonic_now();
  supervisor.stop_all();
  EXPECT_LT(monotonic_now() - begin, config_.stop_patience) << "it is woken to be ended";
}

TEST_F(WatchedTest, RaisesNoFalseAlarmWhenEveryCoreIsBusy) {
  Supervisor supervisor(config_);
  const unsigned busy = 3 * std::max(1u, std::thread::hardware_concurrency());
  for (unsigned k = 0; k < busy; ++k) {
    ASSERT_TRUE(supervisor.start(shell("busy" + std::to_string(k), "while :; do :; done")).ok());
  }
  ASSERT_TRUE(supervisor.start(child("works")).ok());
  watch(supervisor, 3s);
  EXPECT_TRUE(ends_.empty());
}

TEST_F(WatchedTest, DoesNotCountTheTimeInWhichTheSupervisorWasHeldUp) {
  Duration now = 100s;
  Supervisor supervisor(config_, [&] { return now; });
  ASSERT_TRUE(supervisor.start(child("stops")).ok());
  const auto hangs = [&] { return text_of(supervisor.log_file("stops")).find("about to hang") != std::string::npos; };
  const auto check = [&] { supervisor.check([&](const ChildReport& report) { ends_.push_back(report); }); };
  ASSERT_TRUE(eventually([&] {
    check();
    return hangs();
  }));
  std::this_thread::sleep_for(100ms);
  check();
  for (int k = 0; k < 4; ++k) {
    now += 10s;
    check();
  }
  std::this_thread::sleep_for(100ms);
  check();
  EXPECT_TRUE(ends_.empty()) << "four looks, however far apart, are not more than 400 ms";
  now += 10s;
  check();
  EXPECT_TRUE(eventually([&] {
    check();
    return !ends_.empty();
  })) << "the fifth is";
}

TEST_F(WatchedTest, RefusesADirectoryWhoseSocketsWouldHaveTooLongAName) {
  config_.log_directory = scratch_.path() / std::string(100, 'x');
  std::filesystem::create_directory(config_.log_directory);
  Supervisor supervisor(config_);
  const Status status = supervisor.start(child("works"));
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("ECITON_RUNTIME_DIR"), std::string::npos) << status.error().message;
}

TEST_F(WatchedTest, LetsNoChildSpeakToTheSupervisorsOwnSupervisor) {
  ::setenv("NOTIFY_SOCKET", "/run/not-ours", 1);
  ::setenv("WATCHDOG_USEC", "1000000", 1);
  ::setenv("WATCHDOG_PID", "1", 1);
  Supervisor supervisor(config_);
  ASSERT_TRUE(
      supervisor.start(shell("one", "echo ${NOTIFY_SOCKET-none} ${WATCHDOG_USEC-none} ${WATCHDOG_PID-none}; exit 2"))
          .ok());
  EXPECT_TRUE(eventually([&] { return text_of(supervisor.log_file("one")) == "none none none\n"; }));
  for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
}

}  // namespace
}  // namespace eciton::deploy
