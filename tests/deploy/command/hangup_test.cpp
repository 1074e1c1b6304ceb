// A closing terminal: a module flies on, a demo and an experiment end and leave neither processes nor files behind.
#include "deploy/hangup.hpp"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include "deploy/supervisor/running_modules.hpp"
#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;
constexpr const char* root_variable = "ECITON_RUNTIME_DIR";
constexpr std::chrono::seconds patience{90};  // the machine may be busy

/// `eciton` as a user runs it, with a runtime directory by which all it starts is found again.
class HangupTest : public ::testing::Test {
 protected:
  void start(std::vector<std::string> words) {
    words.insert(words.begin(), ECITON_PROGRAM);
    auto child = ChildProcess::start(
        {.arguments = words, .environment = {{root_variable, root_.string()}}, .log_file = scratch_.file("log")});
    ASSERT_TRUE(child.ok()) << child.error().message;
    eciton_.emplace(std::move(child).value());
  }

  void TearDown() override {
    for (const pid_t pid : processes()) ::kill(pid, SIGKILL);
  }

  /// As a terminal does when it closes: more than once, and nobody reads any more. Only to the command itself:
  /// what it started is its own affair.
  void hang_up() {
    for (const int signal : {SIGPIPE, SIGHUP, SIGHUP}) ::kill(eciton_->pid(), signal);
  }

  std::optional<ProcessEnd> wait_for_end() {
    std::optional<ProcessEnd> end;
    eventually([&] { return (end = eciton_->take_end()).has_value(); }, patience);
    return end;
  }

  /// All that live and inherited our runtime directory: the command, and what it started.
  std::vector<pid_t> processes() const {
    std::vector<pid_t> found;
    const std::string mark = std::string(root_variable) + "=" + root_.string();
    std::error_code gone;
    for (const auto& entry : fs::directory_iterator("/proc", gone)) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      if (text_of(entry.path() / "environ").find(mark) != std::string::npos) found.push_back(std::stoi(name));
    }
    return found;
  }

  /// To be asked before wait_for_end, which ends the whole process group of the command.
  bool nothing_is_left() {
    return eventually([&] { return processes().empty(); }, patience) && (!fs::exists(root_) || fs::is_empty(root_));
  }

  std::string log() const { return text_of(scratch_.path() / "log"); }
  bool log_has(const std::string& text) const { return log().find(text) != std::string::npos; }

  Scratch scratch_;
  fs::path root_ = scratch_.path() / "run";
  std::optional<ChildProcess> eciton_;
};

TEST_F(HangupTest, EndsADemoThatLeavesNothingBehind) {
  start({"demo", "--modules", "2", "--layout", "composed", "--dds", "cyclonedds"});
  ASSERT_TRUE(eventually([&] { return log_has("take off"); }, patience)) << log();
  // The demo itself, its world, and a hardware host and the services of each module.
  EXPECT_GE(processes().size(), 6u);
  hang_up();
  EXPECT_TRUE(nothing_is_left());
  const auto end = wait_for_end();
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->text(), "exit status 130") << log();
  EXPECT_TRUE(log_has("interrupted: everything is down")) << log();
}

TEST_F(HangupTest, EndsTheTrialsOfAnExperiment) {
  // The orphaned trials come to us, so that we see how they end.
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  start({"experiment", "docking", "--trials", "4", "--jobs", "2"});
  ASSERT_TRUE(eventually([&] { return processes().size() >= 3; }, patience)) << log();
  std::vector<pid_t> trials = processes();
  std::erase(trials, eciton_->pid());
  hang_up();
  for (const pid_t trial : trials) {
    int status = 0;
    ASSERT_TRUE(eventually([&] { return ::waitpid(trial, &status, WNOHANG) == trial; }, patience));
    EXPECT_NE(status, 0) << "it went on to its end";
  }
  ::prctl(PR_SET_CHILD_SUBREAPER, 0);
  EXPECT_TRUE(nothing_is_left());
  const auto end = wait_for_end();
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->signal, SIGHUP) << log();
}

TEST_F(HangupTest, LeavesAModuleFlyingAndSupervised) {
  const std::string socket = scratch_.file("world.sock");
  std::ofstream(scratch_.file("world.yaml"))
      << "{socket: " << socket << ", pace: wall, world: {modules: [{id: 83, position_m: [0, 0, 0]}]}}\n";
  std::ofstream(scratch_.file("m83.yaml"))
      << "{id: 83, name: m83, layout: composed, clock: wall, dds: cyclonedds, hal: {backend: sim, socket: " << socket
      << "}}\n";
  start({"up", scratch_.file("m83.yaml"), "--world", scratch_.file("world.yaml")});
  ASSERT_TRUE(eventually([&] { return log_has("m83 is up"); }, patience)) << log();
  hang_up();
  const auto services = [&] {
    for (const RunningModule& module : running_modules(root_)) {
      if (module.name == "m83") return module.processes.at(1);
    }
    return RunningProcess{};
  };
  // That it lives shows in what it does: it starts again what ends.
  ASSERT_GT(services().pid, 0);
  ::kill(services().pid, SIGKILL);
  EXPECT_TRUE(eventually([&] { return services().restarts == 1; }, patience)) << log();
  eciton_->signal(SIGTERM);
  EXPECT_TRUE(nothing_is_left());
  const auto end = wait_for_end();
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->text(), "exit status 0") << log();
}

TEST(StopOnHangupTest, SetsTheFlagHoweverOftenItComes) {
  runtime::StopFlag stop;
  {
    const StopOnHangup on_hangup(stop);
    EXPECT_FALSE(stop.requested());
    ::raise(SIGHUP);
    ::raise(SIGHUP);
    EXPECT_TRUE(stop.requested());
  }
  EXPECT_EXIT(::raise(SIGHUP), ::testing::KilledBySignal(SIGHUP), "") << "as before it";
}

TEST(StopOnHangupTest, LeavesAProcessUnderNohupAlone) {
  const IgnoredSignals nohup({SIGHUP});
  runtime::StopFlag stop;
  const StopOnHangup on_hangup(stop);
  ::raise(SIGHUP);
  EXPECT_FALSE(stop.requested());
}

}  // namespace
}  // namespace eciton::deploy
