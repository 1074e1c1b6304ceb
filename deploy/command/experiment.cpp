// Options to a config, a run, a table for people and a JSON object for programs.
#include "deploy/command/experiment.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "deploy/command/measurement.hpp"
#include "deploy/experiments/experiment.hpp"
#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/report.hpp"
#include "deploy/hangup.hpp"

namespace eciton::deploy {
namespace {

struct Options {
  const Experiment* experiment = nullptr;
  std::uint64_t seed = 1;
  std::uint32_t trials = 20;
  std::uint32_t jobs = std::max(1u, std::thread::hardware_concurrency());
  std::string json;
  std::string report;  // a directory
  std::string break_what;
  std::vector<std::string> assignments;
};

/// Keys that a person gives without saying which part of the config they belong to.
std::string full_key(const std::string& assignment) {
  const std::string key = assignment.substr(0, assignment.find('='));
  for (const char* world : {"world", "wakes", "gust_N", "wind_N", "sensing", "noise", "floor"}) {
    if (key == world) return "world." + assignment;
  }
  if (key == "follower_modules" || key == "target_modules") return "docking." + assignment;
  if (key == "law") return "module.control." + assignment;
  return assignment;
}

ExperimentConfig make_config(const Options& options) {
  ConfigTree tree;
  for (const std::string& assignment : options.assignments) ok_or_throw(tree.set(full_key(assignment), "--set"));
  ExperimentConfig config;
  ok_or_throw(read_config(tree, config));
  config.seed = options.seed;
  config.trials = options.trials;
  config.break_what = options.break_what;
  return config;
}

Measurement make_measurement(const Options& options, const ExperimentConfig& config, const Figures& figures) {
  Measurement out;
  out.command = "experiment " + options.experiment->name;
  out.clock = "simulated";
  out.seed = options.seed;
  out.config = {{"trials", trials_of(*options.experiment, config)}, {"break", config.break_what},
                {"world", config.simulation.world.world},           {"sensing", config.simulation.world.sensing},
                {"gust_N", config.simulation.world.gust_N},         {"wakes", config.simulation.world.wakes},
                {"law", config.simulation.module.control.law},      {"set", options.assignments}};
  out.metrics = figures.metrics;
  out.series = figures.series;
  return out;
}

RunConditions conditions_of(const ExperimentConfig& config) {
  const hal::sim::WorldConfig& world = config.simulation.world;
  return {.sensing = world.sensing,
          .law = config.simulation.module.control.law,
          .wakes = world.wakes,
          .gust_N = world.gust_N};
}

/// In a shell's words: what holds more than plain letters is quoted.
std::string quoted(const std::string& word) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,/:";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Only what decides the figures.
std::string command_line_of(const Options& options) {
  std::string text = "eciton experiment " + options.experiment->name + " --seed " + std::to_string(options.seed);
  if (options.experiment->has_trials) text += " --trials " + std::to_string(options.trials);
  for (const std::string& assignment : options.assignments) text += " --set " + quoted(assignment);
  if (!options.break_what.empty()) text += " --break " + options.break_what;
  return text;
}

/// The page's path.
std::string report(const Options& options, const ExperimentConfig& config, const Figures& figures) {
  ReportInput input;
  input.experiment = options.experiment->name;
  input.summary = options.experiment->summary;
  input.command_line = command_line_of(options);
  input.seed = options.seed;
  input.conditions = conditions_of(config);
  const Measurement measured = make_measurement(options, config, figures);
  for (const auto& [name, value] : measured.config.items()) {
    if (name != "set") input.config.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  input.metrics = figures.metrics;
  input.plots = options.experiment->plots == nullptr ? series_plots(figures) : options.experiment->plots(figures);
  input.pictures = render_stills(figures.stills, make_airframe(config.simulation.module), {});
  if (!input.pictures.notice.empty()) std::fprintf(stderr, "%s\n", input.pictures.notice.c_str());
  return value_or_throw(write_report(options.report, input));
}

void print(const Options& options, const ExperimentConfig& config, const Figures& figures) {
  for (const JudgedMetric& row : judge(options.experiment->name, conditions_of(config), figures.metrics)) {
    std::string beside = row.paper.empty() ? "" : "paper " + row.paper;
    if (!row.bar.empty()) beside += (beside.empty() ? "bar " : "; bar ") + row.bar;
    if (row.verdict != Verdict::none) beside += ": " + to_text(row.verdict);
    std::printf("  %-28s %-12.6g%s%s\n", row.metric.c_str(), figures.metrics.at(row.metric),
                beside.empty() ? "" : "  ", beside.c_str());
  }
}

int run(const Options& options) {
  ok_or_throw(check_measurement_file(options.json));
  ok_or_throw(check_report_directory(options.report));
  const ExperimentConfig config = make_config(options);
  const IgnoredSignals ignored({SIGPIPE});  // the figures go to their file also when nobody reads the table
  const bool live = ::isatty(STDERR_FILENO) != 0;
  const auto began = std::chrono::steady_clock::now();
  const Figures figures = run_experiment(*options.experiment, config, options.jobs, [&](std::uint32_t finished) {
    if (live)
      std::fprintf(stderr, "\r%s: %u of %u", options.experiment->name.c_str(), finished,
                   trials_of(*options.experiment, config));
  });
  if (live) std::fprintf(stderr, "\r\033[K");
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::printf("%s, seed %llu, simulated clock, %.1f s of wall clock in %u processes\n",
              options.experiment->name.c_str(), static_cast<unsigned long long>(options.seed), wall_s, options.jobs);
  print(options, config, figures);
  if (!options.json.empty()) ok_or_throw(write_measurement(options.json, make_measurement(options, config, figures)));
  if (!options.report.empty()) std::printf("report: %s\n", report(options, config, figures).c_str());
  return 0;
}

void add_one(CLI::App& parent, Run& run_chosen, const Experiment& experiment) {
  auto options = std::make_shared<Options>();
  options->experiment = &experiment;
  CLI::App& verb = *parent.add_subcommand(experiment.name, experiment.summary);
  verb.add_option("--seed", options->seed, "the same seed gives the same bits")->capture_default_str();
  if (experiment.has_trials) {
    verb.add_option("--trials", options->trials)->check(CLI::Range(1u, 10000u))->capture_default_str();
  }
  verb.add_option("--jobs", options->jobs, "trials at a time")->check(CLI::Range(1u, 64u))->capture_default_str();
  verb.add_option("--json", options->json, "file for the figures");
  verb.add_option("--report", options->report, "directory for a page with plots and stills, and each as a file");
  verb.add_option(
          "--set", options->assignments,
          "key=value: gust_N, sensing, world, wakes, law, follower_modules, target_modules, module.…, radio_link.…")
      ->allow_extra_args(false);
  if (!experiment.breaks.empty()) {
    verb.add_option("--break", options->break_what, "break something: a control that must fail")
        ->check(CLI::IsMember(experiment.breaks));
  }
  on_chosen(verb, run_chosen, [options] { return run(*options); });
}

}  // namespace

void add_experiment(CLI::App& app, Run& run_chosen) {
  CLI::App& verb = *app.add_subcommand("experiment", "Runs an experiment in simulation");
  verb.require_subcommand(1);
  for (const Experiment& experiment : experiments()) add_one(verb, run_chosen, experiment);
}

}  // namespace eciton::deploy
