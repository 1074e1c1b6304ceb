// Each verb makes goals for an operator on the swarm ring and follows them to their end.
#include "deploy/command/fly.hpp"

#include <poll.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <set>

#include "core/base/wall_clock.hpp"
#include "core/bus/plugin_loader.hpp"
#include "deploy/operator/follow.hpp"
#include "deploy/operator/operator.hpp"

namespace eciton::deploy {
namespace {

using Goals = std::vector<std::uint64_t>;

struct FlyOptions {
  std::uint32_t swarm_domain = 1;
  std::string network_interface = "lo";
  std::vector<std::string> peers;
  std::string vendor;
  double timeout_s = 60;

  std::vector<std::uint32_t> ids;
  std::uint32_t first = 0, second = 0;
  std::array<double, 3> p_WM_m{};
  std::vector<double> angles_rad;
  double height_m = 1.5;
  double yaw_deg = 0;
  double speed_m_s = 0;
  double rate_rad_s = 0;
  bool all = false;
};
using Options = std::shared_ptr<FlyOptions>;

bus::ParticipantConfig swarm_config(const FlyOptions& options) {
  return {.vendor = options.vendor.empty() ? bus::chosen_vendor("cyclonedds") : options.vendor,
          .domain = options.swarm_domain,
          .name = "operator",
          .network_interface = options.network_interface,
          .peers = options.peers};
}

int exit_status(Followed followed) {
  if (followed == Followed::interrupted) return 130;
  return followed == Followed::succeeded ? 0 : 1;
}

int fly(const FlyOptions& options, const std::function<Goals(Operator&)>& make_goals) {
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  bus::Participant swarm(swarm_config(options));
  Operator op(swarm);
  const Goals goals = make_goals(op);
  return exit_status(follow(op, swarm, goals, {.timeout = from_s(options.timeout_s)}, stop));
}

/// A stop waits for nothing: it goes to every module as soon as that is heard, and again until it answers.
int stop_all(const FlyOptions& options) {
  // Idle beacons come every two seconds, should nothing else be heard of a module.
  constexpr Duration listening = std::chrono::milliseconds(2500), patience = std::chrono::seconds(8);
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  bus::Participant swarm(swarm_config(options));
  Operator op(swarm);
  std::map<std::uint32_t, std::uint64_t> goals;
  std::set<std::uint32_t> told;
  const Duration begin = monotonic_now();
  bool all_over = false;
  while (!stop.requested()) {
    op.poll(wall_now());
    all_over = true;
    for (const auto& [id, module] : op.fleet().modules()) {
      if (!goals.contains(id)) goals[id] = op.stop(id);
      const GoalReport& report = *op.report(goals[id]);
      if (!is_over(report.progress)) {
        all_over = false;
      } else if (told.insert(id).second) {
        std::printf("%s\n", describe(report).c_str());
        std::fflush(stdout);
      }
    }
    const Duration waited = monotonic_now() - begin;
    if (waited > patience || (all_over && waited > listening)) break;
    swarm.waker().wait(std::chrono::milliseconds(10));
  }
  if (goals.empty()) {
    std::fprintf(stderr, "stop: no module is heard on the swarm ring (domain %u on %s)\n", options.swarm_domain,
                 options.network_interface.c_str());
    return 1;
  }
  bool all_well = true;
  for (const auto& [id, goal] : goals) {
    const GoalReport& report = *op.report(goal);
    if (!is_over(report.progress)) std::fprintf(stderr, "%s: %s\n", report.what.c_str(), report.reason.c_str());
    all_well = all_well && report.progress == GoalProgress::succeeded;
  }
  if (stop.requested()) return 130;
  return all_well ? 0 : 1;
}

const auto module_id = CLI::Range(1, 90);

void add_swarm_options(CLI::App& sub, FlyOptions& options) {
  sub.add_option("--swarm-domain", options.swarm_domain, "DDS domain of the swarm ring (default: 1)")
      ->check(CLI::Range(0, 231));
  sub.add_option("--interface", options.network_interface, "network interface of the swarm ring (default: lo)");
  sub.add_option("--peer", options.peers, "address of a module, where there is no multicast")
      ->allow_extra_args(false);
  sub.add_option("--dds", options.vendor, "DDS vendor: cyclonedds or fastdds (default: ECITON_DDS, else cyclonedds)");
}

CLI::App* add_verb(CLI::App& app, const char* name, const char* purpose, const Options& options, double timeout_s) {
  CLI::App* sub = app.add_subcommand(name, purpose);
  options->timeout_s = timeout_s;
  add_swarm_options(*sub, *options);
  sub->add_option("--timeout", options->timeout_s, "give up after this long on the modules' clock, s")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  return sub;
}

/// A verb for one or several modules, which do it side by side.
CLI::App* add_for_each(CLI::App& app, Run& run, const char* name, const char* purpose, double timeout_s,
                       const Options& options,
                       std::function<std::uint64_t(Operator&, const FlyOptions&, std::uint32_t)> make) {
  CLI::App* sub = add_verb(app, name, purpose, options, timeout_s);
  sub->add_option("ID", options->ids, "modules")->required()->check(module_id);
  on_chosen(*sub, run, [options, make = std::move(make)] {
    return fly(*options, [&](Operator& op) {
      Goals goals;
      for (const std::uint32_t id : std::set(options->ids.begin(), options->ids.end()))
        goals.push_back(make(op, *options, id));
      return goals;
    });
  });
  return sub;
}

void add_pair(CLI::App& app, Run& run, const char* name, const char* purpose, const char* first, const char* second,
              std::uint64_t (Operator::*make)(std::uint32_t, std::uint32_t)) {
  const auto options = std::make_shared<FlyOptions>();
  CLI::App* sub = add_verb(app, name, purpose, options, 60);
  sub->add_option(first, options->first, "a module")->required()->check(module_id);
  sub->add_option(second, options->second, "another module")->required()->check(module_id);
  on_chosen(*sub, run, [options, make, name = std::string(name)] {
    if (options->first == options->second) {
      throw BadInput{
          {"module " + std::to_string(options->first) + " twice; '" + name + "' needs two different modules"}};
    }
    return fly(*options, [&](Operator& op) { return Goals{(op.*make)(options->first, options->second)}; });
  });
}

void add_takeoff(CLI::App& app, Run& run) {
  const auto options = std::make_shared<FlyOptions>();
  CLI::App* sub =
      add_for_each(app, run, "takeoff", "climb to a height and hover", 30, options,
                   [](Operator& op, const FlyOptions& o, std::uint32_t id) { return op.take_off(id, o.height_m); });
  sub->add_option("--height", options->height_m, "of the world, m")
      ->check(CLI::Range(0.2, 100.0))
      ->capture_default_str();
}

void add_goto(CLI::App& app, Run& run) {
  const auto options = std::make_shared<FlyOptions>();
  CLI::App* sub = add_verb(app, "goto", "fly to a point; a member of a chain takes the chain along", options, 120);
  sub->add_option("ID", options->first, "a module")->required()->check(module_id);
  sub->add_option("X", options->p_WM_m[0], "m, in the world's axes")->required()->check(CLI::Range(-1e4, 1e4));
  sub->add_option("Y", options->p_WM_m[1], "m")->required()->check(CLI::Range(-1e4, 1e4));
  sub->add_option("Z", options->p_WM_m[2], "m, up")->required()->check(CLI::Range(-1e3, 1e4));
  sub->add_option("--yaw", options->yaw_deg, "degrees")->check(CLI::Range(-360.0, 360.0))->capture_default_str();
  sub->add_option("--speed", options->speed_m_s, "m/s (default: the module's)")->check(CLI::Range(0.01, 10.0));
  on_chosen(*sub, run, [options] {
    return fly(*options, [&](Operator& op) {
      return Goals{
          op.go_to(options->first, options->p_WM_m, options->yaw_deg * std::numbers::pi / 180, options->speed_m_s)};
    });
  });
}

void add_morph(CLI::App& app, Run& run) {
  const auto options = std::make_shared<FlyOptions>();
  CLI::App* sub = add_verb(app, "morph", "bring the joints of a chain to angles", options, 120);
  sub->add_option("ID", options->first, "any member")->required()->check(module_id);
  sub->add_option("ANGLE", options->angles_rad, "rad, member by member in the order of the chain: yaw, pitch")
      ->required()
      ->check(CLI::Range(-3.2, 3.2));
  sub->add_option("--rate", options->rate_rad_s, "greatest joint speed, rad/s (default: the module's)")
      ->check(CLI::Range(0.001, 5.0));
  on_chosen(*sub, run, [options] {
    return fly(*options, [&](Operator& op) {
      return Goals{op.morph(options->first, options->angles_rad, options->rate_rad_s)};
    });
  });
}

void add_stop(CLI::App& app, Run& run) {
  const auto options = std::make_shared<FlyOptions>();
  CLI::App* sub = add_verb(app, "stop", "motors off at once, in any state (to come down gently: land)", options, 5);
  auto* ids = sub->add_option("ID", options->ids, "modules")->check(module_id);
  sub->add_flag("--all", options->all, "every module that is heard")->excludes(ids);
  on_chosen(*sub, run, [options] {
    if (options->all) return stop_all(*options);
    if (options->ids.empty()) throw BadInput{{"no module is named; expected ids, or --all"}};
    return fly(*options, [&](Operator& op) {
      Goals goals;
      for (const std::uint32_t id : options->ids) goals.push_back(op.stop(id));
      return goals;
    });
  });
}

}  // namespace

void add_fly(CLI::App& app, Run& run) {
  add_for_each(app, run, "arm", "power the rotors, idling", 10, std::make_shared<FlyOptions>(),
               [](Operator& op, const FlyOptions&, std::uint32_t id) { return op.arm(id); });
  add_for_each(app, run, "disarm", "rotors off, on the ground", 10, std::make_shared<FlyOptions>(),
               [](Operator& op, const FlyOptions&, std::uint32_t id) { return op.disarm(id); });
  add_takeoff(app, run);
  add_goto(app, run);
  add_pair(app, run, "dock", "link a module to another, in flight", "FOLLOWER", "TARGET", &Operator::dock);
  add_morph(app, run);
  add_pair(app, run, "undock", "open the link between two modules", "ID", "PEER", &Operator::undock);
  add_for_each(app, run, "land", "come down gently", 60, std::make_shared<FlyOptions>(),
               [](Operator& op, const FlyOptions&, std::uint32_t id) { return op.land(id); });
  add_stop(app, run);
}

}  // namespace eciton::deploy
