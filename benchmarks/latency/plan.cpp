// Options to lanes and cells.
#include "benchmarks/latency/plan.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>

#include "benchmarks/latency/peers/transport.hpp"
#include "core/bus/plugin_loader.hpp"

namespace eciton::bench {
namespace {

namespace fs = std::filesystem;

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

Status check_words(const char* option, const std::vector<std::string>& given, const std::vector<std::string>& known) {
  if (given.empty()) return Error{std::string(option) + ": is empty; there are " + joined(known)};
  for (const std::string& word : given) {
    if (!contains(known, word)) return Error{std::string(option) + ": no '" + word + "'; there are " + joined(known)};
  }
  return ok();
}

std::string title(const std::string& vendor) { return vendor == "fastdds" ? "Fast DDS" : "Cyclone DDS"; }

fs::path own_directory() { return fs::read_symlink("/proc/self/exe").parent_path(); }

/// The programs of a run and what they are all started with.
class Programs {
 public:
  Programs(const LatencyOptions& options, const Place& place) : options_(options), place_(place) {
    directory_ = options.programs.empty() ? own_directory() : fs::path(options.programs);
    const fs::path counter = own_directory().parent_path() / "lib" / "libeciton_bench_heap_counter.so";
    if (fs::exists(counter)) environment_["LD_PRELOAD"] = counter.string();
  }

  bool exists(const std::string& transport) const { return fs::exists(path(transport)); }
  fs::path path(const std::string& transport) const { return directory_ / ("eciton-bench-peer-" + transport); }

  ProgramSpec peer(const std::string& transport, Role role, const std::vector<std::string>& arguments,
                   std::uint32_t domain) const {
    ProgramSpec spec;
    spec.path = path(transport);
    spec.arguments = {"--role", role == Role::ping ? "ping" : "echo", "--domain",    std::to_string(domain),
                      "--run",  "bench" + std::to_string(::getpid()), "--interface", place_.network_interface};
    for (const std::string& address : options_.peers) {
      spec.arguments.emplace_back("--peer");
      spec.arguments.push_back(address);
    }
    spec.arguments.insert(spec.arguments.end(), arguments.begin(), arguments.end());
    spec.environment = environment_;
    spec.footing = footing(options_, place_, role == Role::ping);
    return spec;
  }

  ProgramSpec overhead() const {
    ProgramSpec spec;
    spec.path = directory_ / "eciton-bench-overhead";
    spec.environment = environment_;
    const fs::path plugins = own_directory().parent_path() / "lib";
    spec.environment["ECITON_PLUGIN_PATH"] = (plugins / "bench").string() + ":" + plugins.string();
    spec.footing = footing(options_, place_, true);
    return spec;
  }

 private:
  const LatencyOptions& options_;
  const Place& place_;
  fs::path directory_;
  std::map<std::string, std::string> environment_;
};

class LaneList {
 public:
  LaneList(const LatencyOptions& options, const Place& place, const std::string& qos, std::vector<std::string>& notes)
      : options_(options), programs_(options, place), reliable_(qos == "command"), notes_(notes) {}

  std::vector<LaneSpec> make() {
    // Ours and the native one that it is held against stand next to each other.
    for (const std::string& vendor : options_.vendors) {
      for (const std::string& delivery : options_.deliveries) {
        add_ours(vendor, vendor, delivery);
        if (wanted("native")) add_native(vendor, delivery);
      }
    }
    for (const char* floor : {"udp", "zeromq", "lcm"}) {
      if (wanted(floor)) add_raw(floor);
    }
    for (const std::string& ping : options_.vendors) {
      for (const std::string& echo : options_.vendors) {
        for (const std::string& delivery : options_.deliveries) {
          if (ping != echo) add_ours(ping, echo, delivery);
        }
      }
    }
    return std::move(lanes_);
  }

 private:
  bool wanted(const char* baseline) const { return contains(options_.baselines, baseline); }

  std::vector<std::string> words(const std::string& delivery) const {
    std::vector<std::string> all{"--delivery", delivery};
    if (reliable_) all.emplace_back("--reliable");
    return all;
  }

  void add(const std::string& name, const std::string& label, Kind kind, const std::string& vendor,
           const std::string& delivery, ProgramSpec ping, ProgramSpec echo) {
    lanes_.push_back({name, label, kind, vendor, delivery, std::move(ping), std::move(echo)});
    ++domain_;
  }

  void add_ours(const std::string& ping, const std::string& echo, const std::string& delivery) {
    const std::uint32_t domain = options_.domain + domain_;
    const auto end = [&](Role role, const std::string& vendor) {
      std::vector<std::string> arguments = words(delivery);
      arguments.insert(arguments.end(), {"--dds", vendor});
      return programs_.peer("eciton", role, arguments, domain);
    };
    const bool same = ping == echo;
    add("ours." + (same ? ping : ping + "-" + echo) + "." + delivery,
        "ours on " + (same ? title(ping) : title(ping) + " → " + title(echo)) + ", " + delivery, Kind::ours,
        same ? ping : "", delivery, end(Role::ping, ping), end(Role::echo, echo));
  }

  void add_native(const std::string& vendor, const std::string& delivery) {
    if (!there(vendor, "the build")) return;
    const std::uint32_t domain = options_.domain + domain_;
    add("native." + vendor + "." + delivery, "native " + title(vendor) + ", " + delivery, Kind::native, vendor,
        delivery, programs_.peer(vendor, Role::ping, words(delivery), domain),
        programs_.peer(vendor, Role::echo, words(delivery), domain));
  }

  void add_raw(const std::string& transport) {
    if (!there(transport, transport == "zeromq" ? "libzmq3-dev" : transport == "lcm" ? "liblcm-dev" : "the build"))
      return;
    const std::string label = transport == "udp" ? "raw UDP" : transport == "lcm" ? "LCM" : "ZeroMQ";
    const std::uint32_t domain = options_.domain + domain_;
    add(transport, label, Kind::foreign, "", "", programs_.peer(transport, Role::ping, {}, domain),
        programs_.peer(transport, Role::echo, {}, domain));
  }

  /// Else: a note of what is missing.
  bool there(const std::string& transport, const std::string& package) {
    if (programs_.exists(transport)) return true;
    const std::string note = "missing: " + programs_.path(transport).string() + " is not there; it is built where " +
                             package + " is installed";
    if (!contains(notes_, note)) notes_.push_back(note);
    return false;
  }

  const LatencyOptions& options_;
  Programs programs_;
  bool reliable_;
  std::uint32_t domain_ = 0;
  std::vector<std::string>& notes_;
  std::vector<LaneSpec> lanes_;
};

Status check_numbers(const LatencyOptions& options) {
  for (const std::uint32_t bytes : options.bytes) {
    if (std::find(payload_sizes.begin(), payload_sizes.end(), bytes) == payload_sizes.end())
      return Error{"--sizes: no payload of " + std::to_string(bytes) + " B; there are 64, 256, 1024, 4096"};
  }
  for (const double rate : options.rates_Hz) {
    if (!(rate >= 1 && rate <= 10'000)) return Error{"--rates: " + std::to_string(rate) + " Hz is not in 1 to 10000"};
    if (rate * options.block_s > BlockRecorder::capacity)
      return Error{"--block: " + std::to_string(options.block_s) + " s at " + std::to_string(rate) +
                   " Hz is more than " + std::to_string(BlockRecorder::capacity) + " samples"};
  }
  if (options.domain > 80) return Error{"--domain: " + std::to_string(options.domain) + " is not in 0 to 80"};
  return ok();
}

/// Real-time and pinned where that may be.
Status settle_footing(LatencyOptions& options, std::vector<std::string>& notes) {
  const bool default_priority = options.priority < 0;
  if (default_priority) options.priority = 20;
  if (std::thread::hardware_concurrency() < 2) options.pin = false;
  if (options.pin && !(check({"", 0, 0}) && check({"", 1, 0}))) {
    options.pin = false;
    notes.emplace_back("processors 0 and 1 are not both ours: peers run wherever the scheduler puts them");
  }
  if (const Status fifo = check({"", -1, options.priority}); !fifo) {
    if (!default_priority) return Error{"--priority: " + fifo.error().message};
    options.priority = 0;
    notes.emplace_back("no right to SCHED_FIFO (CAP_SYS_NICE): peers share the processors with all others");
  }
  return ok();
}

}  // namespace

const std::vector<std::string>& latency_baselines() {
  static const std::vector<std::string> words{"native", "udp", "ddsperf", "zeromq", "lcm", "none"};
  return words;
}

std::string Cell::suffix() const {
  std::string text = std::to_string(bytes);
  if (!plain) text += "." + qos + "." + std::to_string(std::lround(rate_Hz)) + "." + over;
  return text;
}

Result<Plan> make_plan(LatencyOptions& options) {
  Plan plan;
  const Status checks[] = {check_words("--vendors", options.vendors, {"cyclonedds", "fastdds"}),
                           check_words("--qos", options.qos, {"sensor", "command"}),
                           check_words("--modes", options.deliveries, {"wake", "inline"}),
                           check_words("--baselines", options.baselines, latency_baselines()),
                           check_numbers(options),
                           check_words("--over", options.over, {"loopback", "hosts", "impaired"}),
                           settle_footing(options, plan.notes)};
  for (const Status& each : checks) {
    if (!each) return each.error();
  }
  for (const std::string& over : options.over) {
    if (const Status venue = check_venue(over, options); !venue)
      return Error{"--over " + over + ": " + venue.error().message};
    for (const std::string& qos : options.qos) {
      for (const double rate_Hz : options.rates_Hz) {
        const bool plain =
            qos == options.qos.front() && rate_Hz == options.rates_Hz.front() && over == options.over.front();
        for (const std::uint32_t bytes : options.bytes) plan.cells.push_back({bytes, rate_Hz, qos, over, plain});
      }
    }
  }
  plan.rounds = std::max<std::size_t>(2, std::lround(options.duration_s / options.block_s));
  const std::vector<LaneSpec> lanes = lanes_of(options, {}, options.qos.front(), plan.notes);
  plan.missing = std::any_of(plan.notes.begin(), plan.notes.end(),
                             [](const std::string& note) { return note.starts_with("missing: "); });
  if (!fs::exists(lanes.front().ping.path)) {
    return Error{lanes.front().ping.path + " is not there: it is built with the benchmarks"};
  }
  return plan;
}

ProgramSpec overhead_program(const LatencyOptions& options) {
  const Place here;
  return Programs(options, here).overhead();
}

Footing footing(const LatencyOptions& options, const Place& place, bool ping) {
  const int cpu = options.pin ? (ping ? 0 : 1) : -1;
  return {ping ? place.ping_namespace : place.echo_namespace, cpu, options.priority};
}

std::vector<LaneSpec> lanes_of(const LatencyOptions& options, const Place& place, const std::string& qos,
                               std::vector<std::string>& notes) {
  return LaneList(options, place, qos, notes).make();
}

}  // namespace eciton::bench
