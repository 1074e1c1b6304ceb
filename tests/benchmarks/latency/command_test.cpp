// `eciton bench latency` with what may be wrong: words, programs, peers that hang, die or hear nothing, and Ctrl-C.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/deploy/command/process.hpp"

namespace eciton::tests {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

/// A directory of peers: the real ones of the build where nothing else is put.
class Peers {
 public:
  Peers() : directory_(fs::temp_directory_path() / ("eciton_bench_latency_" + std::to_string(::getpid()))) {
    fs::remove_all(directory_);
    fs::create_directories(directory_);
  }
  ~Peers() { fs::remove_all(directory_); }
  Peers(const Peers&) = delete;
  Peers& operator=(const Peers&) = delete;

  static fs::path built(const std::string& transport) {
    return fs::path(ECITON_PROGRAM).parent_path() / ("eciton-bench-peer-" + transport);
  }
  /// UDP stands for ours where DDS is not the point: it takes the same words and is there at once.
  Peers& link(const std::string& transport, const std::string& real) {
    fs::create_symlink(built(real), directory_ / ("eciton-bench-peer-" + transport));
    return *this;
  }
  Peers& script(const std::string& transport, const std::string& text) {
    const fs::path file = directory_ / ("eciton-bench-peer-" + transport);
    std::ofstream(file) << "#!/bin/sh\n" << text << "\n";
    fs::permissions(file, fs::perms::owner_all);
    return *this;
  }
  std::string path() const { return directory_; }
  fs::path file(const std::string& name) const { return directory_ / name; }

 private:
  fs::path directory_;
};

std::vector<std::string> words(const std::vector<std::string>& more) {
  std::vector<std::string> all{ECITON_PROGRAM, "bench", "latency"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// One lane of each kind that is asked for, over in a second.
std::vector<std::string> brief(const Peers& peers, const std::vector<std::string>& more,
                               const std::string& duration_s = "0.3", const std::string& patience_s = "3") {
  std::vector<std::string> all =
      words({"--programs", peers.path(), "--vendors", "cyclonedds", "--modes", "inline", "--sizes", "64", "--rates",
             "500", "--block", "0.05", "--duration", duration_s, "--patience", patience_s});
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

nlohmann::json read_json(const fs::path& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in, nullptr, false);
}

/// A peer as a script: runs the built one, but an echo only after `first` did what it does.
std::string echo_that(const std::string& first) {
  return "case \"$*\" in *'--role echo'*) " + first + " ;; esac\nexec " + Peers::built("udp").string() + " \"$@\"";
}

TEST(BenchLatencyTest, NamesAWrongWordAndWhatWouldBeRight) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"--sizes", "65"}, "--sizes: no payload of 65 B; there are 64, 256, 1024, 4096"},
      {{"--vendors", "opensplice"}, "--vendors: no 'opensplice'; there are cyclonedds, fastdds"},
      {{"--modes", "poll"}, "--modes: no 'poll'; there are wake, inline"},
      {{"--qos", "best"}, "--qos: no 'best'; there are sensor, command"},
      {{"--baselines", "ros"}, "--baselines: no 'ros'; there are native, udp, ddsperf, zeromq, lcm, none"},
      {{"--rates", "0"}, "--rates: 0.000000 Hz is not in 1 to 10000"},
      {{"--over", "sea"}, "--over: no 'sea'; there are loopback, hosts, impaired"},
      {{"--interface", "eth99"}, "--over loopback: network interface \"eth99\" does not exist"},
      {{"--hosts", "a"}, "--hosts: give two"},
      {{"--hosts", "a,b"}, "--hosts: a: there is no network namespace /run/netns/a"},
      {{"--programs", "/nowhere"}, "/nowhere/eciton-bench-peer-eciton is not there"},
      {{"--json", "/nowhere/x.json"}, "--json /nowhere/x.json: cannot be written"},
      {{"--sice", "64"}, "did you mean --sizes?"},
  };
  for (const auto& [wrong, message] : cases) {
    const Ended ended = run(words(wrong));
    EXPECT_EQ(ended.status, 2) << wrong[0];
    EXPECT_NE(ended.err.find(message), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
  }
}

TEST(BenchLatencyTest, MeasuresOursBesideNativeAndUdp) {
  const Peers peers;
  const Ended ended = run(words({"--sizes", "64,4096", "--rates", "500", "--block", "0.05", "--duration", "0.2",
                                 "--baselines", "native,udp", "--json", peers.file("out.json")}),
                          seconds(90));
  ASSERT_EQ(ended.status, 0) << ended.out << ended.err;
  const nlohmann::json json = read_json(peers.file("out.json"));
  for (const char* vendor : {"cyclonedds", "fastdds"}) {
    for (const char* mode : {"wake", "inline"}) {
      for (const char* bytes : {"64", "4096"}) {
        const std::string cell = std::string(vendor) + "." + mode + "." + bytes;
        EXPECT_TRUE(json["metrics"].contains("tax_p50." + cell)) << cell << "\n" << ended.out;
        EXPECT_TRUE(json["metrics"].contains("over_udp_p50." + cell)) << cell;
      }
    }
  }
  EXPECT_TRUE(json["metrics"].contains("round_trip_us_p50.ours.cyclonedds-fastdds.wake.64"));
  EXPECT_TRUE(json["metrics"].contains("one_way_us_p50.ours.fastdds-cyclonedds.inline.4096"));
  EXPECT_EQ(json["clock"], "monotonic");
  EXPECT_EQ(ended.out.find("damaged"), std::string::npos) << ended.out;
}

TEST(BenchLatencyTest, GoesOnWithoutABaselineThatIsMissing) {
  Peers peers;
  peers.link("eciton", "udp").link("cyclonedds", "udp");
  std::vector<std::string> without_path =
      brief(peers, {"--baselines", "native,zeromq,lcm,ddsperf", "--json", peers.file("out.json")});
  without_path.insert(without_path.begin(), {"/usr/bin/env", "PATH=/nowhere"});
  const Ended ended = run(without_path);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("eciton-bench-peer-zeromq is not there; it is built where libzmq3-dev is installed"),
            std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("it is built where liblcm-dev is installed"), std::string::npos);
  EXPECT_NE(ended.out.find("ddsperf is not in the path; it comes with cyclonedds-tools"), std::string::npos);
  EXPECT_NE(ended.out.find("Latency (partial)"), std::string::npos);
  EXPECT_TRUE(read_json(peers.file("out.json"))["metrics"].contains("tax_p50.cyclonedds.inline.64"));
}

TEST(BenchLatencyTest, APeerThatNeverAppearsCostsItsLaneOnly) {
  Peers peers;
  peers.script("eciton", echo_that("exec sleep 60")).link("cyclonedds", "udp");
  const Ended ended = run(brief(peers, {"--baselines", "native"}));
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_NE(ended.out.find("ours on Cyclone DDS, inline: echo: eciton-bench-peer-eciton did not answer in time"),
            std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("round_trip.native.cyclonedds.inline.64 "), std::string::npos) << ended.out;
}

TEST(BenchLatencyTest, APeerThatRefusesSaysWhy) {
  Peers peers;
  peers.script("eciton", "echo 'error no such thing'; exit 2").link("cyclonedds", "udp");
  const Ended ended = run(brief(peers, {"--baselines", "native"}));
  EXPECT_EQ(ended.status, 1);
  EXPECT_NE(ended.out.find("ours on Cyclone DDS, inline: ping: no such thing"), std::string::npos) << ended.out;
}

TEST(BenchLatencyTest, APeerThatDiesMidRunLeavesWhatItGave) {
  Peers peers;
  // The script and what it becomes have one process id.
  peers.script("eciton", echo_that("(sleep 3; kill -9 $$) >/dev/null 2>&1 &")).link("cyclonedds", "udp");
  const Ended ended = run(brief(peers, {"--baselines", "native"}, "5"), seconds(60));
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_NE(ended.out.find("echo: eciton-bench-peer-eciton was ended by signal 9"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("round_trip.ours.cyclonedds.inline.64 (partial)"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("ours on Cyclone DDS, inline / native Cyclone DDS, inline, 64 B"), std::string::npos);
}

TEST(BenchLatencyTest, AnEchoThatHearsNothingIsNoHang) {
  Peers peers;
  peers.script("eciton",
               "case \"$*\" in *'--role ping'*) exec " + Peers::built("udp").string() +
                   " \"$@\";; esac\necho ready 127.0.0.1:9\n"
                   "while read verb rest; do case $verb in matched) echo matched 1;; end) echo block 0 0 0 0 0 "
                   "0 0 0 0;; *) echo ok;; esac; done");
  const Ended ended = run(brief(peers, {"--baselines", "none"}));
  EXPECT_EQ(ended.status, 1);
  EXPECT_NE(ended.out.find("no sample came back: is the link between the two ends up?"), std::string::npos)
      << ended.out;
}

TEST(BenchLatencyTest, PeersThatDoNotFindEachOtherAreSaid) {
  Peers peers;
  peers.script(
      "eciton",
      "echo ready -\nwhile read verb rest; do case $verb in matched) echo matched 0;; *) echo ok;; esac; done");
  const Ended ended = run(brief(peers, {"--baselines", "none"}, "0.3", "1"));
  EXPECT_EQ(ended.status, 1);
  EXPECT_NE(ended.out.find("its two ends did not find each other within 1 s"), std::string::npos) << ended.out;
}

TEST(BenchLatencyTest, CtrlCTellsWhatWasMeasured) {
  Peers peers;
  peers.link("eciton", "udp").link("cyclonedds", "udp");
  const Ended ended =
      run(brief(peers, {"--baselines", "native", "--json", peers.file("out.json")}, "600"), seconds(60), seconds(4));
  EXPECT_EQ(ended.status, 130) << ended.err;
  EXPECT_NE(ended.out.find("Interrupted: these are the figures up to then."), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("Latency (partial)"), std::string::npos);
  EXPECT_TRUE(read_json(peers.file("out.json"))["metrics"].contains("tax_p50.cyclonedds.inline.64"));
}

TEST(BenchLatencyTest, ALinkCutForTheWholeRunIsSaid) {
  const Peers peers;
  const Ended ended =
      run(words({"--over", "impaired", "--impairment", "cut=on", "--vendors", "cyclonedds", "--modes", "wake",
                 "--sizes", "64", "--duration", "0.3", "--patience", "2", "--baselines", "udp"}),
          seconds(60));
  if (ended.status == 2) GTEST_SKIP() << ended.err;  // no right to make hosts
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_NE(ended.out.find("ours on Cyclone DDS, wake: its two ends did not find each other within 2 s"),
            std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("raw UDP: no sample came back"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace eciton::tests
