// Children under a supervisor that is never asked to restart them.
#include "benchmarks/jitter/background.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "benchmarks/jitter/cyclictest.hpp"
#include "benchmarks/jitter/jitter.hpp"
#include "core/bus/plugin_loader.hpp"
#include "deploy/supervisor/supervisor.hpp"

namespace eciton::bench {
namespace {

namespace fs = std::filesystem;

std::vector<deploy::ChildSpec> programs(const std::string& condition, const JitterOptions& options) {
  std::vector<deploy::ChildSpec> specs;
  if (condition == "loaded") {
    const std::string processors = std::to_string(std::max(1l, ::sysconf(_SC_NPROCESSORS_ONLN)));
    specs.push_back({.name = "stress-ng",
                     .arguments = {value_or_throw(find_tool("stress-ng", "stress-ng")), "--cpu", processors, "--io",
                                   "1", "--vm", "1", "--vm-bytes", "64M", "--quiet", "--temp-path", "/tmp"}});
  }
  if (condition == "traffic") {
    for (const char* role : {"--read", "--write"}) {
      specs.push_back({.name = role + 2,
                       .arguments = {options.programs / "eciton-bench-traffic", role, "--dds", options.dds,
                                     "--domain", std::to_string(options.domain)}});
    }
  }
  return specs;
}

}  // namespace

Status Background::check(const std::string& condition, const JitterOptions& options) {
  if (condition == "idle") return ok();
  if (condition == "loaded") {
    const auto tool = find_tool("stress-ng", "stress-ng");
    return tool ? ok() : Status(tool.error());
  }
  if (condition != "traffic") {
    return Error{"no condition '" + condition + "'; expected idle, loaded or traffic"};
  }
  const fs::path program = options.programs / "eciton-bench-traffic";
  if (!fs::exists(program))
    return Error{"program " + program.string() + " is not there; build it, or give its directory"};
  return ok();
}

eciton::Result<std::unique_ptr<Background>> Background::start(const std::string& condition,
                                                              const JitterOptions& options) {
  std::unique_ptr<Background> background(new Background);
  background->log_directory_ = fs::temp_directory_path() / ("eciton-jitter-" + std::to_string(::getpid()));
  fs::create_directories(background->log_directory_);
  deploy::SupervisorConfig config{.log_directory = background->log_directory_};
  background->programs_ = std::make_unique<deploy::Supervisor>(config);
  for (const deploy::ChildSpec& spec : programs(condition, options)) {
    if (const Status started = background->programs_->start(spec); !started) return started.error();
  }
  return background;
}

Background::~Background() {
  if (programs_) programs_->stop_all();
  std::error_code ignored;
  if (!log_directory_.empty()) fs::remove_all(log_directory_, ignored);
}

std::string Background::trouble() {
  std::string text;
  programs_->check([&](const deploy::ChildReport& report) {
    text += (text.empty() ? "" : "; ") + report.name + " ended with " +
            (report.last_end ? report.last_end->text() : "nothing") +
            (report.last_words.empty() ? "" : ": " + report.last_words);
  });
  return text;
}

std::optional<Duration> parse_stolen(std::string_view proc_stat, long ticks_per_s) {
  std::istringstream line{std::string(proc_stat.substr(0, proc_stat.find('\n')))};
  std::string cpu;
  std::int64_t ticks = 0;
  if (!(line >> cpu) || cpu != "cpu") return std::nullopt;
  constexpr int steal_place = 8;  // after user, nice, system, idle, iowait, irq, softirq
  for (int place = 1; place <= steal_place; ++place) {
    if (!(line >> ticks)) return std::nullopt;
  }
  return Duration(std::chrono::seconds(1)) * ticks / ticks_per_s;
}

std::optional<Duration> stolen() {
  std::ifstream file("/proc/stat");
  std::string line;
  std::getline(file, line);
  return parse_stolen(line, ::sysconf(_SC_CLK_TCK));
}

}  // namespace eciton::bench
