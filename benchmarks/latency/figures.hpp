// From streams to what is told: ratios with their confidence, tables, metrics by flat names, raw samples.
#pragma once

#include "benchmarks/latency/measure.hpp"
#include "benchmarks/latency/overhead.hpp"
#include "benchmarks/report/result.hpp"

namespace eciton::bench {

/// What the issue of this benchmark asks for; ratios are judged, times on a quiet machine only.
struct LatencyBars {
  static constexpr double tax_p50 = 1.05;  // of the upper confidence bound
  static constexpr double tax_p99 = 1.10;
  static constexpr double over_udp_inline = 2.5, over_udp_wake = 4;  // Cyclone DDS, 256 B, best effort
  static constexpr double framework_ns = 250;                        // per sample, 256 B
  static constexpr double sim_network_us = 1;
};

/// Metrics of a cell beyond the first rate and QoS class end in ".QOS.RATE" too:
///   tax_p50.VENDOR.MODE.BYTES, tax_p50_low, tax_p50_high, tax_p99…      ours over native, same vendor and mode
///   over_udp_p50.VENDOR.MODE.BYTES, …_low, …_high                        ours over raw UDP
///   round_trip_us_p50.LANE.BYTES, …_p99 and so on; one_way_us_…; loss, cpu_us, rss_MB, allocations, switches
Result latency_result(const LatencyOptions& options, const Plan& plan, const Measured& measured,
                      const Overhead& overhead);

}  // namespace eciton::bench
