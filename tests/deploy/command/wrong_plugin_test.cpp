// A plugin left over from another release: every way to start something is refused before anything starts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "core/bus/plugin.h"
#include "tests/deploy/command/process.hpp"
#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;

/// An environment variable, as it was again at the end of the test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

class WrongPluginTest : public ::testing::Test {
 protected:
  /// Runs it with the plugin of `vendor` from another release and all others as they are.
  tests::Ended run_with_wrong(const std::string& vendor, const std::vector<std::string>& words) {
    // In a directory of its own, found first: the other vendors come from where they always are.
    const fs::path directory = fs::path(ECITON_OTHER_RELEASE) / vendor;
    wrong_file_ = directory / ("lib" ECITON_PLUGIN_PREFIX + vendor + ".so");
    EXPECT_TRUE(fs::exists(wrong_file_)) << wrong_file_;
    const char* path = std::getenv("ECITON_PLUGIN_PATH");
    const Variable plugins("ECITON_PLUGIN_PATH", directory.string() + (path ? std::string(":") + path : ""));
    const Variable root("ECITON_RUNTIME_DIR", root_.string());
    const Variable no_choice("ECITON_DDS", "");
    return tests::run(words);
  }

  void expect_refused(const tests::Ended& ended) {
    EXPECT_EQ(ended.status, 2) << ended.err;
    EXPECT_EQ(ended.out, "");
    const std::string said = "DDS plugin " + wrong_file_.string() + " has ABI version " +
                             std::to_string(ECITON_PLUGIN_ABI_VERSION + 1) + ", this program needs " +
                             std::to_string(ECITON_PLUGIN_ABI_VERSION);
    EXPECT_NE(ended.err.find(said), std::string::npos) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_FALSE(fs::exists(root_)) << "something was begun: that directory, with a lock and logs, is the first step";
  }

  std::string write(const std::string& name, const std::string& yaml) {
    std::ofstream(scratch_.path() / name) << yaml;
    return scratch_.file(name);
  }

  Scratch scratch_;
  fs::path root_ = scratch_.path() / "run";
  fs::path wrong_file_;
};

TEST_F(WrongPluginTest, ADemoIsRefused) {
  expect_refused(run_with_wrong("cyclonedds", {ECITON_PROGRAM, "demo", "--modules", "2", "--dds", "cyclonedds"}));
}

TEST_F(WrongPluginTest, ADemoThatNeedsItForSomeProcessesOnlyIsRefusedAsAWhole) {
  expect_refused(run_with_wrong("fastdds", {ECITON_PROGRAM, "demo", "--modules", "2", "--dds", "mixed"}));
}

TEST_F(WrongPluginTest, AModuleIsRefusedAlsoForOneProcess) {
  const std::string config = write("m84.yaml", "{id: 84, name: m84, dds: cyclonedds, vendors: {control: fastdds}}\n");
  expect_refused(run_with_wrong("fastdds", {ECITON_PROGRAM, "up", config}));
}

TEST_F(WrongPluginTest, AModuleInTheBackgroundIsRefusedInTheForeground) {
  const std::string config = write("m84.yaml", "{id: 84, name: m84, dds: cyclonedds}\n");
  expect_refused(run_with_wrong("cyclonedds", {ECITON_PROGRAM, "up", "--detach", config}));
}

TEST_F(WrongPluginTest, AServiceByItselfIsRefused) {
  const std::string config = write("m84.yaml", "{id: 84, name: m84, dds: fastdds}\n");
  expect_refused(run_with_wrong("fastdds", {ECITON_SERVICE, "estimation", "--config", config}));
}

TEST_F(WrongPluginTest, AToolIsRefusedAndRunsWithTheRightOne) {
  const std::vector<std::string> list{ECITON_PROGRAM, "topic", "list", "--seconds", "0.1", "--domain", "96", "--dds"};
  const auto with = [&](const std::string& vendor) {
    std::vector<std::string> words = list;
    words.push_back(vendor);
    return words;
  };
  expect_refused(run_with_wrong("cyclonedds", with("cyclonedds")));
  // The negative control: that one plugin is what is wrong.
  EXPECT_EQ(run_with_wrong("cyclonedds", with("fastdds")).status, 0);
  EXPECT_EQ(tests::run(with("cyclonedds")).status, 0);
}

}  // namespace
}  // namespace eciton::deploy
