// Experiments are deterministic, and their controls fail.
#include <gtest/gtest.h>

#include "deploy/experiments/experiment.hpp"

namespace eciton::deploy {
namespace {

Figures run(const Experiment& experiment, std::uint64_t seed, std::uint32_t trials, const std::string& broken = "",
            std::uint32_t jobs = 2) {
  ExperimentConfig config;
  config.seed = seed;
  config.trials = trials;
  config.break_what = broken;
  return run_experiment(experiment, config, jobs, [](std::uint32_t) {});
}

TEST(ExperimentTest, OneSeedGivesTheSameBitsHoweverManyJobs) {
  const Figures a = run(docking_experiment, 42, 3, "", 1);
  const Figures b = run(docking_experiment, 42, 3, "", 3);
  EXPECT_EQ(a.metrics, b.metrics);
  EXPECT_EQ(a.series, b.series);
  const Figures other = run(docking_experiment, 43, 3);
  EXPECT_NE(a.series, other.series);
}

TEST(ExperimentTest, DockingSucceedsUnderTheMismatchPreset) {
  const Figures figures = run(docking_experiment, 2026, 10);
  EXPECT_GE(figures.metrics.at("successes"), 10);
  EXPECT_LE(figures.metrics.at("time_s_mean"), 6);
  EXPECT_EQ(figures.metrics.at("false_declarations"), 0);
}

TEST(ExperimentTest, ALatchThatDoesNotHoldFails) {
  EXPECT_EQ(run(docking_experiment, 1, 2, "weld-off").metrics.at("successes"), 0);
}

TEST(ExperimentTest, ClaimsThatNobodyHearsFail) {
  EXPECT_EQ(run(docking_experiment, 1, 2, "claims-muted").metrics.at("successes"), 0);
}

TEST(ExperimentTest, HoverIsWithinTwoCentimetres) {
  const Figures figures = run(hover_experiment, 5, 1);
  EXPECT_LE(figures.metrics.at("position_error_m_mean"), 0.02);
  EXPECT_EQ(figures.metrics.at("landed"), 1);
  EXPECT_EQ(figures.metrics, run(hover_experiment, 5, 1).metrics);
}

}  // namespace
}  // namespace eciton::deploy
