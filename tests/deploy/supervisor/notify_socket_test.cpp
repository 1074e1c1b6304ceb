// The supervisor's end of the notify protocol, spoken to by libsystemd.
#include "deploy/supervisor/notify_socket.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <systemd/sd-daemon.h>

#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton::deploy {
namespace {

class NotifySocketTest : public ::testing::Test {
 protected:
  NotifySocketTest() { ::setenv("NOTIFY_SOCKET", socket_.path().c_str(), 1); }
  ~NotifySocketTest() override { ::unsetenv("NOTIFY_SOCKET"); }

  Scratch scratch_;
  NotifySocket socket_ = NotifySocket::open(scratch_.path() / "one.notify").value();
};

TEST_F(NotifySocketTest, HearsWhatLibsystemdSays) {
  EXPECT_FALSE(socket_.take().ready);
  ASSERT_GT(::sd_notify(0, "READY=1\nSTATUS=all is well"), 0);
  NotifySocket::Notices said = socket_.take();
  EXPECT_TRUE(said.ready);
  EXPECT_FALSE(said.alive || said.stopping);
  ASSERT_GT(::sd_notify(0, "WATCHDOG=1"), 0);
  ASSERT_GT(::sd_notify(0, "STOPPING=1"), 0);
  said = socket_.take();
  EXPECT_TRUE(said.alive && said.stopping);
  EXPECT_FALSE(said.ready || socket_.take().alive) << "once";
}

TEST_F(NotifySocketTest, PassesOverWhatItDoesNotKnow) {
  ::sd_notify(0, "STATUS=READY=1\nXREADY=1\nREADY=0\nWATCHDOG=trigger");
  const NotifySocket::Notices said = socket_.take();
  EXPECT_FALSE(said.ready || said.alive || said.stopping);
}

TEST_F(NotifySocketTest, ReplacesWhatIsLeftAndLeavesNothing) {
  const auto path = scratch_.path() / "two.notify";
  std::ofstream(path) << "left over";
  { EXPECT_TRUE(NotifySocket::open(path).ok()); }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace eciton::deploy
