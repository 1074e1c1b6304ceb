// A result with everything in it that can be in one: several charts, a tail, lost samples, hostile names.
#pragma once

#include <cmath>
#include <random>

#include "benchmarks/report/result.hpp"

namespace eciton::bench {

inline Samples made_up_samples(const std::string& name, double median_us, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Samples samples{.name = name, .unit = "µs"};
  for (std::size_t i = 0; i < count; ++i) {
    const double u = (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;
    samples.at_s.push_back(0.001 * static_cast<double>(i) + (i < count / 3 ? 0 : 3));  // others had their turn
    samples.values.push_back(median_us * (0.9 + 0.1 * std::pow(u, -0.45)));
  }
  samples.sent = count + 3;
  samples.lost = 3;
  return samples;
}

inline Result made_up_result() {
  Result result;
  result.title = "Latency <over> \"hosts\" & loopback";
  result.command = "bench latency";
  result.clock = "monotonic";
  result.seed = 7;
  result.config = {{"sizes_B", {64, 256, 1024}}, {"link", {{"delay_ms", 0}, {"loss", "0 <none>"}}}};
  result.metrics["tax_p50.cyclonedds.wake.256"] = 1.021;
  const char* names[] = {"raw UDP", "Cyclone DDS, native", "Cyclone DDS, ours", "Fast DDS, native", "Fast DDS, ours"};
  std::uint64_t seed = 0;
  for (const double size_factor : {1.0, 1.4}) {
    const std::string size = size_factor > 1 ? "1024 B" : "256 B";
    double median_us = 28;
    for (const char* name : names) {
      result.samples.push_back(made_up_samples(size + " " + name, median_us * size_factor, 12'000, ++seed));
      result.samples.back().chart = "Round trip, " + size;
      median_us *= 1.25;
    }
  }
  result.samples.back().partial = true;
  result.tables.push_back(summary_table("Round trip", result.samples));
  Bars bars{"Ours over native, p50", "ratio", {}, 1.05};
  for (const char* size : {"64 B", "256 B", "4 KB"}) {
    for (const char* vendor : {"Cyclone DDS, wake", "Cyclone DDS, inline", "Fast DDS, wake"}) {
      const double value = 1 + 0.01 * static_cast<double>(bars.bars.size());
      bars.bars.push_back({size, vendor, {value - 0.015, value, value + 0.02}});
    }
  }
  result.bars.push_back(bars);
  Curves curves{"Discovery, idle", "modules", "bytes/s", {{"lean"}, {"vendors' defaults"}}};
  for (double n = 2; n <= 16; ++n) {
    curves.curves[0].points.emplace_back(n, 40 * n);
    curves.curves[1].points.emplace_back(n, 60 * n * n);
  }
  result.curves.push_back(curves);
  result.notes = {"One way: the hosts share one clock, its error is 0.", "LCM is not installed: no figures."};
  result.partial = true;
  return result;
}

}  // namespace eciton::bench
