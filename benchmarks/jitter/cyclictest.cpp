// Started as any child, its output read when it has ended.
#include "benchmarks/jitter/cyclictest.hpp"

#include <unistd.h>

#include <charconv>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/wall_clock.hpp"
#include "deploy/supervisor/child_process.hpp"
#include "deploy/supervisor/supervisor.hpp"

namespace eciton::bench {
namespace {

namespace fs = std::filesystem;

template <class Number>
bool take_number(std::string_view& text, Number& number) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take_colon(std::string_view& text) {
  if (!text.starts_with(':')) return false;
  text.remove_prefix(1);
  return true;
}

std::string read_all(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A file that goes with its owner.
struct ScratchFile {
  fs::path path = fs::temp_directory_path() / ("eciton-cyclictest-" + std::to_string(::getpid()));
  ScratchFile() { fs::remove(path); }
  ~ScratchFile() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

eciton::Result<std::string> find_tool(const std::string& program, const std::string& package) {
  const char* search = std::getenv("PATH");
  std::istringstream directories(search != nullptr ? search : "/usr/bin:/bin");
  for (std::string directory; std::getline(directories, directory, ':');) {
    const std::string path = directory + "/" + program;
    if (::access(path.c_str(), X_OK) == 0) return path;
  }
  return Error{"program " + program + " is not on the PATH; install it: apt install " + package};
}

std::vector<double> parse_cyclictest_us(std::string_view output) {
  std::vector<double> late_us;
  while (!output.empty()) {
    const std::size_t end = std::min(output.find('\n'), output.size());
    std::string_view line = output.substr(0, end);
    output.remove_prefix(std::min(end + 1, output.size()));
    long thread = 0, cycle = 0, late_ns = 0;
    if (take_number(line, thread) && take_colon(line) && take_number(line, cycle) && take_colon(line) &&
        take_number(line, late_ns)) {
      late_us.push_back(static_cast<double>(late_ns) * 1e-3);
    }
  }
  return late_us;
}

eciton::Result<std::vector<double>> run_cyclictest(const std::string& program, const CyclictestRun& run,
                                                   const runtime::StopFlag& stop) {
  const ScratchFile output;
  const auto cycles = static_cast<long>(run.seconds / to_s(run.period));
  std::vector<std::string> arguments{program,
                                     "--default-system",
                                     "--mlockall",
                                     "--quiet",
                                     "--verbose",
                                     "--nsecs",
                                     "--distance=0",
                                     "--interval=" + std::to_string(run.period / std::chrono::microseconds(1)),
                                     "--loops=" + std::to_string(cycles)};
  if (run.realtime_priority > 0) {
    arguments.insert(arguments.end(), {"--policy=fifo", "--priority=" + std::to_string(run.realtime_priority)});
  }
  auto child = deploy::ChildProcess::start({.arguments = arguments, .log_file = output.path});
  if (!child) return child.error();
  const Duration patience_end = monotonic_now() + from_s(2 * run.seconds + 10);
  bool interrupted = false;
  while (true) {
    if (child->take_end()) break;
    const Duration left = patience_end - monotonic_now();
    if (left <= Duration::zero()) return Error{"cyclictest did not end in time"};
    if (stop.requested() && !interrupted) child->signal(SIGINT);  // it prints what it has
    interrupted = interrupted || stop.requested();
    std::vector<pollfd> wait{{child->file_descriptor(), POLLIN, 0}};
    if (!interrupted) wait.push_back({stop.file_descriptor(), POLLIN, 0});
    deploy::wait_for(wait, left);
  }
  std::vector<double> late_us = parse_cyclictest_us(read_all(output.path));
  if (!late_us.empty()) return late_us;
  const auto lines = deploy::last_lines(output.path, 3);
  std::string said;
  for (const std::string& line : lines) said += (said.empty() ? "" : "; ") + line;
  return Error{"cyclictest measured nothing: " + (said.empty() ? std::string("it said nothing") : said)};
}

}  // namespace eciton::bench
