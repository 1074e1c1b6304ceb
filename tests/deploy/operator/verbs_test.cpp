// The verbs as a person runs them: the built command against a fake module over a real vendor.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/base/wall_clock.hpp"
#include "tests/deploy/operator/fake_module.hpp"
#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t domain = 77;

class VerbsTest : public ::testing::Test {
 protected:
  struct Outcome {
    int status = -1;
    std::string text;
  };

  /// Runs `eciton WORDS...`, with a module that answers each goal as `answer` says.
  Outcome run(std::vector<std::string> words, const std::function<void(FakeModule&, TimePoint)>& answer) {
    FakeModule module(
        3, {.vendor = "cyclonedds", .domain = domain, .name = "m3", .network_interface = "lo", .peers = {}});
    module.announce({3}, 0);
    words.insert(words.begin(), ECITON_COMMAND);
    words.insert(words.end(), {"--swarm-domain", std::to_string(domain), "--dds", "cyclonedds"});
    auto child = ChildProcess::start({.arguments = words, .log_file = scratch_.file("log")});
    if (!child) return {.status = -1, .text = child.error().message};
    Outcome outcome;
    eventually(
        [&] {
          module.step(wall_now());
          answer(module, wall_now());
          const auto end = child->take_end();
          if (end) outcome.status = end->signal != 0 ? -end->signal : end->exit_status;
          return end.has_value();
        },
        std::chrono::seconds(40));
    outcome.text = text_of(scratch_.path() / "log");
    return outcome;
  }

  Scratch scratch_;
};

TEST_F(VerbsTest, SucceedsWhenTheModuleDoes) {
  const Outcome outcome =
      run({"takeoff", "3", "--height", "2.5"}, [accepted = false](FakeModule& m, TimePoint now) mutable {
        if (m.flights.empty()) return;
        EXPECT_EQ(m.flights[0].p_WM_m[2], 2.5);
        if (!std::exchange(accepted, true))
          m.answer(msg::GoalKind::flight, m.flights[0].correlation_id, msg::GoalPhase::accepted, "", now);
        m.answer(msg::GoalKind::flight, m.flights[0].correlation_id, msg::GoalPhase::succeeded, "", now);
      });
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("takeoff 3: succeeded"), std::string::npos) << outcome.text;
}

TEST_F(VerbsTest, SaysWhyItWasRefused) {
  const Outcome outcome = run({"arm", "3"}, [](FakeModule& m, TimePoint now) {
    if (!m.modes.empty())
      m.answer(msg::GoalKind::mode, m.modes[0].correlation_id, msg::GoalPhase::refused, "already flying", now);
  });
  EXPECT_EQ(outcome.status, 1) << outcome.text;
  EXPECT_EQ(outcome.text, "arm 3: refused: already flying\n");
}

TEST_F(VerbsTest, StopsEveryModuleThatIsHeard) {
  bool stopped = false;
  const Outcome outcome = run({"stop", "--all"}, [&](FakeModule& m, TimePoint now) {
    if (m.modes.empty()) return;
    stopped = m.modes[0].action == msg::ModeAction::stop;
    m.answer(msg::GoalKind::mode, m.modes[0].correlation_id, msg::GoalPhase::succeeded, "", now);
  });
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_TRUE(stopped);
}

TEST_F(VerbsTest, GivesUpOnAModuleThatNeverAnswers) {
  const Outcome outcome = run({"land", "3", "--timeout", "0.5"}, [](FakeModule&, TimePoint) {});
  EXPECT_EQ(outcome.status, 1) << outcome.text;
  EXPECT_NE(outcome.text.find("not done within 0.5 s"), std::string::npos) << outcome.text;
}

TEST_F(VerbsTest, RefusesWordsThatMakeNoSense) {
  const auto nothing = [](FakeModule&, TimePoint) {};
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"arm", "95"},
                                             {"arm"},
                                             {"dock", "3", "3"},
                                             {"goto", "3", "1", "x", "1"},
                                             {"stop"},
                                             {"stop", "3", "--all"},
                                             {"takeoff", "3", "--hight", "2"},
                                             {"arm", "3", "--interface", "eth77"}}) {
    const Outcome outcome = run(words, nothing);
    EXPECT_EQ(outcome.status, 2) << words[0] << ": " << outcome.text;
    EXPECT_FALSE(outcome.text.empty());
  }
}

}  // namespace
}  // namespace eciton::deploy
