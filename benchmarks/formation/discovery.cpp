// All but one module, then the last one, then silence; the ear counts what each of them sends.
#include "benchmarks/formation/discovery.hpp"

#include "benchmarks/formation/air_ear.hpp"
#include "benchmarks/formation/chain_trials.hpp"
#include "core/base/wall_clock.hpp"

namespace eciton::bench {
namespace {

void add(TrafficCount& sum, const TrafficCount& more) {
  sum.packets += more.packets;
  sum.bytes += more.bytes;
}

DiscoveryCount sum_of(const std::vector<RtpsMeter>& meters, double seconds) {
  DiscoveryCount sum{.seconds = seconds};
  for (const RtpsMeter& meter : meters) {
    add(sum.total, meter.total());
    add(sum.discovery, meter.discovery());
    add(sum.participants, meter.of(RtpsUse::participants));
    add(sum.endpoints, meter.of(RtpsUse::endpoints));
    add(sum.liveliness, meter.of(RtpsUse::liveliness));
    add(sum.unreachable, meter.of(RtpsUse::unreachable));
    add(sum.topics, meter.of(RtpsUse::topics));
    add(sum.multicast, meter.multicast());
    add(sum.other, meter.of(RtpsUse::other));
    const auto beacons = meter.topics().find("beacon");
    if (beacons != meter.topics().end()) add(sum.beacons, beacons->second);
  }
  return sum;
}

/// Everyone but itself, as a person would list them in a module's config.
std::string peers_of(std::uint32_t index, std::uint32_t modules) {
  std::string text;
  for (std::uint32_t other = 0; other < modules; ++other) {
    if (other != index) text += (text.empty() ? "" : ", ") + net::host_address(other + 1);
  }
  return "swarm_ring.peers=[" + text + "]";
}

void start(Fleet& fleet, const DiscoveryCase& which, std::uint32_t index) {
  std::vector<std::string> call{"eciton-bench-participant", "--dds", which.vendor, "--domain",
                                std::to_string(swarm_domain)};
  if (which.lean) {
    const auto file = fleet.write_config(index, which.vendor, {peers_of(index, which.modules)});
    call = {"eciton-service", "radio", "--config", file};
  }
  if (const Status started = fleet.start(index, call); !started) throw FormationFailure{started.error().message};
}

void listen(Fleet& fleet, double seconds, const RunControl& control) {
  const Duration end = monotonic_now() + from_s(seconds);
  while (monotonic_now() < end) {
    std::vector<pollfd> wait{{control.stop.file_descriptor(), POLLIN, 0}};
    fleet.add_descriptors(wait);
    deploy::wait_for(wait, end - monotonic_now());
    if (control.stop.requested()) throw FormationFailure{"interrupted"};
    if (const std::string trouble = fleet.trouble(); !trouble.empty()) throw FormationFailure{trouble};
  }
}

}  // namespace

DiscoveryFigures measure_discovery(const FormationOptions& options, const DiscoveryCase& which,
                                   const net::OwnedNet& net, const RunControl& control) {
  Fleet fleet(options, &net);
  AirEar ear(net, which.modules);
  DiscoveryFigures figures;
  for (std::uint32_t index = 0; index + 1 < which.modules; ++index) start(fleet, which, index);
  listen(fleet, options.settle_s, control);
  ear.restart();
  start(fleet, which, which.modules - 1);
  listen(fleet, options.joining_s, control);
  figures.joining = sum_of(ear.meters(), options.joining_s);
  ear.restart();
  listen(fleet, options.idle_s, control);
  figures.idle = sum_of(ear.meters(), options.idle_s);
  figures.missed = ear.missed();
  return figures;
}

}  // namespace eciton::bench
