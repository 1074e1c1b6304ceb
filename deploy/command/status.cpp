// Listens for half a second, or a little longer for services that should be there and are not heard yet.
#include "deploy/command/status.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <thread>

#include "core/base/wall_clock.hpp"
#include "core/bus/plugin_loader.hpp"
#include "deploy/command/measurement.hpp"
#include "deploy/command/module_ear.hpp"
#include "deploy/net/hosts.hpp"
#include "deploy/supervisor/running_modules.hpp"

namespace eciton::deploy {
namespace {

struct StatusOptions {
  std::vector<std::uint32_t> ids;
  std::string vendor;
  std::string network_interface = "lo";
  double seconds = 0.5;
  std::string json_file;
};

constexpr std::uint32_t module_ring_domain_base = 10;
constexpr int patience_factor = 4;

/// A module and the ear on its ring.
struct Watched {
  RunningModule module;
  std::unique_ptr<ModuleEar> ear;

  /// Whether each of its processes is heard.
  bool complete() const {
    if (module.processes.empty()) return !ear->heartbeats().empty();
    return std::all_of(module.processes.begin(), module.processes.end(), [&](const RunningProcess& process) {
      return process.pid == 0 ||
             std::any_of(ear->heartbeats().begin(), ear->heartbeats().end(), [&](const auto& beat) {
               return beat.second.beat.pid == static_cast<std::uint32_t>(process.pid);
             });
    });
  }
};

std::vector<RunningModule> chosen(const StatusOptions& options) {
  std::vector<RunningModule> all = running_modules();
  if (options.ids.empty()) return all;
  std::vector<RunningModule> result;
  for (const std::uint32_t id : options.ids) {
    const auto found = std::find_if(all.begin(), all.end(), [id](const auto& m) { return m.module_id == id; });
    result.push_back(found != all.end() ? *found
                                        : RunningModule{.name = "m" + std::to_string(id),
                                                        .module_id = id,
                                                        .domain = module_ring_domain_base + id,
                                                        .network_interface = options.network_interface,
                                                        .processes = {}});
  }
  return result;
}

std::vector<Watched> listen(const StatusOptions& options, const std::vector<RunningModule>& modules) {
  std::vector<Watched> watched;
  for (const RunningModule& module : modules) {
    if (module.module_id == 0) continue;
    const net::InNamespace inside(module.network_namespace);
    const std::string vendor = options.vendor.empty() ? bus::chosen_vendor("cyclonedds") : options.vendor;
    watched.push_back(
        {module, std::make_unique<ModuleEar>(bus::ParticipantConfig{.vendor = vendor,
                                                                    .domain = module.domain,
                                                                    .name = "eciton status",
                                                                    .network_interface = module.network_interface,
                                                                    .peers = {}})});
  }
  const Duration begin = monotonic_now();
  const Duration least = from_s(options.seconds);
  while (true) {
    for (const Watched& w : watched) w.ear->poll();
    const Duration waited = monotonic_now() - begin;
    const bool complete = std::all_of(watched.begin(), watched.end(), [](const Watched& w) { return w.complete(); });
    if ((waited > least && complete) || waited > patience_factor * least) return watched;
    std::this_thread::sleep_for(10ms);
  }
}

/// The process that a service runs in, by what its supervisor wrote down.
RunningProcess process_of(const RunningModule& module, std::uint32_t pid) {
  for (const RunningProcess& process : module.processes) {
    if (process.pid == static_cast<pid_t>(pid)) return process;
  }
  return {};
}

/// "0.002 s", "3.4 s", "95 s": how long ago that was, at a glance.
std::string ago(Duration age) {
  char text[32];
  const double s = to_s(age);
  std::snprintf(text, sizeof text, s < 0.1 ? "%.3f s" : s < 10 ? "%.1f s" : "%.0f s", s);
  return text;
}

std::string chain_text(const msg::ChainView& view) {
  std::string text;
  for (const std::uint32_t member : view.members) text += (text.empty() ? "" : "-") + std::to_string(member);
  if (view.members.size() < 2) return "alone";
  return "chain " + text + (view.epoch == view.active_epoch ? "" : ", being agreed on");
}

void print_states(const Watched& w) {
  std::printf("%s  (id %u, domain %u on %s", w.module.name.c_str(), w.module.module_id, w.module.domain,
              w.module.network_interface.c_str());
  if (!w.module.network_namespace.empty()) std::printf(" in %s", w.module.network_namespace.c_str());
  if (w.module.holder != 0) std::printf(", up by process %d", static_cast<int>(w.module.holder));
  std::printf(")\n");
  if (w.ear->heartbeats().empty()) {
    std::printf("  no heartbeat is heard\n");
    return;
  }
  const auto mode = w.ear->flight_mode();
  const auto with_age = [&](const std::string& what, const auto& sample) {
    return what + " (" + ago(w.ear->age_of(sample->stamp_ns)) + ")";
  };
  std::printf("  flight %s, estimator %s, docking %s, %s\n", mode ? name_of(*mode).c_str() : "unknown",
              w.ear->state() ? with_age(name_of(w.ear->state()->mode), w.ear->state()).c_str() : "unknown",
              w.ear->docking() ? with_age(name_of(w.ear->docking()->phase), w.ear->docking()).c_str() : "unknown",
              w.ear->view() ? with_age(chain_text(*w.ear->view()), w.ear->view()).c_str() : "chain unknown");
}

void print_services(const Watched& w) {
  if (w.ear->heartbeats().empty()) return;
  std::printf("  %-12s %-11s %8s %8s %10s %10s %10s %10s %9s %8s %8s\n", "SERVICE", "VENDOR", "PID", "AGE ms",
              "PERIOD ms", "JITTER us", "EXEC us", "MAX us", "OVERRUNS", "DROPPED", "RESTARTS");
  const Duration now = monotonic_now();
  for (const auto& [service, heard] : w.ear->heartbeats()) {
    const msg::Heartbeat& b = heard.beat;
    std::printf("  %-12s %-11s %8u %8.0f %10.2f %10.0f %10.0f %10.0f %9llu %8llu %8u\n", service.c_str(),
                b.vendor.c_str(), b.pid, 1e3 * to_s(now - heard.arrived), 1e3 * b.period_s, 1e6 * b.jitter_s_p99,
                1e6 * b.execution_s_mean, 1e6 * b.execution_s_max, static_cast<unsigned long long>(b.overruns),
                static_cast<unsigned long long>(b.dropped), process_of(w.module, b.pid).restarts);
  }
  for (const auto& [service, heard] : w.ear->heartbeats()) {
    if (heard.beat.rejected == 0) continue;
    std::printf("  %s refused %llu bad samples since its start: `eciton topic echo fault` says which\n",
                service.c_str(), static_cast<unsigned long long>(heard.beat.rejected));
  }
}

void print_refused_claims(const Watched& w) {
  if (!w.ear->radio()) return;
  const msg::RadioState& r = *w.ear->radio();
  if (r.claims_malformed + r.claims_foreign + r.claims_unknown + r.claims_no_port == 0) return;
  const auto number = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
  std::printf(
      "  link claims that were not let in: %llu malformed, %llu not from that module's radio, %llu of unknown "
      "modules, %llu for ports that do not exist\n",
      number(r.claims_malformed), number(r.claims_foreign), number(r.claims_unknown), number(r.claims_no_port));
}

void print_restarts(const RunningModule& module) {
  for (const RunningProcess& process : module.processes) {
    if (process.restarts == 0) continue;
    std::printf("  %s was started again %u times, %u of them after it hung; the last time after: %s\n",
                process.name.c_str(), process.restarts, process.hangs, process.last_end.c_str());
  }
}

std::string fault_text(const msg::Fault& fault) {
  std::string text = std::string(fault.service.view());
  if (!fault.device.empty()) text += " (" + std::string(fault.device.view()) + ")";
  return text + ": " + std::string(fault.text.view());
}

/// The file with what the service knew and did before; empty: there is none.
std::string record_of(const Watched& w, const msg::Fault& fault) {
  if (fault.record.empty()) return {};
  return (w.module.faults / fault.record.view()).string();
}

void print_faults(const Watched& w) {
  if (w.ear->faults().empty()) return;
  std::printf("  errors: %zu; the last faults:\n", w.ear->errors());
  for (const msg::Fault& fault : w.ear->faults()) {
    std::printf("  %10s ago  %-8s %s\n", ago(w.ear->age_of(fault.stamp_ns)).c_str(), name_of(fault.severity).c_str(),
                fault_text(fault).c_str());
    const std::string record = record_of(w, fault);
    if (record.empty()) continue;
    // Known only for modules of this host.
    const bool missing = !w.module.faults.empty() && !std::filesystem::exists(record);
    std::printf("  %14s  what it knew and did before: %s%s\n", "", record.c_str(),
                missing ? " (gone, or never written: see its log)" : "");
  }
}

/// Processes that should be there; returns whether all are.
bool print_silent(const Watched& w) {
  bool all_heard = true;
  for (const RunningProcess& process : w.module.processes) {
    const bool heard = std::any_of(w.ear->heartbeats().begin(), w.ear->heartbeats().end(), [&](const auto& beat) {
      return beat.second.beat.pid == static_cast<std::uint32_t>(process.pid);
    });
    if (heard) continue;
    all_heard = false;
    if (process.pid == 0) {
      std::printf("  %-12s is not running\n", process.name.c_str());
    } else {
      std::printf("  %-12s is silent (pid %d)\n", process.name.c_str(), static_cast<int>(process.pid));
    }
  }
  return all_heard && !w.ear->heartbeats().empty();
}

Json module_json(const Watched& w) {
  Json json{{"name", w.module.name},         {"id", w.module.module_id},    {"domain", w.module.domain},
            {"holder_pid", w.module.holder}, {"heartbeats", Json::array()}, {"processes", Json::array()},
            {"errors", w.ear->errors()},     {"faults", Json::array()}};
  for (const auto& [service, heard] : w.ear->heartbeats()) {
    Json beat = to_json(heard.beat);
    beat["age_s"] = to_s(monotonic_now() - heard.arrived);
    beat["restarts"] = process_of(w.module, heard.beat.pid).restarts;
    json["heartbeats"].push_back(beat);
  }
  for (const RunningProcess& process : w.module.processes) {
    json["processes"].push_back({{"name", process.name},
                                 {"vendor", process.vendor},
                                 {"pid", process.pid},
                                 {"restarts", process.restarts},
                                 {"hangs", process.hangs},
                                 {"last_end", process.last_end}});
  }
  const auto with_age = [&](const auto& sample) {
    Json aged = to_json(sample);
    aged["age_s"] = to_s(w.ear->age_of(sample.stamp_ns));
    return aged;
  };
  for (const msg::Fault& fault : w.ear->faults()) {
    json["faults"].push_back(with_age(fault));
    json["faults"].back()["record_file"] = record_of(w, fault);
  }
  if (const auto mode = w.ear->flight_mode()) json["flight_mode"] = name_of(*mode);
  if (w.ear->state()) json["module_state"] = with_age(*w.ear->state());
  if (w.ear->docking()) json["docking_state"] = with_age(*w.ear->docking());
  if (w.ear->view()) json["chain_view"] = with_age(*w.ear->view());
  if (w.ear->radio()) json["radio_state"] = with_age(*w.ear->radio());
  return json;
}

int print_status(const StatusOptions& options) {
  const std::vector<RunningModule> modules = chosen(options);
  const std::vector<Watched> watched = listen(options, modules);
  Measurement measurement{.command = "status", .clock = "monotonic"};
  measurement.config = {{"seconds", options.seconds}};
  measurement.series["modules"] = Json::array();
  bool all_well = true;
  for (const Watched& w : watched) {
    print_states(w);
    print_services(w);
    print_refused_claims(w);
    all_well = print_silent(w) && all_well;
    print_restarts(w.module);
    print_faults(w);
    measurement.series["modules"].push_back(module_json(w));
  }
  for (const RunningModule& module : modules) {
    if (module.module_id == 0)
      std::printf("%s  (up by process %d)\n", module.name.c_str(), static_cast<int>(module.holder));
  }
  if (modules.empty())
    std::printf("no module runs here (%s); --module ID listens to one that others started\n", runtime_root().c_str());
  measurement.metrics["modules"] = watched.size();
  measurement.metrics["all_heard"] = all_well ? 1 : 0;
  if (!options.json_file.empty()) ok_or_throw(write_measurement(options.json_file, measurement));
  return all_well ? 0 : 1;
}

}  // namespace

void add_status(CLI::App& app, Run& run) {
  const auto options = std::make_shared<StatusOptions>();
  CLI::App* sub = app.add_subcommand("status", "what runs on this host, and how it is doing");
  sub->add_option("--module", options->ids, "only these ids, whoever started them")->check(CLI::Range(1, 90));
  sub->add_option("--dds", options->vendor, "DDS vendor to listen with (default: ECITON_DDS, else cyclonedds)");
  sub->add_option("--interface", options->network_interface, "of modules that others started (default: lo)");
  sub->add_option("--seconds", options->seconds, "listen for so long, s")
      ->check(CLI::Range(0.05, 60.0))
      ->capture_default_str();
  sub->add_option("--json", options->json_file, "write it to this file as well");
  on_chosen(*sub, run, [options] { return print_status(*options); });
}

}  // namespace eciton::deploy
