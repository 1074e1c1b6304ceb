// The framework's own part of a sample's way: write into a plugin that keeps only the bytes, take from it, and the
// whole way between two participants over sim_network. In batches: the clock costs as much as a step of what it
// times.
#include <dlfcn.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <vector>

#include "benchmarks/idl/payload.hpp"
#include "benchmarks/latency/peers/transport.hpp"
#include "core/base/wall_clock.hpp"
#include "core/bus/participant.hpp"

namespace eciton::bench {
namespace {

constexpr bus::Topic<Payload256> topic{"bench_overhead", bus::QosClass::sensor, bus::Scope::module};
constexpr int batches = 300;
constexpr int batch = 500;

std::uint64_t allocations() {
  using Count = std::uint64_t (*)();
  static const auto count = reinterpret_cast<Count>(::dlsym(RTLD_DEFAULT, "eciton_bench_allocations"));
  return count == nullptr ? 0 : count();
}

/// Of one call, in ns.
template <class Call>
double median_ns(Call&& call) {
  std::vector<double> times;
  times.reserve(batches);
  for (int b = 0; b < batches; ++b) {
    const Duration before = monotonic_now();
    for (int k = 0; k < batch; ++k) call();
    times.push_back(static_cast<double>((monotonic_now() - before).count()) / batch);
  }
  std::nth_element(times.begin(), times.begin() + batches / 2, times.end());
  return times[batches / 2];
}

class Pair {
 public:
  explicit Pair(const std::string& vendor)
      : here_({.vendor = vendor, .domain = 1, .name = "here"}),
        there_({.vendor = vendor, .domain = 1, .name = "there"}),
        writer_(here_.create_writer(topic)),
        reader_(there_.create_reader(topic)) {
    there_.set_all_wake(false);
    sample_.module_id = 1;
    fill(sample_.values);
  }
  void write() {
    ++sample_.number;
    ++sample_.stamp_ns;
    if (!writer_.write(sample_)) throw BadInput{{"a sample was refused"}};
  }
  void write_and_take() {
    write();
    const auto taken = reader_.take();
    if (!taken || taken->value.number != sample_.number) throw BadInput{{"a sample did not arrive"}};
  }

 private:
  bus::Participant here_, there_;
  bus::Writer<Payload256> writer_;
  bus::Reader<Payload256> reader_;
  Payload256 sample_{};
};

int measure() {
  Pair nothing("nothing");
  for (int k = 0; k < 1000; ++k) nothing.write_and_take();
  const std::uint64_t before = allocations();
  for (int k = 0; k < 1000; ++k) nothing.write_and_take();
  const double allocated = static_cast<double>(allocations() - before) / 1000;
  const double write_ns = median_ns([&] { nothing.write(); });
  const double both_ns = median_ns([&] { nothing.write_and_take(); });
  Pair sim("sim_network");
  const double sim_ns = median_ns([&] { sim.write_and_take(); });
  std::printf("overhead %.1f %.1f %g %.4f\n", write_ns, both_ns - write_ns, allocated, sim_ns / 1000);
  return 0;
}

}  // namespace
}  // namespace eciton::bench

int main() {
  try {
    return eciton::bench::measure();
  } catch (const eciton::BadInput& bad) {
    std::fprintf(stderr, "eciton-bench-overhead: %s\n", bad.error.message.c_str());
    return 2;
  }
}
