// What a watchdog says to the socket of a supervisor, and what it does not.
#include "core/runtime/watchdog.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <string>
#include <vector>

namespace eciton::runtime {
namespace {

using namespace std::chrono_literals;

/// A supervisor's socket and the environment that names it.
class WatchdogTest : public ::testing::Test {
 protected:
  WatchdogTest() {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_ = "/tmp/eciton-watchdog-test-" + std::to_string(::getpid());
    std::strcpy(address.sun_path, path_.c_str());
    ::unlink(path_.c_str());
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", path_.c_str(), 1);
    ::setenv("WATCHDOG_USEC", "40000", 1);
    ::unsetenv("WATCHDOG_PID");
  }
  ~WatchdogTest() override {
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
    ::close(socket_);
    ::unlink(path_.c_str());
  }

  /// What came within so long, one entry a message.
  std::vector<std::string> said_within(std::chrono::milliseconds span) {
    std::vector<std::string> said;
    for (const auto end = std::chrono::steady_clock::now() + span; std::chrono::steady_clock::now() < end;) {
      std::array<char, 256> text{};
      const ssize_t size = ::recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
      if (size > 0) said.emplace_back(text.data(), static_cast<std::size_t>(size));
      if (size <= 0) std::this_thread::sleep_for(1ms);
    }
    return said;
  }
  static auto count(const std::vector<std::string>& said, const std::string& line) {
    return std::count_if(said.begin(), said.end(), [&](const std::string& s) { return s.find(line) != s.npos; });
  }
  Watchdog::FindIdle find_idle() {
    return [this]() -> std::string_view { return works_ ? "" : "control"; };
  }

  std::string path_;
  int socket_ = -1;
  std::atomic<bool> works_{true};
};

TEST_F(WatchdogTest, SaysReadyOnceAndThatItWorksForAsLongAsItDoes) {
  Watchdog watchdog(find_idle());
  const auto said = said_within(500ms);
  EXPECT_EQ(count(said, "READY=1"), 1);
  EXPECT_GE(count(said, "WATCHDOG=1"), 10) << "every 10 ms, on a machine that may be busy";
  works_ = false;
  said_within(100ms);
  EXPECT_TRUE(said_within(200ms).empty());
  works_ = true;
  EXPECT_GE(count(said_within(300ms), "WATCHDOG=1"), 3) << "and it works again";
}

TEST_F(WatchdogTest, IsNotReadyBeforeItsLoopRuns) {
  works_ = false;
  Watchdog watchdog(find_idle());
  EXPECT_TRUE(said_within(150ms).empty());
  works_ = true;
  const auto said = said_within(300ms);
  ASSERT_FALSE(said.empty());
  EXPECT_NE(said[0].find("READY=1"), std::string::npos);
}

TEST_F(WatchdogTest, SaysOnlyReadyWhereNobodyAsksForMore) {
  ::unsetenv("WATCHDOG_USEC");
  Watchdog watchdog(find_idle());
  EXPECT_EQ(said_within(300ms).size(), 1u);
}

TEST_F(WatchdogTest, LeavesTheWatchdogOfAnotherProcessAlone) {
  ::setenv("WATCHDOG_PID", "1", 1);
  Watchdog watchdog(find_idle());
  EXPECT_EQ(said_within(300ms).size(), 1u);
}

TEST_F(WatchdogTest, SaysNothingWithoutASupervisor) {
  ::unsetenv("NOTIFY_SOCKET");
  int looks = 0;
  {
    Watchdog watchdog([&]() -> std::string_view { return ++looks, ""; });
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_EQ(looks, 0);
}

TEST_F(WatchdogTest, SaysThatItEnds) {
  { Watchdog watchdog(find_idle()); }
  EXPECT_EQ(count(said_within(50ms), "STOPPING=1"), 1);
}

TEST_F(WatchdogTest, EndsInABoundedTimeThoughNobodyReads) {
  ::setenv("WATCHDOG_USEC", "4000", 1);
  const auto begin = std::chrono::steady_clock::now();
  {
    Watchdog watchdog(find_idle());
    std::this_thread::sleep_for(1500ms);  // more messages than the kernel queues: it is held up
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
  said_within(100ms);  // lets it go
}

TEST(LoopProgressTest, HasTurnedSinceTheLastNote) {
  LoopProgress progress;
  EXPECT_FALSE(progress.has_turned());
  progress.turn();
  EXPECT_TRUE(progress.has_turned());
  EXPECT_TRUE(progress.has_turned()) << "until it is noted";
  progress.note();
  EXPECT_FALSE(progress.has_turned());
}

}  // namespace
}  // namespace eciton::runtime
