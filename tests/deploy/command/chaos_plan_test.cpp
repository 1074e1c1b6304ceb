// Which cells a chaos run flies: all, or so few that every pair still appears.
#include "deploy/command/chaos_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace eciton::deploy {
namespace {

std::size_t cells_of(const std::vector<ChaosPlan>& plans) {
  std::size_t count = 0;
  for (const ChaosPlan& plan : plans) count += plan.cells.size();
  return count;
}

/// Pairs of values of two of: kind, process, stage, vendors.
std::set<std::string> pairs_of(const std::vector<ChaosPlan>& plans) {
  std::set<std::string> pairs;
  for (const ChaosPlan& plan : plans) {
    for (const ChaosCell& cell : plan.cells) {
      const std::array<std::string, 4> values{name_of(cell.kind), cell.process.empty() ? "link" : cell.process,
                                              name_of(cell.stage), plan.dds};
      for (std::size_t a = 0; a < values.size(); ++a) {
        for (std::size_t b = a + 1; b < values.size(); ++b) pairs.insert(values[a] + " " + values[b]);
      }
    }
  }
  return pairs;
}

bool by_stage(const ChaosPlan& plan) {
  return std::is_sorted(plan.cells.begin(), plan.cells.end(),
                        [](const ChaosCell& a, const ChaosCell& b) { return a.stage < b.stage; });
}

TEST(ChaosPlanTest, TheMatrixIsWhole) {
  // Two kinds on six processes, four on link and disk; three stages; three choices of vendors.
  const auto plans = full_matrix(3);
  ASSERT_EQ(plans.size(), 3u);
  EXPECT_EQ(cells_of(plans), (2u * 6u + 4u) * 3u * 3u);
  for (const ChaosPlan& plan : plans) {
    EXPECT_TRUE(by_stage(plan));
    std::set<std::string> texts;
    for (const ChaosCell& cell : plan.cells)
      texts.insert(cell.text().substr(0, 4) + cell.process + name_of(cell.stage));
    EXPECT_EQ(texts.size(), plan.cells.size());
  }
}

TEST(ChaosPlanTest, TheSelectionHasEveryPairOfTheMatrixInFewCells) {
  const auto few = pairwise_matrix(3);
  EXPECT_EQ(pairs_of(few), pairs_of(full_matrix(3)));
  EXPECT_LE(cells_of(few), 30u);
  // The control that must fail: one cell less than a plan of one vendor leaves pairs out.
  std::vector<ChaosPlan> fewer = few;
  fewer.pop_back();
  EXPECT_NE(pairs_of(fewer), pairs_of(full_matrix(3)));
}

TEST(ChaosPlanTest, EveryModuleIsStruck) {
  std::set<std::uint32_t> struck;
  for (const ChaosPlan& plan : pairwise_matrix(3)) {
    for (const ChaosCell& cell : plan.cells) struck.insert(cell.module_id);
  }
  EXPECT_EQ(struck, (std::set<std::uint32_t>{1, 2, 3}));
}

TEST(ChaosPlanTest, OneSeedIsOnePlan) {
  std::mt19937_64 a(7), b(7), c(8);
  const auto texts = [](const ChaosPlan& plan) {
    std::string all;
    for (const ChaosCell& cell : plan.cells) all += cell.text() + "\n";
    return all;
  };
  const std::string first = texts(random_plan("fastdds", 3, 20, a));
  EXPECT_EQ(first, texts(random_plan("fastdds", 3, 20, b)));
  EXPECT_NE(first, texts(random_plan("fastdds", 3, 20, c)));
}

}  // namespace
}  // namespace eciton::deploy
