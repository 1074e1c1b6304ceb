// All cells, few cells, random cells.
#include "deploy/command/chaos_plan.hpp"

#include <algorithm>
#include <set>

namespace eciton::deploy {
namespace {

/// What can be struck: a kind and, of a process, which.
struct Blow {
  FaultKind kind{};
  std::string process;
};

std::vector<Blow> blows() {
  std::vector<Blow> all;
  for (const FaultKind kind : fault_kinds) {
    if (!strikes_a_process(kind)) {
      all.push_back({kind, {}});
      continue;
    }
    for (const char* process : module_processes) all.push_back({kind, process});
  }
  return all;
}

void sort_by_stage(ChaosPlan& plan) {
  std::stable_sort(plan.cells.begin(), plan.cells.end(),
                   [](const ChaosCell& a, const ChaosCell& b) { return a.stage < b.stage; });
}

/// Modules take turns, so that ends and the middle are struck.
std::vector<ChaosPlan> plans_of(std::uint32_t modules, const std::vector<std::vector<ChaosCell>>& by_vendor) {
  std::vector<ChaosPlan> plans;
  std::uint32_t turn = 0;
  for (std::size_t v = 0; v < by_vendor.size(); ++v) {
    if (by_vendor[v].empty()) continue;
    ChaosPlan plan{.dds = vendor_choices[v], .cells = by_vendor[v]};
    sort_by_stage(plan);
    // The follower of an approach is the last module; struck are both sides.
    for (ChaosCell& cell : plan.cells) cell.module_id = 1 + turn++ % modules;
    plans.push_back(std::move(plan));
  }
  return plans;
}

}  // namespace

std::vector<ChaosPlan> full_matrix(std::uint32_t modules) {
  std::vector<std::vector<ChaosCell>> by_vendor(vendor_choices.size());
  for (auto& cells : by_vendor) {
    for (const FlightStage stage : flight_stages) {
      for (const Blow& blow : blows()) cells.push_back({.kind = blow.kind, .stage = stage, .process = blow.process});
    }
  }
  return plans_of(modules, by_vendor);
}

std::vector<ChaosPlan> pairwise_matrix(std::uint32_t modules) {
  // Greedy: the cell that covers most of the pairs still open; kind, process, stage and vendors are the four.
  struct Choice {
    Blow blow;
    std::size_t stage, vendor;
  };
  using Pair = std::pair<std::string, std::string>;
  const auto pairs_of = [](const Choice& c) {
    const std::string kind = name_of(c.blow.kind), stage = name_of(flight_stages[c.stage]),
                      vendor = vendor_choices[c.vendor], process = c.blow.process.empty() ? "link" : c.blow.process;
    return std::array<Pair, 6>{Pair{kind, process}, {kind, stage},     {kind, vendor},
                               {process, stage},    {process, vendor}, {stage, vendor}};
  };
  std::vector<Choice> all;
  std::set<Pair> open;
  for (const Blow& blow : blows()) {
    for (std::size_t s = 0; s < flight_stages.size(); ++s) {
      for (std::size_t v = 0; v < vendor_choices.size(); ++v) {
        all.push_back({blow, s, v});
        for (const Pair& pair : pairs_of(all.back())) open.insert(pair);
      }
    }
  }
  std::vector<std::vector<ChaosCell>> by_vendor(vendor_choices.size());
  while (!open.empty()) {
    const auto gain = [&](const Choice& c) {
      const auto pairs = pairs_of(c);
      return std::count_if(pairs.begin(), pairs.end(), [&](const Pair& pair) { return open.contains(pair); });
    };
    const Choice& best = *std::max_element(all.begin(), all.end(),
                                           [&](const Choice& a, const Choice& b) { return gain(a) < gain(b); });
    for (const Pair& pair : pairs_of(best)) open.erase(pair);
    by_vendor[best.vendor].push_back(
        {.kind = best.blow.kind, .stage = flight_stages[best.stage], .process = best.blow.process});
  }
  return plans_of(modules, by_vendor);
}

ChaosPlan random_plan(const std::string& dds, std::uint32_t modules, std::size_t cells, std::mt19937_64& random) {
  const std::vector<Blow> all = blows();
  // A modulus, not a distribution: one seed means one plan with every library.
  const auto draw = [&random](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  ChaosPlan plan{.dds = dds, .cells = {}};
  for (std::size_t k = 0; k < cells; ++k) {
    const Blow& blow = all[draw(all.size())];
    plan.cells.push_back({.kind = blow.kind,
                          .stage = flight_stages[draw(flight_stages.size())],
                          .module_id = 1 + static_cast<std::uint32_t>(draw(modules)),
                          .process = blow.process});
  }
  sort_by_stage(plan);
  return plan;
}

}  // namespace eciton::deploy
