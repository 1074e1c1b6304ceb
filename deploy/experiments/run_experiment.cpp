// Trials in processes of their own: the simulated network is one per process, and a trial that crashes takes
// nothing with it.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "deploy/experiments/branch.hpp"
#include "deploy/experiments/experiment.hpp"

namespace eciton::deploy {
namespace {

using Json = nlohmann::json;

struct Worker {
  pid_t pid;
  int pipe;
  std::uint32_t trial;
};

void write_all(int fd, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t wrote = ::write(fd, text.data() + at, text.size() - at);
    if (wrote <= 0) return;
    at += static_cast<std::size_t>(wrote);
  }
}

/// In the child: the figures, or what went wrong, as JSON. Doubles survive to the bit.
std::string run_to_text(const std::function<Figures()>& run) {
  Json out;
  try {
    const Figures figures = run();
    out["metrics"] = figures.metrics;
    out["series"] = figures.series;
    for (const Still& still : figures.stills) {
      out["stills"].push_back({{"title", still.title}, {"time_s", still.time_s}, {"posture", still.posture}});
    }
  } catch (const BadInput& bad) {
    out["bad_input"] = bad.error.message;
  } catch (const std::exception& e) {
    out["error"] = e.what();
  }
  return out.dump();
}

Worker start(const std::function<Figures()>& run, std::uint32_t trial) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe for a trial's process: too many open files");
  std::fflush(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) throw std::runtime_error("no process for a trial: the system refuses to fork");
  if (pid == 0) {
    // Whatever ends the experiment, a hang-up too, ends its trials.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // it died before the call above
    ::close(ends[0]);
    write_all(ends[1], run_to_text(run));
    ::_exit(0);
  }
  ::close(ends[1]);
  return {pid, ends[0], trial};
}

Figures finish(const Worker& worker) {
  std::string text;
  char block[4096];
  for (ssize_t got = 0; (got = ::read(worker.pipe, block, sizeof block)) > 0;) {
    text.append(block, static_cast<std::size_t>(got));
  }
  ::close(worker.pipe);
  int status = 0;
  ::waitpid(worker.pid, &status, 0);
  const std::string which = "trial " + std::to_string(worker.trial);
  const Json out = Json::parse(text, nullptr, false);
  if (out.is_discarded()) throw std::runtime_error(which + " ended without a result");
  if (out.contains("bad_input")) throw BadInput{{out["bad_input"].get<std::string>()}};
  if (out.contains("error")) throw std::runtime_error(which + ": " + out["error"].get<std::string>());
  Figures figures;
  figures.metrics = out["metrics"].get<std::map<std::string, double>>();
  figures.series = out["series"].get<std::map<std::string, std::vector<double>>>();
  for (const Json& still : out.value("stills", Json::array())) {
    figures.stills.push_back({.title = still["title"].get<std::string>(),
                              .time_s = still["time_s"].get<double>(),
                              .posture = still["posture"].get<std::vector<double>>()});
  }
  return figures;
}

}  // namespace

Figures only_trial(const std::vector<Figures>& trials) { return trials.front(); }

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> all{hover_experiment,    tracking_experiment, docking_experiment,
                                           morph_experiment,    ablation_experiment, scaling_experiment,
                                           wind_experiment,     release_experiment,  silence_experiment,
                                           crossing_experiment, forest_experiment};
  return all;
}

std::uint64_t trial_seed(std::uint64_t seed, std::uint32_t trial) {
  // splitmix64, so that neighbouring seeds and trials share nothing.
  std::uint64_t z = seed * 0x9e3779b97f4a7c15ull + (trial + 1) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

std::uint32_t trials_of(const Experiment& experiment, const ExperimentConfig& config) {
  if (experiment.has_trials) return config.trials;
  return experiment.runs != nullptr ? experiment.runs(config) : 1;
}

Figures in_a_branch(const std::function<Figures()>& run) { return finish(start(run, 0)); }

Figures run_experiment(const Experiment& experiment, const ExperimentConfig& config, std::uint32_t jobs,
                       const std::function<void(std::uint32_t)>& progress) {
  const std::uint32_t trials = trials_of(experiment, config);
  std::vector<Figures> results(trials);
  std::vector<Worker> running;
  std::uint32_t next = 0, finished = 0;
  while (finished < trials) {
    while (next < trials && running.size() < jobs) {
      running.push_back(start([&, trial = next] { return experiment.run_trial(config, trial); }, next));
      ++next;
    }
    // The oldest first: trials take about the same time.
    results[running.front().trial] = finish(running.front());
    running.erase(running.begin());
    progress(++finished);
  }
  return experiment.summarise(results);
}

}  // namespace eciton::deploy
