// Reasons to refuse a docking, and the choice of ports.
#include "services/docking/dock_request.hpp"

#include <charconv>

namespace eciton::docking {
namespace {

/// "%" in the pattern stands for the module.
BoundedString<127> with_module(std::string_view pattern, std::uint32_t module) {
  char text[127];
  std::size_t size = 0;
  for (const char c : pattern) {
    if (c == '%') {
      size = static_cast<std::size_t>(std::to_chars(text + size, text + sizeof text, module).ptr - text);
    } else if (size < sizeof text) {
      text[size++] = c;
    }
  }
  return {std::string_view(text, size)};
}

}  // namespace

BoundedString<127> DockAnswer::text() const {
  switch (refusal) {
    case DockRefusal::none:
      return {"accepted"};
    case DockRefusal::same_module:
      return with_module("follower and target are both module %: name two modules", module);
    case DockRefusal::unknown_module:
      return with_module("module % was never heard: is it up, and its radio?", module);
    case DockRefusal::silent:
      return with_module("module % is silent: wait until it is heard again", module);
    case DockRefusal::landed:
      return with_module("module % is not flying: take off first", module);
    case DockRefusal::already_docking:
      return with_module("module % is docking already: wait or stop it", module);
    case DockRefusal::not_zeroed:
      return with_module("module % has not zeroed its wrench observer: let it hover freely first", module);
    case DockRefusal::unsettled:
      return with_module("the chain of module % is being agreed on: ask again in a moment", module);
    case DockRefusal::ring:
      return with_module("module % is in the same chain: the docking would close a ring", module);
    case DockRefusal::ports_taken:
      return with_module("no free port fits a free port of module %: undock something first", module);
  }
  return {"unknown"};
}

DockAnswer refuse_dock(Side follower, Side target, bool same_chain, bool ports_fit) {
  const std::uint32_t named = target.front().module;
  if (follower.front().module == named) return {DockRefusal::same_module, named};
  const auto unfit = [](const Candidate& one) {
    if (!one.known) return DockRefusal::unknown_module;
    if (!one.fresh) return DockRefusal::silent;
    if (!one.flying) return DockRefusal::landed;
    return one.docking ? DockRefusal::already_docking : DockRefusal::none;
  };
  const auto first_unfit = [](Side side, const auto& judge) -> DockAnswer {
    for (const Candidate& one : side) {
      if (const DockRefusal refusal = judge(one); refusal != DockRefusal::none) return {refusal, one.module};
    }
    return {};
  };
  for (const Side side : {follower.first(1), target.first(1)}) {
    if (const DockAnswer answer = first_unfit(side, unfit); answer.refusal != DockRefusal::none) return answer;
  }
  if (same_chain) return {DockRefusal::ring, named};
  for (const Side side : {follower, target}) {
    if (const DockAnswer answer = first_unfit(side, unfit); answer.refusal != DockRefusal::none) return answer;
  }
  if (!ports_fit) return {DockRefusal::ports_taken, named};
  const auto raw = [](const Candidate& one) { return one.zeroed ? DockRefusal::none : DockRefusal::not_zeroed; };
  for (const Side side : {follower, target}) {
    if (const DockAnswer answer = first_unfit(side, raw); answer.refusal != DockRefusal::none) return answer;
  }
  return {};
}

std::optional<PortChoice> choose_ports(std::span<const FreePort> follower, std::span<const FreePort> target,
                                       double standoff_m) {
  std::optional<PortChoice> best;
  double best_m = 0;
  for (const FreePort& f : follower) {
    for (const FreePort& t : target) {
      if (f.kind == t.kind) continue;
      const Vector3 standoff_W = t.X_WP * (standoff_m * outward_T(t.kind));
      const double way_m = (f.X_WP.p - standoff_W).norm();
      if (best && way_m >= best_m) continue;
      best = PortChoice{f, t};
      best_m = way_m;
    }
  }
  return best;
}

}  // namespace eciton::docking
