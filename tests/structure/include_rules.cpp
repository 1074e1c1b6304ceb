// The rules as three tables: headers of ours by directory, headers of others by where they may be used,
// and what pure code may use of the standard library.
#include "tests/structure/include_rules.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <string_view>

namespace eciton::structure {
namespace {

namespace fs = std::filesystem;
using Prefixes = std::vector<std::string>;

constexpr std::array<std::string_view, 7> top_level{"core/",   "idl/",   "services/",  "hal/",
                                                    "deploy/", "tests/", "benchmarks/"};

/// Files matching `where` include, of our own headers, only those that begin with one of `allowed`
/// ($1: what the first group of `where` matched). The first rule that matches a file holds for it.
struct Rule {
  std::regex where;
  Prefixes allowed;
  bool pure = false;  // no clock, thread, file or device: only Eigen and the standard library's data side
};

const std::vector<Rule>& rules() {
  static const Prefixes maths{"services/$1/", "core/robot/", "core/base/result.hpp", "core/base/bounded.hpp",
                              "core/base/time.hpp"};
  static const Prefixes docking_maths = [] {
    Prefixes with_chain = maths;
    with_chain.emplace_back("core/chain/");
    return with_chain;
  }();
  static const std::vector<Rule> table{
      {std::regex("core/base/.*"), {"core/base/"}},
      {std::regex("core/bus/vendors/[^/]+"), {"core/bus/vendors/*", "core/bus/*", "core/base/"}},
      {std::regex("core/bus/vendors/([^/]+)/.*"),
       {"core/bus/vendors/$1/", "core/bus/vendors/*", "core/bus/*", "core/base/"}},
      {std::regex("core/bus/.*"), {"core/bus/*", "core/base/"}},
      {std::regex("core/runtime/.*"), {"core/runtime/", "core/bus/*", "core/base/", "idl/"}},
      {std::regex("core/chain/.*"), {"core/chain/", "core/base/"}, true},
      {std::regex("core/robot/.*"), {"core/robot/", "core/base/result.hpp", "core/base/bounded.hpp"}, true},
      {std::regex("idl/generator/.*"), {}},
      {std::regex("idl/.*"), {"idl/*", "core/bus/*", "core/base/"}},
      // A service and its parts: control_service.cpp, control_service_goals.cpp.
      {std::regex("services/([^/]+)/.*_service(_[a-z]+)?\\.[ch]pp"),
       {"services/$1/", "core/base/", "core/bus/*", "core/runtime/", "core/chain/", "core/robot/", "idl/*"}},
      {std::regex("services/(docking)/.*"), docking_maths, true},
      {std::regex("services/([^/]+)/.*"), maths, true},
      {std::regex("hal/host/.*"), {"hal/", "core/base/", "core/bus/*", "core/runtime/", "core/robot/", "idl/*"}},
      // The simulated world moves as the executor's plant, and emulates the devices of the real backends.
      {std::regex("hal/sim/.*"),
       {"hal/*", "hal/sim/", "hal/serial/", "hal/dynamixel/", "hal/dshot/", "core/base/", "core/robot/",
        "core/runtime/plant.hpp"}},
      {std::regex("hal/([^/]+)/.*"), {"hal/*", "hal/$1/", "hal/serial/", "core/base/", "core/robot/"}},
      {std::regex("hal/.*"), {"hal/*", "core/base/", "core/robot/"}},
      {std::regex("(deploy|tests|benchmarks)/.*"), {""}},
  };
  return table;
}

/// Headers of others that only some directories may use; what is not listed here is free.
struct ForeignRule {
  std::string_view header;
  Prefixes users;
};

const std::vector<ForeignRule>& foreign_rules() {
  static const std::vector<ForeignRule> table{
      {"dds/", {"core/bus/vendors/cyclonedds/", "tests/", "benchmarks/"}},
      {"fastdds/", {"core/bus/vendors/fastdds/", "tests/", "benchmarks/"}},
      {"fastrtps/", {"core/bus/vendors/fastdds/", "tests/", "benchmarks/"}},
      {"fastcdr/", {"core/bus/codec.cpp", "tests/", "benchmarks/"}},
      {"idlc/", {"idl/generator/", "tests/native_peers/generator/"}},
      {"mujoco/", {"hal/sim/"}},
      {"EGL/", {"hal/sim/"}},
      {"png.h", {"deploy/report/", "tests/deploy/report/"}},
      {"Eigen/", {"core/robot/", "services/", "hal/", "deploy/", "tests/", "benchmarks/"}},
      {"spdlog/", {"core/base/"}},
      {"yaml-cpp/", {"core/base/", "tests/"}},
      {"CLI/", {"deploy/", "tests/", "benchmarks/"}},
      {"nlohmann/", {"deploy/", "tests/", "benchmarks/"}},
      {"boost/", {"hal/serial/", "deploy/", "tests/", "benchmarks/"}},
      {"systemd/", {"core/runtime/", "deploy/", "tests/"}},
      {"gtest/", {"tests/"}},
      {"gmock/", {"tests/"}},
      {"benchmark/", {"benchmarks/"}},
  };
  return table;
}

constexpr std::array<std::string_view, 11> impure_standard{
    "thread",  "mutex",    "condition_variable", "atomic", "future", "semaphore",
    "fstream", "iostream", "filesystem",         "ctime",  "csignal"};

bool begins_with(std::string_view text, std::string_view prefix) { return text.substr(0, prefix.size()) == prefix; }

std::string joined(const Prefixes& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "nothing of ours" : text;
}

/// "core/bus/*" allows the files of that directory, not of those below it; "core/bus/" allows both.
bool matches(std::string_view header, std::string_view pattern) {
  if (!pattern.ends_with('*')) return begins_with(header, pattern);
  const std::string_view directory = pattern.substr(0, pattern.size() - 1);
  return begins_with(header, directory) && header.find('/', directory.size()) == std::string_view::npos;
}

bool any_matches(std::string_view header, const Prefixes& patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& p) { return matches(header, p); });
}

struct Include {
  std::string header;
  bool quoted;
};

/// However it is quoted.
bool is_ours(const Include& include) {
  return std::any_of(top_level.begin(), top_level.end(),
                     [&](std::string_view top) { return begins_with(include.header, top); });
}

class Checker {
 public:
  explicit Checker(fs::path root) : root_(std::move(root)) {}

  void check(const fs::path& path) {
    file_ = fs::relative(path, root_).generic_string();
    check_name();
    find_rule();
    std::ifstream in(path);
    static const std::regex include_line(R"(^\s*#\s*include\s*([<"])([^">]+)[">])");
    line_ = 0;
    for (std::string text; std::getline(in, text);) {
      ++line_;
      std::smatch parts;
      if (std::regex_search(text, parts, include_line)) check_include({parts[2], parts[1] == "\""});
      check_clock(text);
      check_output(text);
    }
  }

  std::vector<std::string> found;

 private:
  void report(const std::string& what) { found.push_back(file_ + ":" + std::to_string(line_) + ": " + what); }

  void check_name() {
    static const std::regex empty_word("(^|_)(utils?|helpers?|common|misc)(_|$)");
    line_ = 1;
    for (const fs::path& part : fs::path(file_)) {
      if (std::regex_search(part.stem().string(), empty_word)) {
        report("'" + part.string() + "' says nothing: name it after what it holds");
      }
    }
  }

  void find_rule() {
    rule_ = nullptr;
    allowed_.clear();
    for (const Rule& rule : rules()) {
      std::smatch match;
      if (!std::regex_match(file_, match, rule.where)) continue;
      rule_ = &rule;
      for (const std::string& pattern : rule.allowed) {
        allowed_.push_back(std::regex_replace(pattern, std::regex("\\$1"), match.size() > 1 ? match[1].str() : ""));
      }
      return;
    }
    report("no include rule covers this file: add one to tests/structure/include_rules.cpp");
  }

  void check_include(const Include& include) {
    // Cyclone's idlc, which the generator extends, has an idl/ of its own.
    const bool of_idlc = begins_with(file_, "idl/generator/") && begins_with(include.header, "idl/");
    if (is_ours(include) && !of_idlc) return check_ours(include.header);
    const bool local_allowed = rule_ == nullptr || begins_with(file_, "idl/generator/") ||
                               begins_with(file_, "tests/") || begins_with(file_, "benchmarks/");
    if (include.quoted && !local_allowed) {
      report("\"" + include.header + "\": include from the root, as in \"core/bus/reader.hpp\"");
    }
    check_foreign(include.header);
  }

  void check_ours(const std::string& header) {
    if (rule_ == nullptr) return;
    if (given_the_time() && header == "core/base/wall_clock.hpp") report("may not include " + header + no_clock);
    if (!any_matches(header, allowed_)) {
      report("may not include " + header + "; allowed here: " + joined(allowed_));
    }
    // Maths is below its service, not beside it.
    if (rule_->pure && header.find("_service") != std::string::npos) {
      report("may not include " + header + ": maths does not know its service");
    }
  }

  void check_foreign(const std::string& header) {
    for (const ForeignRule& rule : foreign_rules()) {
      if (begins_with(header, rule.header) && !any_matches(file_, rule.users)) {
        report("may not include <" + header + ">; only " + joined(rule.users));
      }
    }
    if (rule_ == nullptr || !rule_->pure || begins_with(header, "Eigen/")) return;
    const bool device = header.find_first_of("./") != std::string::npos;
    const bool impure = std::find(impure_standard.begin(), impure_standard.end(), header) != impure_standard.end();
    if (device || impure)
      report("may not include <" + header + ">: this code is pure, it computes and does nothing else");
  }

  void check_clock(const std::string& text) {
    if (given_the_time() && text.find("_clock::now") != std::string::npos) report("asks a clock" + no_clock);
  }

  /// snprintf makes a message; the others of <cstdio> print it.
  void check_output(const std::string& text) {
    static const std::regex prints(R"(\b(f?printf|f?puts|fputc|putchar|fwrite|fopen)\()");
    if (rule_ != nullptr && rule_->pure && std::regex_search(text, prints)) report("prints: this code is pure");
  }

  bool given_the_time() const {
    return begins_with(file_, "services/") || begins_with(file_, "core/robot/") || begins_with(file_, "core/chain/");
  }

  const std::string no_clock = ": this code is given the time";
  fs::path root_;
  std::string file_;
  int line_ = 0;
  const Rule* rule_ = nullptr;
  Prefixes allowed_;
};

std::vector<fs::path> sources(const fs::path& root) {
  constexpr std::array<std::string_view, 4> suffixes{".cpp", ".hpp", ".c", ".h"};
  std::vector<fs::path> files;
  for (const std::string_view top : top_level) {
    const fs::path directory = root / top;
    if (!fs::exists(directory)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
      const std::string suffix = entry.path().extension().string();
      if (entry.is_regular_file() && std::find(suffixes.begin(), suffixes.end(), suffix) != suffixes.end()) {
        files.push_back(entry.path());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<std::string> violations(const fs::path& root) {
  Checker checker(root);
  for (const fs::path& file : sources(root)) checker.check(file);
  return checker.found;
}

std::size_t source_count(const fs::path& root) { return sources(root).size(); }

}  // namespace eciton::structure
