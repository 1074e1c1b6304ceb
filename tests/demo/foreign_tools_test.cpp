// Foreign tools see normal DDS: readers made by either vendor's generator from idl/state.idl alone print live poses
// of a running demo, and a dissector names its topics and types.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>

#include "idl/topics.hpp"
#include "tests/native_peers/child_process.hpp"

namespace eciton::deploy {
namespace {

using native_peers::beside_this_program;
using native_peers::ChildProcess;
using namespace std::chrono_literals;

constexpr int ring_of_module_1 = 11;

template <class Condition>
[[nodiscard]] bool within(std::chrono::seconds limit, Condition&& condition) {
  for (const auto end = std::chrono::steady_clock::now() + limit; std::chrono::steady_clock::now() < end;) {
    if (condition()) return true;
    std::this_thread::sleep_for(200ms);
  }
  return condition();
}

/// The demo, taken down as by Ctrl-C: it then leaves nothing behind.
class RunningDemo {
 public:
  explicit RunningDemo(const std::string& dds)
      : process_({beside_this_program("eciton"), "demo", "--modules", "2", "--dds", dds}) {}
  ~RunningDemo() { stop(); }
  bool flying() { return process_.running(); }
  void stop() {
    process_.send(SIGINT);
    EXPECT_TRUE(process_.wait_until_end(60s)) << "the demo does not end";
  }
  const std::string& output() const { return process_.output(); }

 private:
  ChildProcess process_;
};

/// A native reader of module_state on the ring of module 1.
class PoseReader {
 public:
  explicit PoseReader(const std::string& vendor)
      : process_({beside_this_program("module_state_reader_" + vendor), std::to_string(ring_of_module_1), "240"}) {}
  ~PoseReader() {
    process_.send(SIGTERM);
    process_.wait_until_end(10s);
  }

  struct Pose {
    double p_WM_m[3];
    double q_WM[4];
  };
  bool running() { return process_.running(); }
  /// What it has printed of module 1, differing poses only.
  std::vector<Pose> poses() {
    process_.running();  // reads what there is
    std::vector<Pose> poses;
    std::istringstream lines(process_.output());
    std::string last;
    for (std::string line; std::getline(lines, line);) {
      Pose pose{};
      unsigned module_id = 0;
      if (std::sscanf(line.c_str(), "module %u at (%lf %lf %lf) m, q (%lf %lf %lf %lf)", &module_id, &pose.p_WM_m[0],
                      &pose.p_WM_m[1], &pose.p_WM_m[2], &pose.q_WM[0], &pose.q_WM[1], &pose.q_WM[2],
                      &pose.q_WM[3]) != 8 ||
          module_id != 1 || line == last) {
        continue;
      }
      poses.push_back(pose);
      last = line;
    }
    return poses;
  }
  bool sees_it_fly() {
    const auto seen = poses();
    return seen.size() >= 10 && seen.back().p_WM_m[2] > 1.0;  // the demo hovers at 1.5 m
  }

 private:
  ChildProcess process_;
};

/// tshark on that ring: prints the names that each packet shows.
class Dissector {
 public:
  Dissector()
      : process_({"/bin/sh", "-c",
                  "exec tshark -l -n -i lo -a duration:240 -f 'udp portrange " + first_port() + "-" + last_port() +
                      "' -Y rtps.param.typeName -T fields -e rtps.domain_id -e rtps.param.topicName "
                      "-e rtps.param.typeName 2>&1"}) {}
  ~Dissector() {
    process_.send(SIGTERM);
    process_.wait_until_end(10s);
  }

  bool running() { return process_.running(); }
  bool capturing() { return running() && process_.output().find("Capture started") != std::string::npos; }
  const std::string& output() const { return process_.output(); }

  struct Seen {
    std::map<std::string, std::set<std::string>> types_by_topic;
    std::size_t samples_of_module_state = 0;  // packets with one topic and nothing else: not announcements alone
  };
  Seen seen() {
    process_.running();
    Seen all;
    std::istringstream lines(process_.output());
    for (std::string line; std::getline(lines, line);) {
      std::istringstream columns(line);
      std::string domain, topics, types;
      if (!(columns >> domain >> topics >> types) || domain != std::to_string(ring_of_module_1)) continue;
      const auto topic = listed(topics), type = listed(types);
      if (topic.size() != type.size()) continue;  // a packet of several, some without a name
      for (std::size_t k = 0; k < topic.size(); ++k) all.types_by_topic[topic[k]].insert(type[k]);
      if (topics == "module_state") ++all.samples_of_module_state;
    }
    return all;
  }
  bool saw_every_topic() {
    bool every = true;
    const Seen all = seen();
    topics::for_each(
        [&](const auto& topic) { every = every && all.types_by_topic.contains(std::string(topic.name)); });
    return every;
  }

 private:
  // Of the ring's domain, by the RTPS specification.
  static std::string first_port() { return std::to_string(7400 + 250 * ring_of_module_1); }
  static std::string last_port() { return std::to_string(7400 + 250 * (ring_of_module_1 + 1) - 1); }
  static std::vector<std::string> listed(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream parts(text);
    for (std::string word; std::getline(parts, word, ',');) words.push_back(word);
    return words;
  }

  ChildProcess process_;
};

class ForeignToolsTest : public testing::TestWithParam<const char*> {};

void expect_live_poses(PoseReader& reader) {
  const auto poses = reader.poses();
  ASSERT_GE(poses.size(), 10u);
  for (const PoseReader::Pose& pose : poses) {
    for (const double x_m : pose.p_WM_m) EXPECT_TRUE(std::isfinite(x_m) && std::abs(x_m) < 100.0) << x_m;
    double square = 0;
    for (const double q : pose.q_WM) square += q * q;
    EXPECT_NEAR(square, 1.0, 0.01);
    EXPECT_GT(pose.p_WM_m[2], -0.1) << "below the ground";
  }
  EXPECT_GT(poses.back().p_WM_m[2], 1.0) << "not in the air";
}

TEST_P(ForeignToolsTest, SeeNormalDds) {
  Dissector dissector;
  EXPECT_TRUE(within(30s, [&] { return dissector.capturing() || !dissector.running(); }));
  ASSERT_TRUE(dissector.capturing())
      << "tshark cannot capture on lo: it needs to be installed, and the right to capture (run as root); it says:\n"
      << dissector.output();
  PoseReader on_cyclonedds("cyclonedds"), on_fastdds("fastdds");
  RunningDemo demo(GetParam());
  EXPECT_TRUE(within(150s, [&] {
    return (on_cyclonedds.sees_it_fly() && on_fastdds.sees_it_fly() && dissector.saw_every_topic()) || !demo.flying();
  }));
  ASSERT_TRUE(demo.flying()) << demo.output();
  EXPECT_TRUE(on_cyclonedds.running() && on_fastdds.running());
  {
    SCOPED_TRACE("native reader on Cyclone DDS");
    expect_live_poses(on_cyclonedds);
  }
  {
    SCOPED_TRACE("native reader on Fast DDS");
    expect_live_poses(on_fastdds);
  }
  const Dissector::Seen seen = dissector.seen();
  topics::for_each([&](const auto& topic) {
    using Type = typename std::remove_cvref_t<decltype(topic)>::Type;
    const auto found = seen.types_by_topic.find(std::string(topic.name));
    ASSERT_NE(found, seen.types_by_topic.end()) << topic.name << " was not dissected";
    EXPECT_EQ(found->second, std::set<std::string>{std::string(bus::TypeTraits<Type>::name)}) << topic.name;
  });
  EXPECT_TRUE(seen.types_by_topic.at("module_state").contains("eciton::msg::ModuleState"));
  EXPECT_GT(seen.samples_of_module_state, 10u) << "samples are not named, only announcements";
}

INSTANTIATE_TEST_SUITE_P(Demo, ForeignToolsTest, testing::Values("cyclonedds", "mixed"),
                         [](const auto& dds) { return std::string(dds.param); });

}  // namespace
}  // namespace eciton::deploy
