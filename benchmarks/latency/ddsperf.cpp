// A pong and a ping process for each window.
#include "benchmarks/latency/ddsperf.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "benchmarks/latency/process.hpp"
#include "core/base/wall_clock.hpp"

namespace eciton::bench {
namespace {

/// As the plugin opens a domain, as far as it bears on a round trip.
std::string configuration(const LatencyOptions& options, const Place& place) {
  std::string xml = "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"" +
                    place.network_interface + "\" multicast=\"" + (options.peers.empty() ? "true" : "false") +
                    "\"/></Interfaces><AllowMulticast>" + (options.peers.empty() ? "spdp" : "false") +
                    "</AllowMulticast></General>";
  if (!options.peers.empty()) {
    xml += "<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers>";
    for (const std::string& peer : options.peers) xml += "<Peer Address=\"" + peer + "\"/>";
    xml += "</Peers></Discovery>";
  }
  return xml + "<Internal><MultipleReceiveThreads>false</MultipleReceiveThreads></Internal></Domain></CycloneDDS>";
}

ProgramSpec end_of(const LatencyOptions& options, const Place& place, const std::string& program,
                   const DdsperfRun& run, bool ping) {
  ProgramSpec spec;
  spec.path = program;
  spec.arguments = {"-i", std::to_string(options.domain + 20)};
  if (run.cell.qos == "sensor") spec.arguments.emplace_back("-u");
  if (ping) {
    spec.arguments.insert(spec.arguments.end(),
                          {"-D", "1.2", "ping", std::to_string(static_cast<int>(run.cell.rate_Hz)) + "Hz", "size",
                           std::to_string(run.cell.bytes)});
  } else {
    spec.arguments.insert(spec.arguments.end(), {"-D", "3", "pong"});
  }
  spec.arguments.emplace_back(run.delivery == "wake" ? "waitset" : "listener");
  spec.environment["CYCLONEDDS_URI"] = configuration(options, place);
  spec.footing = footing(options, place, ping);
  spec.quiet = true;
  return spec;
}

}  // namespace

std::optional<DdsperfWindow> parse_ddsperf(const std::string& line) {
  const std::size_t at = line.find(" mean ");
  DdsperfWindow half;
  double min_us = 0;
  if (at == std::string::npos ||
      std::sscanf(line.c_str() + at, " mean %lfus min %lfus 50%% %lfus 90%% %lfus 99%% %lfus max %lfus cnt %zu",
                  &half.mean_us, &min_us, &half.p50_us, &half.p90_us, &half.p99_us, &half.max_us, &half.count) != 7) {
    return std::nullopt;
  }
  return DdsperfWindow{2 * half.mean_us, 2 * half.p50_us, 2 * half.p90_us,
                       2 * half.p99_us,  2 * half.max_us, half.count};
}

std::string find_ddsperf() {
  const char* path = std::getenv("PATH");
  std::istringstream directories(path == nullptr ? "/usr/bin" : path);
  for (std::string directory; std::getline(directories, directory, ':');) {
    const std::string program = directory + "/ddsperf";
    if (::access(program.c_str(), X_OK) == 0) return program;
  }
  return {};
}

Status measure_ddsperf(const LatencyOptions& options, const Place& place, const std::string& program, DdsperfRun& run,
                       const runtime::StopFlag& stop) {
  Result<Process> pong = Process::start(end_of(options, place, program, run, false));
  if (!pong) return pong.error();
  Result<Process> ping = Process::start(end_of(options, place, program, run, true));
  if (!ping) return ping.error();
  const Duration deadline = monotonic_now() + std::chrono::seconds(3);
  for (;;) {
    const Result<std::string> line = ping->hear(deadline, stop);
    if (!line) return line.error();
    if (const auto window = parse_ddsperf(*line)) {
      run.windows.push_back(*window);
      return ok();
    }
  }
}

}  // namespace eciton::bench
