// What the base of a chain tells the others: how soon, and what becomes of a word that is none.
#include <gtest/gtest.h>

#include "core/robot/arrays.hpp"
#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

TEST(BaseReferenceTest, TheOthersHearIt20TimesASecondAndRefuseWhatIsNoPose) {
  SimulationConfig config = row_of(2, 41);
  Simulation simulation(config);
  Pilot pilot(simulation);
  pilot.bring_to_hover({1.5, 1.5});
  pilot.assemble();
  const std::uint32_t base = pilot.fleet().find(1)->view->base_id, other = 3 - base;
  auto heard = simulation.listener(other - 1).create_reader(topics::base_reference);
  auto beats = simulation.listener(other - 1).create_reader(topics::heartbeat);
  // For two seconds; readers keep little of what they have not been asked for.
  msg::BaseReference last;
  std::size_t count = 0;
  const auto rejected_after_a_while = [&] {
    std::uint64_t rejected = 0;
    count = 0;
    for (int k = 0; k < 200; ++k) {
      pilot.wait(0.01);
      while (const auto beat = beats.take()) {
        if (beat->value.module_id == other && beat->value.service == "control") rejected = beat->value.rejected;
      }
      while (const auto sample = heard.take()) {
        last = sample->value;
        ++count;
      }
    }
    return rejected;
  };
  const std::uint64_t rejected_before = rejected_after_a_while();
  EXPECT_EQ(last.module_id, base);
  EXPECT_EQ(last.epoch, pilot.fleet().find(base)->view->active_epoch);
  EXPECT_TRUE(last.at_rest);
  EXPECT_NEAR(static_cast<double>(count), 40, 8);  // 20 a second, of which 5 % are lost
  // The base does not stand farther from it than it flies well.
  EXPECT_LT((robot::vector(last.p_WM_m) - simulation.world().truth_pose(base).p_WM_m).norm(), 0.05);

  auto false_words = simulation.listener(other - 1).create_writer(topics::base_reference);
  pilot.wait(1);  // until it is known
  // Five times, since the newest of a key counts and the base's own word may come in the same step.
  const auto say = [&](msg::BaseReference word) {
    for (int k = 0; k < 5; ++k) {
      word.stamp_ns = to_ns(simulation.now());
      false_words.write(word);
      pilot.wait(0.02);
    }
  };
  msg::BaseReference bad = last;
  bad.q_WM = {2, 0, 0, 0};
  say(bad);
  bad = last;
  bad.epoch = 7;  // of another chain: none of its business, and no fault
  bad.integral_W_m_s2 = {3, 3, 3};
  say(bad);
  const robot::Vector3 p_W_m = simulation.world().truth_pose(other).p_WM_m;
  const std::uint64_t rejected = rejected_after_a_while() - rejected_before;
  EXPECT_GE(rejected, 3u);
  EXPECT_LE(rejected, 5u) << "what another chain says is no fault";
  EXPECT_LT((simulation.world().truth_pose(other).p_WM_m - p_W_m).norm(), 0.02);
}

}  // namespace
}  // namespace eciton::deploy
