// Which faults a chaos run strikes, in which flights.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "deploy/command/chaos_fault.hpp"

namespace eciton::deploy {

/// One flight: a fleet of one choice of vendors.
struct ChaosPlan {
  std::string dds;
  std::vector<ChaosCell> cells;  // by stage: separated, approach, assembled
};

inline constexpr std::array vendor_choices{"cyclonedds", "fastdds", "mixed"};

/// Every kind on every process (and on the radio link) at every stage with every choice of vendors.
std::vector<ChaosPlan> full_matrix(std::uint32_t modules);
/// Fewer: every pair of two of the four appears at least once.
std::vector<ChaosPlan> pairwise_matrix(std::uint32_t modules);
/// So many cells at random, by stage.
ChaosPlan random_plan(const std::string& dds, std::uint32_t modules, std::size_t cells, std::mt19937_64& random);

}  // namespace eciton::deploy
