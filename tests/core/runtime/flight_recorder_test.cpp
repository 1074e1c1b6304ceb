// What is kept of the last steps and how it comes to a file: bounds, disks that are full, faults that come too fast.
#include "core/runtime/flight_recorder.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "core/base/wall_clock.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "core/runtime/fault_reporter.hpp"

namespace eciton::runtime {
namespace {

namespace fs = std::filesystem;

TEST(RowRingTest, KeepsTheNewestRowsInTheirOrder) {
  RowRing ring(2, 3);
  EXPECT_EQ(ring.size(), 0u);
  for (int k = 1; k <= 5; ++k) {
    const std::span<double> row = ring.push(TimePoint{} + k * 1ms);
    ASSERT_EQ(row.size(), 2u);
    EXPECT_TRUE(std::isnan(row[0]) && std::isnan(row[1])) << "nothing of the row it takes the place of";
    row[0] = k;
    EXPECT_EQ(ring.size(), std::min<std::size_t>(static_cast<std::size_t>(k), 3));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(ring.row(k)[0], static_cast<double>(k + 3));
    EXPECT_EQ(ring.stamp(k), TimePoint{} + (k + 3) * 1ms);
  }
  RowRing other(2, 3);
  other.copy(ring);
  ring.push(TimePoint{} + 6ms)[0] = 6;
  EXPECT_EQ(other.row(0)[0], 3) << "a copy of its own";
  EXPECT_EQ(other.row(2)[0], 5);
}

TEST(RowFillerTest, LaysValuesOneAfterAnotherAndStopsAtTheEnd) {
  std::vector<double> row(5, -1);
  RowFiller fill(row);
  fill(msg::FlightMode::hover, true, std::array<double, 2>{0.5, 0.25});
  EXPECT_EQ(row, (std::vector<double>{3, 1, 0.5, 0.25, -1}));
  fill(7u, 8.0);
  EXPECT_EQ(row.back(), 7);
  EXPECT_EQ(fill.filled(), 5u);
}

class FlightRecorderTest : public ::testing::Test {
 protected:
  FlightRecorderTest() {
    std::string pattern = (fs::temp_directory_path() / "eciton-recorder-XXXXXX").string();
    scratch_ = ::mkdtemp(pattern.data());
    faults_ = scratch_ / "run" / "faults";
  }
  ~FlightRecorderTest() override { fs::remove_all(scratch_); }

  RecorderConfig config(std::uint32_t rows = 4, std::uint32_t files = 3) const {
    return {.directory = faults_.string(), .rows = rows, .files = files};
  }
  static std::vector<Column> columns() { return {{"mode", "of flight", {"REST", "HOVER"}}, {"z_m", "height"}}; }
  static void push(FlightRecorder& recorder, TimePoint at, double mode, double z_m) {
    const std::span<double> row = recorder.push(at);
    row[0] = mode, row[1] = z_m;
  }
  static bool wait_until(const std::function<bool()>& done) {
    for (const Duration end = monotonic_now() + 10s; !done();) {
      if (monotonic_now() > end) return false;
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(faults_)) names.insert(entry.path().filename().string());
    return names;
  }
  std::string text(std::string_view name) const {
    std::ifstream in(faults_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path scratch_, faults_;
  TimePoint now_{1'700'000'000s};
};

TEST_F(FlightRecorderTest, WritesTheLastStepsUnderAHeading) {
  std::string name;
  {
    FlightRecorder recorder(config(), 7, "control", columns());
    for (int k = 0; k < 6; ++k) push(recorder, now_ + k * 2ms, k == 5 ? 0 : 1, 1.5 - 0.125 * k);
    name = recorder.freeze(now_ + 10ms, "estimation lost").view();
    push(recorder, now_ + 12ms, 1, 99);  // after the fault
  }
  EXPECT_EQ(name, "control-1700000000010000000.csv");
  EXPECT_EQ(files(), std::set<std::string>{name}) << "nothing is left beside it";
  const std::string file = text(name);
  EXPECT_NE(file.find("# fault of module 7, control: estimation lost\n"), std::string::npos) << file;
  EXPECT_NE(file.find("2023-11-14 22:13:20 UTC"), std::string::npos) << file;
  EXPECT_NE(file.find("# z_m: height\n"), std::string::npos) << file;
  EXPECT_EQ(file.substr(file.find("stamp_ns,before_s,mode")),
            "stamp_ns,before_s,mode,z_m\n"
            "1700000000004000000,0.0060,HOVER,1.25\n"
            "1700000000006000000,0.0040,HOVER,1.125\n"
            "1700000000008000000,0.0020,HOVER,1\n"
            "1700000000010000000,0.0000,REST,0.875\n");
}

TEST_F(FlightRecorderTest, WritesWhatThereIsWhenTheFaultComesEarlyAndShowsWhatIsNotKnown) {
  std::string name;
  {
    FlightRecorder recorder(config(), 7, "control", columns());
    recorder.push(now_)[1] = INFINITY;
    name = recorder.freeze(now_, "at once").view();
  }
  EXPECT_TRUE(text(name).ends_with("mode,z_m\n1700000000000000000,0.0000,nan,inf\n")) << text(name);
}

TEST_F(FlightRecorderTest, KeepsTheNewestFilesOfItsOwnServiceOnly) {
  fs::create_directories(faults_);
  for (const char* other : {"hardware-0000000000000000001.csv", "notes.txt"})
    std::ofstream(faults_ / other) << "mine";
  std::vector<std::string> names;
  FlightRecorder recorder(config(4, 3), 7, "control", columns());
  for (std::uint64_t k = 0; k < 5; ++k) {
    now_ += 1s;
    recorder.push(now_);
    names.emplace_back(recorder.freeze(now_, "again").view());
    ASSERT_TRUE(wait_until([&] { return recorder.written() == k + 1; }));
  }
  EXPECT_EQ(files(),
            (std::set<std::string>{"hardware-0000000000000000001.csv", "notes.txt", names[2], names[3], names[4]}));
  EXPECT_EQ(recorder.missed(), 0u);
  EXPECT_EQ(recorder.failed(), 0u);
}

TEST_F(FlightRecorderTest, CountsAFaultThatComesWhileAnotherIsBeingWrittenAndSaysSoInTheNextFile) {
  // A file that takes its time: a pipe that nobody reads yet.
  fs::create_directories(faults_);
  const fs::path pipe = faults_ / "control-1700000000000000000.csv.new";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  FlightRecorder recorder(config(), 7, "control", columns());
  recorder.push(now_);
  EXPECT_FALSE(recorder.freeze(now_, "first").empty());
  recorder.push(now_ + 1ms);
  const Duration before = monotonic_now();
  EXPECT_TRUE(recorder.freeze(now_ + 1ms, "second").empty()) << "it has no file, and does not pretend to";
  EXPECT_TRUE(recorder.freeze(now_ + 2ms, "third").empty());
  EXPECT_LT(monotonic_now() - before, 5s) << "nor does it wait";
  EXPECT_EQ(recorder.missed(), 2u);
  std::ifstream reader(pipe);
  ASSERT_TRUE(wait_until([&] { return recorder.written() == 1; }));
  const std::string name(recorder.freeze(now_ + 3ms, "fourth").view());
  ASSERT_TRUE(wait_until([&] { return recorder.written() == 2; }));
  EXPECT_NE(text(name).find("# before it 2 faults got no file of their own"), std::string::npos) << text(name);
  // The negative control: the next one says nothing of the kind.
  const std::string last(recorder.freeze(now_ + 4ms, "fifth").view());
  ASSERT_TRUE(wait_until([&] { return recorder.written() == 3; }));
  EXPECT_EQ(text(last).find("got no file"), std::string::npos) << text(last);
}

TEST_F(FlightRecorderTest, CountsWhatAFullDiskRefusesAndLeavesNothingHalf) {
  fs::create_directories(faults_);
  fs::create_symlink("/dev/full", faults_ / "control-1700000000000000000.csv.new");
  FlightRecorder recorder(config(), 7, "control", columns());
  recorder.push(now_);
  EXPECT_FALSE(recorder.freeze(now_, "no room").empty());
  ASSERT_TRUE(wait_until([&] { return recorder.failed() == 1; }));
  EXPECT_EQ(recorder.written(), 0u);
  EXPECT_TRUE(files().empty());
  // There is room again: it goes on as if nothing had been.
  const std::string name(recorder.freeze(now_ + 1s, "room").view());
  ASSERT_TRUE(wait_until([&] { return recorder.written() == 1; }));
  EXPECT_EQ(files(), std::set<std::string>{name});
}

TEST_F(FlightRecorderTest, CountsWhatADirectoryThatCannotBeMadeRefuses) {
  std::ofstream(scratch_ / "run") << "a file where the directory should be";
  FlightRecorder recorder(config(), 7, "control", columns());
  for (std::uint64_t k = 1; k <= 3; ++k) {
    recorder.push(now_);
    recorder.freeze(now_, "nowhere");
    ASSERT_TRUE(wait_until([&] { return recorder.failed() == k; }));
  }
  EXPECT_EQ(recorder.written(), 0u);
}

TEST_F(FlightRecorderTest, ItsErrorNamesTheFileAndTheCause) {
  fs::create_directories(faults_);
  fs::create_symlink("/dev/full", faults_ / "x.csv.new");
  const RowRing rows(2, 4);
  const Status full = write_fault_record(faults_ / "x.csv", {.service = "control", .text = ""}, columns(), rows);
  ASSERT_FALSE(full);
  EXPECT_NE(full.error().message.find("x.csv cannot be written: No space left on device"), std::string::npos)
      << full.error().message;
}

class FaultReporterTest : public FlightRecorderTest {
 protected:
  static bus::sim_network::Network& virtual_network() {
    bus::sim_network::Network::reset_all();
    auto& network = bus::sim_network::Network::of(13);
    network.configure(1, bus::sim_network::Pacing::virtual_time);
    return network;
  }
  static bus::ParticipantConfig on_ring(const std::string& name) {
    return {.vendor = "sim_network", .domain = 13, .name = name, .network_interface = "lo", .peers = {}};
  }
  bus::sim_network::Network& network_ = virtual_network();
  bus::Participant ring_{on_ring("control")};
  bus::Participant ear_{on_ring("ear")};
  bus::Reader<msg::Fault> heard_ = ear_.create_reader(topics::fault);
  std::vector<msg::Fault> heard() {
    std::vector<msg::Fault> faults;
    network_.advance(now_);
    while (const auto fault = heard_.take()) faults.push_back(fault->value);
    return faults;
  }
};

TEST_F(FaultReporterTest, TellsTheFaultsOfAStepWithTheOneFileThatEndsWithItsRow) {
  FaultReporter reporter(ring_, 7, "control", config(), columns());
  ASSERT_TRUE(reporter.records());
  reporter.raise(now_, msg::Severity::error, "flight", "estimation lost");
  reporter.raise(now_, msg::Severity::warning, "docking", "odd");
  EXPECT_TRUE(heard().empty()) << "not before the step is done";
  reporter.row(now_)(msg::FlightMode::armed, 0.5);
  reporter.tell(now_);
  const std::vector<msg::Fault> faults = heard();
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].record.view(), "control-1700000000000000000.csv");
  EXPECT_EQ(faults[1].record, faults[0].record);
  EXPECT_EQ(faults[0].service.view(), "control");
  EXPECT_EQ(faults[1].device.view(), "docking");
  ASSERT_TRUE(wait_until([&] { return reporter.recorder()->written() == 1; }));
  EXPECT_TRUE(text(faults[0].record.view()).ends_with("1700000000000000000,0.0000,HOVER,0.5\n"));
  reporter.tell(now_);
  EXPECT_TRUE(heard().empty()) << "once";
}

TEST_F(FaultReporterTest, WithoutADirectoryItTellsAndKeepsNothing) {
  FaultReporter reporter(ring_, 7, "control", {}, columns());
  EXPECT_FALSE(reporter.records());
  reporter.raise(now_, msg::Severity::error, "flight", "estimation lost");
  reporter.tell(now_);
  const std::vector<msg::Fault> faults = heard();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].record.empty());
  EXPECT_FALSE(fs::exists(faults_));
}

}  // namespace
}  // namespace eciton::runtime
