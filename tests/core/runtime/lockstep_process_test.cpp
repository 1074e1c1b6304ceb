// Lockstep between real processes over real DDS: one that hangs is named, one that dies is replaced.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>

#include "core/base/wall_clock.hpp"
#include "core/runtime/lockstep_master.hpp"
#include "tests/core/runtime/fake_services.hpp"

namespace eciton::runtime {
namespace {

constexpr std::uint32_t domain = 45;

class Peer {
 public:
  Peer(const std::string& vendor, const std::string& role) {
    std::string program = LOCKSTEP_PEER, on = std::to_string(domain), v = vendor, r = role;
    char* argv[] = {program.data(), v.data(), on.data(), r.data(), nullptr};
    if (::posix_spawn(&pid_, program.c_str(), nullptr, nullptr, argv, environ) != 0) pid_ = -1;
  }
  ~Peer() { end(SIGKILL); }
  Peer(const Peer&) = delete;

  void signal(int number) const { ::kill(pid_, number); }
  /// The exit status, -1 if a signal ended it.
  int end(int number) {
    if (pid_ <= 0) return -1;
    signal(number);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
};

class LockstepProcessTest : public ::testing::TestWithParam<const char*> {
 protected:
  LockstepProcessTest() : ring_({.vendor = GetParam(), .domain = domain, .name = "host"}) {
    for (const char* role : {"estimation", "control", "docking"}) start(role);
  }
  void start(const std::string& role) { peers_[role] = std::make_unique<Peer>(GetParam(), role); }

  std::string tick(Duration timeout = 30s) {
    const TimePoint now = from_ns(0) + static_cast<std::int64_t>(++tick_) * 2ms;
    ring_.set_now(now);
    imu_.write({.module_id = 1, .stamp_ns = to_ns(now)});
    master_.publish(tick_, now, true);
    const Status status = master_.wait_for_acks(timeout);
    return status ? "" : status.error().message;
  }
  bool commanded_in_time() {
    const auto command = rotors_.take_newest();
    return command && command->value.stamp_ns == static_cast<std::int64_t>(tick_) * 2'000'000;
  }

  std::map<std::string, std::unique_ptr<Peer>> peers_;
  StopFlag stop_;
  bus::Participant ring_;
  LockstepMaster master_{ring_, {"estimation", "control", "docking"}, stop_};
  bus::Writer<msg::Imu> imu_ = ring_.create_writer(topics::imu);
  bus::Reader<msg::RotorCommand> rotors_ = ring_.create_reader(topics::rotor_command);
  std::uint64_t tick_ = 0;
};

TEST_P(LockstepProcessTest, FliesInStepAndStopsCleanly) {
  int in_time = 0;
  for (int k = 0; k < 300; ++k) {
    ASSERT_EQ(tick(), "");
    in_time += commanded_in_time();
  }
  EXPECT_GE(in_time, 280) << "all but the first, until every reader has matched";
  for (auto& [role, peer] : peers_) EXPECT_EQ(peer->end(SIGTERM), 0) << role;
}

TEST_P(LockstepProcessTest, NamesAHungProcessAndGoesOnWithIt) {
  for (int k = 0; k < 20; ++k) ASSERT_EQ(tick(), "");
  peers_["control"]->signal(SIGSTOP);
  const std::string stalled = tick(500ms);
  EXPECT_NE(stalled.find("control (its last: tick 20)"), std::string::npos) << stalled;
  EXPECT_EQ(stalled.find("estimation"), std::string::npos) << stalled;
  peers_["control"]->signal(SIGCONT);
  const Status again = master_.wait_for_acks(30s);
  EXPECT_TRUE(again) << again.error().message;
  EXPECT_EQ(tick(), "");
}

TEST_P(LockstepProcessTest, GoesOnWithAProcessStartedAnew) {
  for (int k = 0; k < 20; ++k) ASSERT_EQ(tick(), "");
  peers_["estimation"]->end(SIGKILL);
  EXPECT_NE(tick(300ms).find("estimation"), std::string::npos);
  start("estimation");
  const Status again = master_.wait_for_acks(30s);
  EXPECT_TRUE(again) << again.error().message;
  bool flying = false;
  for (int k = 0; k < 2000 && !flying; ++k) {
    ASSERT_EQ(tick(), "");
    flying = commanded_in_time();
  }
  EXPECT_TRUE(flying);
}

INSTANTIATE_TEST_SUITE_P(Vendors, LockstepProcessTest, ::testing::Values("cyclonedds", "fastdds"));

}  // namespace
}  // namespace eciton::runtime
