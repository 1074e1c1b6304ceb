// `eciton topic` against a live publisher in this process, over both vendors. Samples are stamped by a thread
// here; what the tool prints is read back.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "core/bus/participant.hpp"
#include "idl/topics.hpp"
#include "tests/deploy/command/process.hpp"

namespace eciton {
namespace {

/// A domain of its own for each process that tests, so that tests may run beside each other.
constexpr std::uint32_t domain = 97;

std::int64_t wall_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Publishes imu of module 7 every 10 ms, stamped `age` ago, until it goes.
class Publisher {
 public:
  Publisher(const std::string& vendor, Duration age) : thread_([this, vendor, age] { publish(vendor, age); }) {}
  ~Publisher() {
    stop_ = true;
    thread_.join();
  }
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

 private:
  void publish(const std::string& vendor, Duration age) {
    bus::ParticipantConfig config;
    config.vendor = vendor;
    config.domain = domain;
    bus::Participant participant(config);
    auto writer = participant.create_writer(topics::imu);
    msg::Imu imu;
    imu.module_id = 7;
    imu.specific_force_M_m_s2 = {0, 0, 9.81};
    auto next = std::chrono::steady_clock::now();
    while (!stop_) {
      imu.stamp_ns = wall_ns() - age.count();
      writer.write(imu);
      next += 10ms;
      std::this_thread::sleep_until(next);
    }
  }

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

tests::Ended eciton(std::vector<std::string> words, std::chrono::milliseconds interrupt_after = {}) {
  words.insert(words.begin(), ECITON_PROGRAM);
  words.insert(words.end(), {"--domain", std::to_string(domain)});
  return tests::run(words, 60s, interrupt_after);
}

nlohmann::json read_json(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file, nullptr, false);
}

class TopicCommandTest : public testing::TestWithParam<const char*> {
 protected:
  std::string vendor() const { return GetParam(); }
  std::string json_file() const {
    return (std::filesystem::temp_directory_path() / ("eciton_topic_" + std::to_string(::getpid()) + ".json"))
        .string();
  }
};

TEST_P(TopicCommandTest, EchoPrintsSamplesAsJsonLines) {
  const Publisher publisher(vendor(), 0ms);
  const auto ended = eciton({"topic", "echo", "imu", "--json", "--count", "3", "--seconds", "20", "--dds", vendor()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  std::istringstream lines(ended.out);
  std::int64_t stamp_before_ns = 0;
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const auto sample = nlohmann::json::parse(line, nullptr, false);
    ASSERT_FALSE(sample.is_discarded()) << line;
    EXPECT_EQ(sample["module_id"], 7);
    EXPECT_EQ(sample["specific_force_M_m_s2"], nlohmann::json({0.0, 0.0, 9.81}));
    EXPECT_GT(sample["stamp_ns"].get<std::int64_t>(), stamp_before_ns);
    stamp_before_ns = sample["stamp_ns"];
  }
  EXPECT_EQ(count, 3);
  EXPECT_NE(ended.err.find("none dropped"), std::string::npos) << ended.err;
}

TEST_P(TopicCommandTest, EchoPrintsForPeople) {
  const Publisher publisher(vendor(), 0ms);
  const auto ended = eciton({"topic", "echo", "imu", "--count", "1", "--seconds", "20", "--dds", vendor()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out.find("module_id: 7\nstamp_ns: "), 0U) << ended.out;
  EXPECT_NE(ended.out.find("specific_force_M_m_s2: [0, 0, 9.81]\n"), std::string::npos) << ended.out;
}

TEST_P(TopicCommandTest, HzMeasuresTheRate) {
  const Publisher publisher(vendor(), 0ms);
  const auto ended =
      eciton({"topic", "hz", "imu", "--count", "50", "--seconds", "20", "--dds", vendor(), "--json", json_file()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto json = read_json(json_file());
  std::filesystem::remove(json_file());
  ASSERT_TRUE(json.is_object()) << ended.out;
  EXPECT_EQ(json["command"], "topic hz");
  EXPECT_EQ(json["clock"], "monotonic");
  EXPECT_EQ(json["metrics"]["samples"], 50);
  // A loaded machine makes single intervals long, and may lose samples, so only the order is asserted.
  EXPECT_GT(json["metrics"]["rate_Hz"], 20.0);
  EXPECT_LT(json["metrics"]["rate_Hz"], 200.0);
  EXPECT_LE(json["metrics"]["interval_s_min"], json["metrics"]["interval_s_p50"]);
  EXPECT_LE(json["metrics"]["interval_s_p50"], json["metrics"]["interval_s_max"]);
  EXPECT_NE(ended.out.find("module_id 7"), std::string::npos) << ended.out;
}

TEST_P(TopicCommandTest, DelayMeasuresTheAgeOnArrival) {
  const Publisher publisher(vendor(), 5s);
  const auto ended =
      eciton({"topic", "delay", "imu", "--count", "20", "--seconds", "20", "--dds", vendor(), "--json", json_file()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto json = read_json(json_file());
  std::filesystem::remove(json_file());
  ASSERT_TRUE(json.is_object()) << ended.out;
  EXPECT_EQ(json["clock"], "wall");
  EXPECT_GE(json["metrics"]["delay_s_min"], 5.0);
  EXPECT_LT(json["metrics"]["delay_s_p50"], 8.0);
}

TEST_P(TopicCommandTest, BandwidthCountsTheBytesOfTheWire) {
  const Publisher publisher(vendor(), 0ms);
  const auto ended =
      eciton({"topic", "bw", "imu", "--count", "10", "--seconds", "20", "--dds", vendor(), "--json", json_file()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto json = read_json(json_file());
  std::filesystem::remove(json_file());
  // 4 header + 4 id + 4 padding... XCDR1 aligns to 8 after the header: 4 + (4 + 4) + 8 + 6 * 8.
  EXPECT_EQ(json["metrics"]["size_B_mean"], 4 + 8 + 8 + 48);
}

TEST_P(TopicCommandTest, ListShowsWritersAndRates) {
  const Publisher publisher(vendor(), 0ms);
  const auto ended = eciton({"topic", "list", "--seconds", "3", "--dds", vendor(), "--json", json_file()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto json = read_json(json_file());
  std::filesystem::remove(json_file());
  EXPECT_EQ(json["series"]["imu"]["writers"], 1);
  EXPECT_GT(json["series"]["imu"]["rate_Hz"], 1.0);
  EXPECT_EQ(json["series"]["clock"]["writers"], 0);
  EXPECT_EQ(json["series"]["latch_state"]["key"], nlohmann::json({"module_id", "port"}));
}

INSTANTIATE_TEST_SUITE_P(Vendors, TopicCommandTest, testing::Values("cyclonedds", "fastdds"),
                         [](const testing::TestParamInfo<const char*>& vendor) { return std::string(vendor.param); });

TEST(TopicCommandEndTest, ControlCEndsItCleanlyWithItsAccount) {
  const auto ended = eciton({"topic", "hz", "imu"}, 1500ms);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.err.find("imu: received "), std::string::npos) << ended.err;
}

TEST(TopicCommandEndTest, TooFewSamplesInTimeIsStatusOne) {
  const auto ended = eciton({"topic", "echo", "fault", "--count", "1", "--seconds", "0.5"});
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_NE(ended.err.find("only 0 of 1 samples in 0.5 s"), std::string::npos) << ended.err;
}

TEST(TopicCommandEndTest, TheContractNeedsNoRing) {
  const auto ended = tests::run({ECITON_PROGRAM, "topic", "list", "--contract", "--dds", "nosuch"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("eciton::msg::LinkClaim"), std::string::npos);
}

}  // namespace
}  // namespace eciton
