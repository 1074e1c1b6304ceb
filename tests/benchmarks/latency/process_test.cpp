// Programs that answer, are silent, end, or were never there: no wait is without a bound.
#include "benchmarks/latency/process.hpp"

#include <gtest/gtest.h>

#include "core/base/wall_clock.hpp"

namespace eciton::bench {
namespace {

Result<Process> shell(const std::string& script) {
  return Process::start({.path = "/bin/sh", .arguments = {"-c", script}});
}

Duration within(int ms) { return monotonic_now() + std::chrono::milliseconds(ms); }

TEST(ProcessTest, HearsLineByLine) {
  Result<Process> process = shell("read word; echo first; echo \"got $word\"; read end");
  ASSERT_TRUE(process);
  runtime::StopFlag stop;
  ASSERT_TRUE(process->say("seven"));
  EXPECT_EQ(*process->hear(within(5000), stop), "first");
  EXPECT_EQ(*process->hear(within(5000), stop), "got seven");
}

TEST(ProcessTest, SaysHowAProcessEnded) {
  runtime::StopFlag stop;
  Result<Process> ended = shell("exit 5");
  EXPECT_EQ(ended->hear(within(5000), stop).error().message, "sh ended with status 5");
  Result<Process> killed = shell("kill -9 $$");
  EXPECT_EQ(killed->hear(within(5000), stop).error().message, "sh was ended by signal 9");
}

TEST(ProcessTest, DoesNotWaitForEver) {
  Result<Process> process = shell("read end");
  runtime::StopFlag stop;
  EXPECT_EQ(process->hear(within(20), stop).error().message, "sh did not answer in time");
  stop.request();
  EXPECT_EQ(process->hear(within(60'000), stop).error().message, interrupted);
}

TEST(ProcessTest, AProgramThatIsNotThereIsSaidAtOnce) {
  const Result<Process> none = Process::start({.path = "/no/such/program"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "/no/such/program cannot be started: No such file or directory");
  const Result<Process> nowhere =
      Process::start({.path = "/bin/sh", .footing = {.network_namespace = "/run/netns/no-such-host"}});
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().message, "sh: no network namespace /run/netns/no-such-host");
}

TEST(ProcessTest, OneThatIgnoresItsEndIsKilled) {
  const Duration before = monotonic_now();
  { Result<Process> stubborn = shell("trap '' TERM; exec sleep 60"); }
  EXPECT_LT(monotonic_now() - before, std::chrono::seconds(30));
}

TEST(ProcessTest, GivesEnvironmentBesideOurs) {
  Result<Process> process =
      Process::start({.path = "/bin/sh", .arguments = {"-c", "echo $WORD$HOME"}, .environment = {{"WORD", "w"}}});
  runtime::StopFlag stop;
  const char* home = std::getenv("HOME");
  EXPECT_EQ(*process->hear(within(5000), stop), std::string("w") + (home == nullptr ? "" : home));
}

TEST(FootingTest, NamesAProcessorThatIsNotThere) {
  EXPECT_TRUE(check(Footing{}));
  const Status none = check({"", 1000, 0});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("processor 1000"), std::string::npos) << none.error().message;
}

}  // namespace
}  // namespace eciton::bench
