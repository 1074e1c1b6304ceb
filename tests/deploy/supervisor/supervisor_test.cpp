// The supervisor over shells as children: restart, back-off, bad input, stubborn and orphaned children.
#include "deploy/supervisor/supervisor.hpp"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton::deploy {
namespace {

using namespace std::chrono_literals;

class SupervisorTest : public ::testing::Test {
 protected:
  ChildReport report(const Supervisor& supervisor) { return supervisor.reports().at(0); }
  std::size_t starts(const std::string& file) {
    const std::string text = text_of(scratch_.path() / file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  Scratch scratch_;
  SupervisorConfig config_{.log_directory = scratch_.path(), .stop_patience = 5s};
};

TEST_F(SupervisorTest, RestartsAChildThatEndsAndCountsIt) {
  config_.backoff_min = 10ms;
  Supervisor supervisor(config_);
  ASSERT_TRUE(supervisor.start(shell("one", "echo started >> " + scratch_.file("starts") + "; exit 1")).ok());
  const pid_t first = report(supervisor).pid;
  EXPECT_TRUE(eventually([&] {
    supervisor.check();
    return starts("starts") >= 3;
  }));
  EXPECT_GE(report(supervisor).restarts, 2u);
  EXPECT_NE(report(supervisor).pid, first);
  ASSERT_TRUE(report(supervisor).last_end.has_value());
  EXPECT_EQ(report(supervisor).last_end->exit_status, 1);
}

TEST_F(SupervisorTest, RestartsThriceAtOnceThenWaitsTwiceAsLongEachTimeUpToTheBound) {
  Duration now = 100s;
  Supervisor supervisor(config_, [&] { return now; });
  ASSERT_TRUE(supervisor.start(shell("one", "exit 1")).ok());
  std::vector<Duration> waits;
  for (int k = 0; k < 9; ++k) {
    ASSERT_TRUE(eventually([&] {
      supervisor.check();
      return report(supervisor).state == ChildState::waiting;
    }));
    waits.push_back(*supervisor.next_restart() - now);
    now = *supervisor.next_restart() - 1ms;
    supervisor.check();
    EXPECT_EQ(report(supervisor).state, ChildState::waiting) << "not before its time";
    now += 1ms;
    supervisor.check();
  }
  EXPECT_EQ(waits, (std::vector<Duration>{0ms, 0ms, 0ms, 250ms, 500ms, 1s, 2s, 4s, 5s}));
}

TEST_F(SupervisorTest, RestartsAtOnceAfterASteadyRunAndStartsTheBackOffAnew) {
  Duration now = 100s;
  Supervisor supervisor(config_, [&] { return now; });
  ASSERT_TRUE(supervisor.start(shell("one", "exit 1")).ok());
  const auto ended = [&] {
    return eventually([&] {
      supervisor.check();
      return report(supervisor).state == ChildState::waiting;
    });
  };
  const auto ends_and_waits = [&](Duration wait) {
    ASSERT_TRUE(ended());
    EXPECT_EQ(*supervisor.next_restart() - now, wait);
    now = *supervisor.next_restart();
    supervisor.check();
  };
  for (const Duration wait : {0ms, 0ms, 0ms, 250ms}) ends_and_waits(wait);
  now += 11s;
  for (const Duration wait : {0ms, 0ms, 0ms, 250ms}) ends_and_waits(wait);
}

TEST_F(SupervisorTest, DoesNotRestartAChildThatCallsItsInputBad) {
  config_.backoff_min = 1ms;
  Supervisor supervisor(config_);
  ASSERT_TRUE(supervisor.start(shell("one", "echo fine; echo 'one: no such key: speeed' >&2; exit 2")).ok());
  int ends = 0;
  ASSERT_TRUE(eventually([&] {
    supervisor.check([&](const ChildReport&) { ++ends; });
    return ends == 1;
  }));
  std::this_thread::sleep_for(20ms);
  supervisor.check();
  EXPECT_EQ(report(supervisor).state, ChildState::refused);
  EXPECT_EQ(report(supervisor).restarts, 0u);
  EXPECT_EQ(report(supervisor).last_words, "one: no such key: speeed");
  EXPECT_FALSE(supervisor.next_restart().has_value());
}

TEST_F(SupervisorTest, StopsChildrenGentlyWhenTheyListen) {
  Supervisor supervisor(config_);
  ASSERT_TRUE(supervisor.start(shell("one", "trap 'echo bye; exit 0' TERM; echo up; while :; do :; done")).ok());
  ASSERT_TRUE(eventually([&] { return text_of(supervisor.log_file("one")) == "up\n"; }));
  supervisor.stop_all();
  EXPECT_EQ(text_of(supervisor.log_file("one")), "up\nbye\n");
  EXPECT_EQ(report(supervisor).last_end->text(), "exit status 0");
}

TEST_F(SupervisorTest, KillsAChildThatIgnoresTheRequestAndWhatItStarted) {
  config_.stop_patience = 200ms;
  Supervisor supervisor(config_);
  ASSERT_TRUE(supervisor
                  .start(shell("one", "trap '' TERM; sh -c 'trap \"\" TERM; echo $$ > " + scratch_.file("inner") +
                                          "; while :; do sleep 0.01; done' & while :; do sleep 0.01; done"))
                  .ok());
  ASSERT_TRUE(eventually([&] { return !text_of(scratch_.path() / "inner").empty(); }));
  const pid_t outer = report(supervisor).pid;
  const pid_t inner = std::stoi(text_of(scratch_.path() / "inner"));
  supervisor.stop_all();
  EXPECT_FALSE(is_alive(outer));
  EXPECT_TRUE(eventually([&] { return !is_alive(inner); }));
  EXPECT_EQ(report(supervisor).last_end->signal, SIGKILL);
}

TEST_F(SupervisorTest, NamesAProgramThatIsNotThere) {
  Supervisor supervisor(config_);
  const Status status = supervisor.start({.name = "one", .arguments = {"/nowhere/eciton-hardware"}});
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("/nowhere/eciton-hardware"), std::string::npos);
  EXPECT_TRUE(supervisor.reports().empty());
}

TEST_F(SupervisorTest, GivesChildrenTheirEnvironment) {
  ::setenv("ECITON_TEST_KEPT", "kept", 1);
  ::setenv("ECITON_TEST_GONE", "there", 1);
  Supervisor supervisor(config_);
  ChildSpec spec = shell("one", "echo $ECITON_TEST_KEPT $ECITON_TEST_NEW ${ECITON_TEST_GONE-gone}; exit 2");
  spec.environment = {{"ECITON_TEST_NEW", "new"}, {"ECITON_TEST_GONE", ""}};
  ASSERT_TRUE(supervisor.start(spec).ok());
  EXPECT_TRUE(eventually([&] { return text_of(supervisor.log_file("one")) == "kept new gone\n"; }));
}

TEST_F(SupervisorTest, LeavesNoDescriptorsOpenInChildren) {
  const int leaky = ::dup(STDERR_FILENO);  // as a vendor's socket: without close-on-exec
  Supervisor supervisor(config_);
  ASSERT_TRUE(
      supervisor.start(shell("one", "test -e /proc/self/fd/" + std::to_string(leaky) + " && echo leaked; exit 2"))
          .ok());
  ASSERT_TRUE(eventually([&] {
    supervisor.check();
    return report(supervisor).state == ChildState::refused;
  }));
  EXPECT_EQ(text_of(supervisor.log_file("one")), "");
  ::close(leaky);
}

TEST_F(SupervisorTest, LeavesNothingBehindWhenItIsKilledItself) {
  // Orphans of the killed supervisor come to us, so that we see them end.
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  const pid_t owner = ::fork();
  if (owner == 0) {
    Supervisor supervisor(config_);
    (void)supervisor.start(
        shell("one", "trap '' TERM; echo $$ > " + scratch_.file("pid") + "; while :; do sleep 0.01; done"));
    while (true) ::pause();
  }
  ASSERT_TRUE(eventually([&] { return !text_of(scratch_.path() / "pid").empty(); }));
  const pid_t child = std::stoi(text_of(scratch_.path() / "pid"));
  ::kill(owner, SIGKILL);
  EXPECT_TRUE(eventually([&] {
    while (::waitpid(-1, nullptr, WNOHANG) > 0) {
    }
    return !is_alive(child);
  }));
  ::prctl(PR_SET_CHILD_SUBREAPER, 0);
}

TEST(LastLinesTest, GivesTheEndOfALog) {
  Scratch scratch;
  std::ofstream(scratch.file("log")) << "one\ntwo\n\nthree\n";
  EXPECT_EQ(last_lines(scratch.file("log"), 2), (std::vector<std::string>{"two", "three"}));
  EXPECT_TRUE(last_lines(scratch.file("none"), 2).empty());
}

}  // namespace
}  // namespace eciton::deploy
