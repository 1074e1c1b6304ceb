// The networks of this process, one per domain.
#include <map>
#include <mutex>
#include <stdexcept>

#include "core/bus/vendors/sim_network/medium.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"

namespace eciton::bus::sim_network {

namespace {

struct Registry {
  std::mutex mutex;
  std::map<std::uint32_t, std::unique_ptr<Network>> networks;
};

/// Never destroyed: participants of other static objects may outlive any order of destruction.
Registry& registry() {
  static Registry& instance = *new Registry;
  return instance;
}

}  // namespace

Statistics& Statistics::operator+=(const Statistics& other) {
  sent += other.sent;
  delivered += other.delivered;
  lost += other.lost;
  retransmitted += other.retransmitted;
  superseded += other.superseded;
  duplicated += other.duplicated;
  reordered += other.reordered;
  replaced += other.replaced;
  dropped += other.dropped;
  return *this;
}

Network& Network::of(std::uint32_t domain) {
  Registry& all = registry();
  const std::scoped_lock lock(all.mutex);
  auto& network = all.networks[domain];
  if (!network) network = std::make_unique<Network>(domain);
  return *network;
}

void Network::reset_all() {
  Registry& all = registry();
  const std::scoped_lock lock(all.mutex);
  for (const auto& [domain, network] : all.networks)
    if (network->medium_->in_use())
      throw std::logic_error("sim_network: reset_all() with participants alive in domain " + std::to_string(domain) +
                             "; destroy them first");
  all.networks.clear();
}

Network::Network(std::uint32_t domain) : medium_(std::make_unique<Medium>(domain)) {}
Network::~Network() = default;

void Network::configure(std::uint64_t seed, Pacing pacing) { medium_->configure(seed, pacing); }
void Network::set_default_link(const LinkQuality& quality) { medium_->set_default_link(quality); }
void Network::set_link(std::string_view from, std::string_view to, const LinkQuality& quality) {
  medium_->set_link(from, to, quality);
}
void Network::partition(const std::vector<std::vector<std::string>>& groups) { medium_->partition(groups); }
void Network::heal() { medium_->partition({}); }
void Network::advance(TimePoint now) { medium_->advance(now); }
std::optional<TimePoint> Network::next_delivery() const { return medium_->next_delivery(); }
Statistics Network::statistics() const { return medium_->statistics(); }
Statistics Network::statistics(std::string_view from, std::string_view to) const {
  return medium_->statistics(from, to);
}
std::uint64_t Network::mismatched() const { return medium_->mismatched(); }
std::uint64_t Network::writes_refused() const { return medium_->writes_refused(); }

}  // namespace eciton::bus::sim_network
