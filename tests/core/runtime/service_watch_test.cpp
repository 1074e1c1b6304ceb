// Silence by the stamps of heartbeats: when it is noticed, when it is over, and what is no silence.
#include "core/runtime/service_watch.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace eciton::runtime {
namespace {

struct Told {
  std::string service;
  bool silent;
  Duration silence;
  TimePoint at;
};

/// A watcher that steps every 2 ms, and services that beat every 10 ms.
class ServiceWatchTest : public ::testing::Test {
 protected:
  struct Beating {
    std::uint32_t key;
    std::string name;
    bool beats = true;
  };

  void step_at(TimePoint now) {
    now_ = now;
    watch_.begin(now_);
    for (const Beating& s : services_) {
      if (s.beats && now_ >= next_beat_) watch_.hear(s.key, s.name, now_, false);
    }
    if (now_ >= next_beat_) next_beat_ = now_ + 10ms;
    while (const auto n = watch_.next_notice()) {
      told_.push_back({std::string(n->service), n->silent, n->silence, now_});
    }
  }
  void run(Duration span) {
    for (const TimePoint end = now_ + span; now_ < end;) step_at(now_ + 2ms);
  }
  void silence(std::size_t k) { services_[k].beats = false; }
  void resume(std::size_t k) { services_[k].beats = true; }

  ServiceWatch watch_{2ms};
  std::vector<Beating> services_{{1, "control"}, {2, "joints"}};
  TimePoint now_ = from_ns(0) + 1000s;
  TimePoint next_beat_ = now_;
  std::vector<Told> told_;
};

TEST_F(ServiceWatchTest, SaysNothingOfServicesThatBeat) {
  run(10s);
  EXPECT_TRUE(told_.empty());
  EXPECT_EQ(watch_.silences(), 0u);
}

TEST_F(ServiceWatchTest, NoticesASilentServiceWithinFiftyMillisecondsOfItsLastBeat) {
  run(2s);
  silence(0);
  run(100ms);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_EQ(told_[0].service, "control");
  EXPECT_TRUE(told_[0].silent);
  EXPECT_GT(told_[0].silence, 40ms) << "four beats missed, and the fifth late";
  EXPECT_LE(told_[0].silence, 50ms);
  EXPECT_EQ(watch_.silent_services(), 1u);
  run(10s);
  EXPECT_EQ(told_.size(), 1u) << "once";
}

TEST_F(ServiceWatchTest, TellsWhenItIsBackAndHowLongItWasGone) {
  run(2s);
  silence(1);
  run(400ms);
  resume(1);
  run(20ms);
  ASSERT_EQ(told_.size(), 2u);
  EXPECT_EQ(told_[1].service, "joints");
  EXPECT_FALSE(told_[1].silent);
  EXPECT_NEAR(to_s(told_[1].silence), 0.41, 0.015);
  EXPECT_EQ(watch_.silent_services(), 0u);
  EXPECT_EQ(watch_.silences(), 1u);
  run(2s);
  silence(1);
  run(100ms);
  EXPECT_EQ(told_.size(), 3u) << "and again";
}

TEST_F(ServiceWatchTest, IsPatientWhileAServiceStarts) {
  run(20ms);
  silence(0);
  run(300ms);
  EXPECT_TRUE(told_.empty()) << "it beat for the first time just now";
  resume(0);
  run(900ms);
  silence(0);
  run(200ms);
  EXPECT_TRUE(told_.empty()) << "its gap showed that it was not settled then";
  resume(0);
  run(1200ms);
  silence(0);
  run(60ms);
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(ServiceWatchTest, NoticesAServiceThatDiesWhileItStarts) {
  run(20ms);
  silence(0);
  run(1100ms);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_GT(told_[0].silence, 1s);
}

TEST_F(ServiceWatchTest, DoesNotMissWhoSaidFarewell) {
  run(2s);
  silence(0);
  watch_.hear(1, "control", now_, true);
  run(5s);
  EXPECT_TRUE(told_.empty());
  resume(0);
  run(2s);
  silence(0);
  run(100ms);
  EXPECT_EQ(told_.size(), 1u) << "it started anew";
}

TEST_F(ServiceWatchTest, DoesNotCountTheTimeInWhichItWasHeldUpItself) {
  run(2s);
  // Nobody's heartbeat of that time has arrived yet: as when the whole machine stands still.
  now_ += 500ms;
  next_beat_ = now_ + 20ms;
  run(1s);
  EXPECT_TRUE(told_.empty());
}

TEST_F(ServiceWatchTest, CountsTheTimeOfStepsThatAreOnlyALittleLate) {
  run(2s);
  silence(0);
  for (int k = 0; k < 10; ++k) step_at(now_ + 11ms);
  EXPECT_EQ(told_.size(), 1u) << "a watcher on a busy machine is not deaf";
}

TEST_F(ServiceWatchTest, NoticesWhoFellSilentBeforeItWasHeldUp) {
  run(2s);
  silence(0);
  run(20ms);
  step_at(now_ + 500ms);
  EXPECT_TRUE(told_.empty());
  run(40ms);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_EQ(told_[0].service, "control");
}

TEST_F(ServiceWatchTest, StandsAClockThatIsSetForwardOrBack) {
  run(2s);
  for (const Duration by : {Duration(3600s), Duration(-7200s)}) {
    now_ += by;
    next_beat_ = now_;
    run(1s);
    EXPECT_TRUE(told_.empty());
  }
  silence(0);
  run(100ms);
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(ServiceWatchTest, WatchesNoMoreServicesThanItHasRoomFor) {
  services_.clear();
  for (std::uint32_t k = 1; k <= ServiceWatch::bound + 4; ++k) services_.push_back({k, "s" + std::to_string(k)});
  run(2s);
  for (Beating& s : services_) s.beats = false;
  run(100ms);
  EXPECT_EQ(told_.size(), ServiceWatch::bound);
}

}  // namespace
}  // namespace eciton::runtime
