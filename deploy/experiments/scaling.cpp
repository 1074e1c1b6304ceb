// scaling: chains of one to eight modules. How well the base flies a path, and how long a contact-wrench law takes
// from a preload of 3 N and 0.3 Nm in every link to below 0.3 N and 0.05 Nm for good. Fig. S3 of LEGION.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "core/robot/arrays.hpp"
#include "deploy/experiments/branch.hpp"
#include "deploy/experiments/chain_flight.hpp"
#include "deploy/experiments/path_reference.hpp"
#include "deploy/experiments/report/plots.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t modules_most = 8;
constexpr double preload_N = 3, preload_Nm = 0.3;
constexpr double settled_N = 0.3, settled_Nm = 0.05;
constexpr double preload_s = 4;
constexpr double watch_local_s = 12, watch_paper_s = 60;
constexpr double link_lever_m = 0.4;  // from the middle of a member to its links
constexpr double reserve_Nm = 1.5;    // of a member about each axis, well within its rotors' reach at hover
constexpr double rest_s = 30;         // after the last docking: a long chain relaxes into its shape in about 15 s
constexpr double path_m = 0.4, path_speed_m_s = 0.3, path_limit_s = 60;

/// One way to set the paper's law; authors' first: 40 Hz and 0.1.
struct PaperSetting {
  double gain, rate_Hz;
};
constexpr std::array paper_grid{PaperSetting{0.1, 40}, PaperSetting{0.4, 10}, PaperSetting{0.2, 10},
                                PaperSetting{0.8, 10}, PaperSetting{0.2, 20}, PaperSetting{0.4, 20},
                                PaperSetting{0.1, 20}, PaperSetting{0.2, 40}};

std::uint32_t modules_of(const ExperimentConfig& config, std::uint32_t trial) {
  return config.modules > 0 ? config.modules : trial + 1;
}

std::uint32_t runs(const ExperimentConfig& config) { return config.modules > 0 ? 1 : modules_most; }

/// A closed path around home with its attitude moving a little: short beside a long chain's reach.
std::vector<robot::Pose> path_about(const robot::Pose& home) {
  std::vector<robot::Pose> waypoints;
  constexpr int count = 12;
  for (int k = 1; k <= count; ++k) {
    const double u = 2 * std::numbers::pi * k / count;
    const robot::Vector3 offset(path_m * std::sin(u), path_m * std::sin(2 * u) / 2, 0.15 * std::sin(u));
    waypoints.push_back({home.p + offset, robot::exp_so3({0, 0, 0.1 * std::sin(u)})});
  }
  return waypoints;
}

/// The first module is the base of every chain, however long, so that lengths are compared and not what the seed has
/// drawn for one module and another: the others stand by turns ahead of it and behind.
std::vector<hal::sim::ModuleStart> row_about_the_base(std::uint32_t modules) {
  std::vector<hal::sim::ModuleStart> row;
  for (std::uint32_t k = 0; k < modules; ++k) {
    const double place = k % 2 == 1 ? (k + 1) / 2 : -static_cast<double>(k / 2);
    row.push_back({.id = k + 1, .p_WB_m = {row_spacing_m * place, 0, 0}});
  }
  return row;
}

/// Moment about a member's middle that the rotors must make for the wanted wrenches of the links behind and ahead.
robot::Vector3 member_moment_Nm(const msg::DesiredContact& behind, const msg::DesiredContact& ahead) {
  const robot::Vector3 force_N = robot::vector(behind.force_M_N) + robot::vector(ahead.force_M_N);
  return robot::Vector3(link_lever_m, 0, 0).cross(force_N) + robot::vector(ahead.moment_M_Nm) -
         robot::vector(behind.moment_M_Nm);
}

/// Forces and moments of one size in directions of their own, drawn from the seed; again where the rotors of the
/// member between two links could not make up for both.
std::vector<msg::DesiredContact> preload(std::uint64_t seed, std::size_t links) {
  std::mt19937_64 generator(seed);
  const auto direction = [&] {
    const auto uniform = [&] { return 2 * (static_cast<double>(generator() >> 11) * 0x1.0p-53) - 1; };
    robot::Vector3 v(uniform(), uniform(), uniform());
    return robot::Vector3(v.normalized());
  };
  std::vector<msg::DesiredContact> out(links);
  for (std::size_t k = 0; k < links; ++k) {
    do {
      out[k].force_M_N = robot::array(robot::Vector3(preload_N * direction()));
      out[k].moment_M_Nm = robot::array(robot::Vector3(preload_Nm * direction()));
    } while (k > 0 && member_moment_Nm(out[k - 1], out[k]).cwiseAbs().maxCoeff() > reserve_Nm);
  }
  return out;
}

/// From now, when the wanted contact wrenches become zero, until the links are settled for good; the watch's length
/// when they never are.
Figures converge(ChainFlight& flight, double watch_s) {
  Figures out;
  const double start_s = flight.simulation().elapsed_s();
  flight.pilot().op().contact(flight.first(), {});
  double last_s = 0;
  while (flight.simulation().elapsed_s() < start_s + watch_s) {
    flight.pilot().wait(0.02);
    const Recorder& now = flight.recorder();
    const double at_s = flight.simulation().elapsed_s() - start_s;
    if (now.contact_force_N() >= settled_N || now.contact_torque_Nm() >= settled_Nm) last_s = at_s;
    out.series["settling_time_s"].push_back(at_s);
    out.series["settling_force_N"].push_back(now.contact_force_N());
    out.series["settling_torque_Nm"].push_back(now.contact_torque_Nm());
  }
  out.metrics["convergence_s"] = last_s;
  return out;
}

Figures converge_by_paper(ChainFlight& flight, const PaperSetting& setting) {
  const auto paper = [&](ModuleConfig& module) {
    module.control.law = "paper";
    module.control.paper_gain = setting.gain;
    module.control.paper_rate_Hz = setting.rate_Hz;
    module.control.integrate_all = true;  // as its authors have it; the base alone takes it longer
  };
  for (std::size_t k = 0; k < flight.size(); ++k) flight.simulation().replace(k, "control", paper);
  return converge(flight, watch_paper_s);
}

void note_convergence(ChainFlight& flight, const ExperimentConfig& config, Figures& out) {
  const std::vector<msg::DesiredContact> wanted = preload(config.seed, flight.size() - 1);
  flight.pilot().expect(flight.pilot().op().contact(flight.first(), wanted), 10);
  flight.pilot().wait(preload_s);
  out.metrics["preload_force_N"] = flight.recorder().contact_force_N();
  // From one and the same moment on, once for each setting.
  double best_s = watch_paper_s;
  std::size_t best = 0;
  for (std::size_t k = 0; k < (config.paper_grid ? paper_grid.size() : 0); ++k) {
    const Figures one = in_a_branch([&] { return converge_by_paper(flight, paper_grid[k]); });
    out.series["convergence_s_paper_grid"].push_back(one.metrics.at("convergence_s"));
    if (one.metrics.at("convergence_s") < best_s) {
      best_s = one.metrics.at("convergence_s");
      best = k;
    }
  }
  out.metrics["convergence_s_paper"] = best_s;
  out.metrics["paper_gain"] = paper_grid[best].gain;
  out.metrics["paper_rate_Hz"] = paper_grid[best].rate_Hz;
  const Figures local = converge(flight, watch_local_s);
  out.metrics["convergence_s_local"] = local.metrics.at("convergence_s");
  out.series.insert(local.series.begin(), local.series.end());
}

/// A trial is a number of modules.
Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  ExperimentConfig still = config;
  still.simulation.world.wakes = false;
  still.simulation.module.control.law = "local";
  // The same gains for all lengths: a chain of one flies as a member does.
  control::ControlConfig& control = still.simulation.module.control;
  if (modules_of(config, trial) == 1) control.stiffness_alone = control.stiffness;
  still.simulation.world.modules = row_about_the_base(modules_of(config, trial));
  ChainFlight flight(still, 0, modules_of(config, trial));
  flight.assemble();
  flight.pilot().wait(rest_s);
  Figures out;
  const bool flown = fly_path(flight, path_about(flight.home()), path_speed_m_s, path_limit_s);
  const FlightFigures f = flight.recorder().figures();
  out.metrics = {{"modules", static_cast<double>(flight.size())},
                 {"position_error_m_mean", f.position_error_m_mean},
                 {"attitude_error_rad_mean", f.attitude_error_rad_mean},
                 {"flown", flown ? 1.0 : 0.0},
                 {"convergence_s_local", 0},
                 {"convergence_s_paper", 0}};
  out.series["position_error_m"] = flight.recorder().series().at("position_error_m");
  out.series["attitude_error_rad"] = flight.recorder().series().at("attitude_error_rad");
  if (flight.size() > 1) note_convergence(flight, config, out);
  out.metrics["convergence_s"] =
      out.metrics["convergence_s_" +
                  std::string(config.simulation.module.control.law == "paper" ? "paper" : "local")];
  return out;
}

Figures summarise(const std::vector<Figures>& trials) {
  Figures all;
  if (trials.size() == 1) {
    all = trials.front();
  } else {
    for (const Figures& one : trials) {
      const std::string number = "_" + std::to_string(static_cast<int>(one.metrics.at("modules")));
      for (const auto& [name, value] : one.metrics) {
        if (name != "modules") all.metrics[name + number] = value;
        all.metrics[name] = std::max(all.metrics[name], value);  // the worst of them
      }
    }
  }
  for (const Figures& one : trials) {
    const double modules = one.metrics.at("modules");
    all.series["modules"].push_back(modules);
    for (const char* law : {"local", "paper"}) {
      const std::string name = std::string("convergence_s_") + law;
      all.series[name].push_back(one.metrics.at(name));
    }
    for (const char* error : {"position_error_m", "attitude_error_rad"}) {
      all.series[std::string(error) + "_local"].push_back(one.metrics.at(std::string(error) + "_mean"));
    }
    const std::vector<double>& position_m = one.series.at("position_error_m");
    const std::vector<double>& attitude_rad = one.series.at("attitude_error_rad");
    all.series["error_modules"].insert(all.series["error_modules"].end(), position_m.size(), modules);
    all.series["error_position_m"].insert(all.series["error_position_m"].end(), position_m.begin(), position_m.end());
    all.series["error_attitude_rad"].insert(all.series["error_attitude_rad"].end(), attitude_rad.begin(),
                                            attitude_rad.end());
  }
  return all;
}

}  // namespace

const Experiment scaling_experiment{.name = "scaling",
                                    .summary = "chains of one to eight modules: tracking, and how fast laws converge",
                                    .modules = 8,
                                    .has_trials = false,
                                    .runs = &runs,
                                    .breaks = {},
                                    .run_trial = &run_trial,
                                    .summarise = &summarise,
                                    .plots = &scaling_plots};

}  // namespace eciton::deploy
