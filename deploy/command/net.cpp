// Each verb is one call of deploy/net, and what a person wants to read about it.
#include "deploy/command/net.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/log.hpp"
#include "deploy/command/detach.hpp"
#include "deploy/net/net.hpp"
#include "deploy/net/requests.hpp"

namespace eciton::deploy {
namespace {

using Json = nlohmann::json;

struct NetOptions {
  net::NetSpec spec;
  std::string name;  // empty: the only one
  bool foreground = false;
  std::string from, to;
  std::vector<std::string> words;
  std::string json_file;
};
using Options = std::shared_ptr<NetOptions>;

void print_up(const net::NetSpec& spec) {
  const std::string& name = spec.name;
  std::printf("net %s is up: hosts m1 to m%u and operator on a radio, %s to %s and %s, seed %llu\n", name.c_str(),
              spec.modules, net::host_address(1).c_str(), net::host_address(spec.modules).c_str(),
              net::host_address(net::operator_host).c_str(), static_cast<unsigned long long>(spec.seed));
  std::printf("enter one with: ip netns exec %s-m1 COMMAND\n", name.c_str());
}

/// True when it is up as asked for.
bool is_up_already(const net::NetSpec& spec) {
  for (const net::KnownNet& known : net::known_nets()) {
    if (known.spec.name != spec.name || !known.up) continue;
    if (known.spec.modules == spec.modules && known.spec.seed == spec.seed) return true;
    throw BadInput{{"net " + spec.name + " is up with " + std::to_string(known.spec.modules) +
                    " module hosts and seed " + std::to_string(known.spec.seed) +
                    "; end it with 'eciton net down --name " + spec.name + "', or give this one another --name"}};
  }
  return false;
}

/// Ends with whoever started it, who may be killed: and then tidies up. The kernel tells of a parent's death once per
/// thread of it, so the signal must not be one whose second coming ends the process.
class StopWithParent {
 public:
  explicit StopWithParent(runtime::StopFlag& stop) {
    flag = &stop;
    struct sigaction action {};
    action.sa_handler = [](int) { flag->request(); };
    ::sigaction(SIGHUP, &action, nullptr);
    ::prctl(PR_SET_PDEATHSIG, SIGHUP);
  }
  ~StopWithParent() { ::signal(SIGHUP, SIG_IGN); }
  StopWithParent(const StopWithParent&) = delete;
  StopWithParent& operator=(const StopWithParent&) = delete;

 private:
  static inline runtime::StopFlag* flag = nullptr;
};

int bring_up(const NetOptions& options) {
  const net::NetSpec& spec = options.spec;
  ok_or_throw(net::check_name(spec.name));
  ok_or_throw(net::check_rights());
  if (is_up_already(spec)) {
    if (options.foreground) throw BadInput{{"net " + spec.name + " is up already"}};
    print_up(spec);
    return 0;
  }
  Detached detached = options.foreground ? Detached() : Detached::fork();
  if (detached.is_parent()) return detached.wait_for_start();
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  std::optional<StopWithParent> with_parent;
  if (options.foreground) with_parent.emplace(stop);
  try {
    start_log("net " + spec.name, "info");
    net::run_net(spec, stop, [&] {
      print_up(spec);
      std::fflush(stdout);
      detached.report_started();
    });
  } catch (const BadInput& bad) {
    detached.report_failure(bad.error.message);
    throw;
  }
  return 0;
}

int set(const NetOptions& options) {
  ok_or_throw(net::set_links(options.name, options.from, options.to, options.words));
  return 0;
}

void print_link(const Json& link) {
  const auto number = [&](const char* key) {
    return static_cast<unsigned long long>(link[key].get<std::uint64_t>());
  };
  const std::string arrow = link["from"].get<std::string>() + " -> " + link["to"].get<std::string>();
  std::printf("  %-20s %9llu %9llu %9llu %9llu %9llu %9llu  %s\n", arrow.c_str(), number("sent"), number("delivered"),
              number("lost"), number("dropped"), number("duplicated"), number("reordered"),
              link["changed"].get<std::string>().c_str());
}

int show(const NetOptions& options) {
  const net::KnownNet known = value_or_throw(net::find_net(options.name));
  const net::NetSpec& spec = known.spec;
  Json json = Json::parse(value_or_throw(net::ask_net(spec.name, net::show_request)));
  json["name"] = spec.name;
  json["seed"] = spec.seed;
  json["relay_pid"] = known.relay;
  const std::string medium = json["medium"]["changed"];
  std::printf("net %s, seed %llu, relay is process %d%s%s\n", spec.name.c_str(),
              static_cast<unsigned long long>(spec.seed), known.relay, medium.empty() ? "" : ", ", medium.c_str());
  if (!json["medium"]["partition"].empty()) std::printf("partition %s\n", json["medium"]["partition"].dump().c_str());
  std::printf("  %-10s %-22s %-12s %s\n", "HOST", "NAMESPACE", "ADDRESS", "PROCESSES");
  for (std::uint32_t host = 0; host <= spec.modules; ++host) {
    const auto file = net::host_namespace(spec.name, host);
    std::printf("  %-10s %-22s %-12s %9zu\n", net::host_name(host).c_str(), file.filename().c_str(),
                net::host_address(host).c_str(), net::processes_in({file}).size());
  }
  std::printf("  %-20s %9s %9s %9s %9s %9s %9s\n", "LINK, in frames", "SENT", "DELIVERED", "LOST", "DROPPED",
              "DUPLICATE", "REORDERED");
  for (const Json& link : json["links"]) print_link(link);
  if (options.json_file.empty()) return 0;
  std::ofstream out(options.json_file);
  out << json.dump(2) << "\n";
  if (!out.flush()) throw BadInput{{"--json " + options.json_file + ": cannot be written"}};
  return 0;
}

int take_down(const NetOptions& options) {
  if (!options.name.empty()) ok_or_throw(net::check_name(options.name));
  const std::vector<net::KnownNet> nets = net::known_nets();
  const auto is_there = [&](const std::string& name) {
    return std::any_of(nets.begin(), nets.end(), [&](const auto& known) { return known.spec.name == name; });
  };
  if (nets.empty() || (!options.name.empty() && !is_there(options.name))) {
    std::printf("%s is up\n", options.name.empty() ? "no net" : ("no net " + options.name).c_str());
    return 0;
  }
  const std::string name = value_or_throw(net::find_net(options.name)).spec.name;
  ok_or_throw(net::take_down(name));
  std::printf("net %s is down\n", name.c_str());
  return 0;
}

void add_name(CLI::App& sub, NetOptions& options) {
  sub.add_option("--name", options.name, "which net (default: the one there is)");
}

}  // namespace

void add_net(CLI::App& app, Run& run) {
  const auto options = std::make_shared<NetOptions>();
  CLI::App* verb =
      app.add_subcommand("net", "module hosts on this machine, joined by a radio that is as bad as asked");
  CLI::App* up = verb->add_subcommand("up", "make hosts m1 to mN, and one called operator");
  up->add_option("N", options->spec.modules, "how many module hosts")
      ->required()
      ->check(CLI::Range(1U, net::modules_max));
  up->add_option("--name", options->spec.name, "of this net, where there are several")->capture_default_str();
  up->add_option("--seed", options->spec.seed, "of the radio's chances")->capture_default_str();
  up->add_flag("--foreground", options->foreground, "stay, until Ctrl-C or the end of whoever started it");
  on_chosen(*up, run, [options] { return bring_up(*options); });

  CLI::App* sub = verb->add_subcommand("set", "change links or the medium while frames fly");
  add_name(*sub, *options);
  sub->add_option("--from", options->from, "only links from this host");
  sub->add_option("--to", options->to, "only links to this host");
  sub->add_option("KEY=VALUE", options->words,
                  "of links: delay, jitter, hold (20ms); loss, duplication, reordering, burst_start, burst_end, "
                  "burst_loss (10%); cut (on); of the medium: rate (6Mbit/s), backlog (100ms), partition (m1+m2/m3); "
                  "or clear")
      ->required();
  on_chosen(*sub, run, [options] { return set(*options); });

  sub = verb->add_subcommand("show", "hosts, settings, and what became of the frames");
  add_name(*sub, *options);
  sub->add_option("--json", options->json_file, "write it to this file as well");
  on_chosen(*sub, run, [options] { return show(*options); });

  sub = verb->add_subcommand("down", "end a net and the processes in its hosts; nothing of it is left");
  add_name(*sub, *options);
  on_chosen(*sub, run, [options] { return take_down(*options); });
}

}  // namespace eciton::deploy
