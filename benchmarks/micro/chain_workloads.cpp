// What a claim costs that changes a chain: joined, the graph anew, the view, its epoch; and the update of
// every period, when nothing changed.
#include <memory>
#include <vector>

#include "benchmarks/micro/workload.hpp"
#include "core/chain/agreement.hpp"

namespace eciton::bench {
namespace {

/// Module 1 of a chain of n; its own link is what comes and goes.
struct Chain {
  explicit Chain(std::uint32_t n) {
    for (std::uint32_t id = 1; id <= n; ++id) {
      claims.join(claim(id, chain::ChainRule::male_port, id < n ? id + 1 : 0));
      claims.join(claim(id, chain::ChainRule::female_port, id > 1 ? id - 1 : 0));
      if (id > 1) peers.push_back({.module = id, .fresh = true, .clock_offset = Duration{}});
    }
    update();
  }

  chain::Claim claim(std::uint32_t module, std::uint32_t port, std::uint32_t peer) const {
    chain::Claim out{.module = module, .port = port, .incarnation = 1, .sequence_number = 1};
    if (peer == 0) return out;
    out.peer = peer;
    out.peer_port = 1 - port;
    out.withdrawn = false;
    out.latch = chain::LatchStatus::latched;
    return out;
  }

  void change() {
    chain::Claim own = claim(1, chain::ChainRule::male_port, linked ? 0 : 2);
    own.sequence_number = ++sequence_number;
    linked = !linked;
    claims.join(own);
  }

  double update() {
    now += 10ms;
    agreement.update(now, claims, announcements, peers);
    return agreement.held() ? static_cast<double>(agreement.held()->epoch % 1024) : -1;
  }

  chain::ChainRule rule;
  chain::Agreement agreement{{.module = 1, .incarnation = 1}, rule};
  chain::ClaimTable claims;
  chain::AnnouncementTable announcements;
  std::vector<chain::PeerStatus> peers;
  TimePoint now{1s};
  std::uint64_t sequence_number = 1;
  bool linked = true;
};

Step join(std::uint32_t n) {
  auto one = std::make_shared<Chain>(n);
  return [one] {
    one->change();
    return one->update();
  };
}

Step idle(std::uint32_t n) {
  auto one = std::make_shared<Chain>(n);
  return [one] { return one->update(); };
}

}  // namespace

std::vector<Workload> chain_workloads() {
  return {{"chain/view_join/2", [] { return join(2); }, true},
          {"chain/view_join/8", [] { return join(8); }, true},
          {"chain/view_join/16", [] { return join(16); }, true},
          {"chain/view_unchanged/8", [] { return idle(8); }, true}};
}

}  // namespace eciton::bench
