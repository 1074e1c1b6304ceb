// The gate: compares what was measured with what was recorded or is wanted. Exit status 0: all reached; 1: some
// missed; 2: nothing could be said.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>

#include "benchmarks/gate/figures.hpp"
#include "benchmarks/gate/instruction_counts.hpp"

namespace {

using eciton::BadInput;
using eciton::value_or_throw;
using eciton::bench::Json;
using eciton::bench::Verdict;

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file) throw BadInput{{path + ": cannot be read: " + std::strerror(errno)}};
  return text.str();
}

Json json_of(const std::string& path) {
  Json json = Json::parse(text_of(path), nullptr, false);
  if (json.is_discarded()) throw BadInput{{path + ": is not JSON"}};
  return json;
}

int tell(const Verdict& verdict) {
  std::printf("%s", eciton::bench::to_text(verdict.table).c_str());
  for (const std::string& missed : verdict.missed) std::printf("missed: %s\n", missed.c_str());
  return verdict.missed.empty() ? 0 : 1;
}

struct Options {
  std::string callgrind, ran, baseline, results, figures;
  bool record = false;
};

int counts(const Options& options) {
  const auto counted = value_or_throw(eciton::bench::read_counts(text_of(options.ran), text_of(options.callgrind)));
  if (!options.record) return tell(eciton::bench::compare(counted, json_of(options.baseline)));
  const Json before = std::ifstream(options.baseline) ? json_of(options.baseline) : Json::object();
  std::ofstream file(options.baseline);
  file << eciton::bench::with_recorded(before, counted).dump(2) << "\n";
  if (!file.flush()) throw BadInput{{options.baseline + ": cannot be written: " + std::strerror(errno)}};
  std::printf("recorded %zu instruction counts of '%s' in %s\n", counted.per_step.size(), counted.built_with.c_str(),
              options.baseline.c_str());
  return 0;
}

int ratios(const Options& options) {
  return tell(value_or_throw(eciton::bench::judge_ratios(json_of(options.results),
                                                         json_of(options.figures).value("ratios", Json::array()))));
}

int metrics(const Options& options) {
  const Json measurement = json_of(options.results);
  const std::string command = measurement.value("command", "");
  const Json figures = json_of(options.figures).value("metrics", Json::object());
  if (!figures.contains(command)) {
    throw BadInput{{options.figures + ": no metrics of '" + command + "' are gated there"}};
  }
  return tell(value_or_throw(eciton::bench::judge_metrics(measurement, figures.at(command))));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares what was measured with what was recorded or is wanted", "eciton-bench-gate");
  app.require_subcommand(1);
  Options options;
  std::function<int()> chosen;
  const auto verb = [&](const char* name, const char* summary, int (*run)(const Options&)) {
    CLI::App* sub = app.add_subcommand(name, summary);
    sub->callback([&chosen, &options, run] { chosen = [&options, run] { return run(options); }; });
    return sub;
  };
  CLI::App* of_counts = verb("counts", "instructions per step against those recorded", counts);
  of_counts->add_option("--callgrind", options.callgrind, "callgrind's dumps")->required();
  of_counts->add_option("--ran", options.ran, "what eciton-bench-hot-path wrote")->required();
  of_counts->add_option("--baseline", options.baseline, "the recorded counts")->required();
  of_counts->add_flag("--record", options.record, "record them instead");
  for (CLI::App* sub : {verb("ratios", "ratios of Google Benchmark's times", ratios),
                        verb("metrics", "metrics of a measuring command", metrics)}) {
    sub->add_option("--results", options.results, "the JSON file of the run")->required();
    sub->add_option("--figures", options.figures, "the figures to reach")->required();
  }
  try {
    app.parse(argc, argv);
    return chosen();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const BadInput& bad) {
    std::fprintf(stderr, "eciton-bench-gate: %s\n", bad.error.message.c_str());
    return 2;
  }
}
