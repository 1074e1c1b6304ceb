// What formations and discoveries gave, as tables, bars and metrics.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/formation/chain_trials.hpp"
#include "benchmarks/formation/discovery.hpp"
#include "benchmarks/report/result.hpp"

namespace eciton::bench {

/// Members of one number and pair; the losses are set while they run.
struct FormationCase {
  std::uint32_t modules;
  VendorPair pair;
};

/// A loss in percent, as it stands in names.
std::string loss_name(double loss);

/// What all trials of one case at one loss gave.
class FormationSamples {
 public:
  FormationSamples(const FormationCase& which, double loss);

  const std::string& name() const { return name_; }
  /// Nothing: the chain did not come about in time, which counts as lost.
  void add(double at_s, const std::optional<FormationTimes>& times);
  void mark_partial();
  void move_to(std::vector<Samples>& all);

 private:
  std::string name_;
  std::array<Samples, 3> samples_;
};

using Discoveries = std::vector<std::pair<DiscoveryCase, DiscoveryFigures>>;

/// Nothing measured adds nothing.
void add_formations(Result& result, std::vector<Samples> formations);
void add_discoveries(Result& result, const Discoveries& discoveries);

}  // namespace eciton::bench
