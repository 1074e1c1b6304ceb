// What programs read: the JSON object's shape, every raw sample in the CSV, and what happens when a file
// cannot be written.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "benchmarks/report/result.hpp"
#include "tests/benchmarks/report/made_up_result.hpp"

namespace eciton::bench {
namespace {

namespace fs = std::filesystem;

std::string csv_of(const Result& result) {
  std::ostringstream text;
  write_csv(text, result);
  return text.str();
}

class ReportFilesTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(directory_); }
  void TearDown() override { fs::remove_all(directory_); }
  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  static std::string text_of(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  fs::path directory_ = fs::temp_directory_path() / ("eciton_report_" + std::to_string(::getpid()));
};

TEST_F(ReportFilesTest, WritesAllThreeAndLeavesNoDrafts) {
  const ReportFiles files{path("a.json"), path("a.csv"), path("a.html")};
  ASSERT_TRUE(check_report_files(files));
  EXPECT_TRUE(fs::is_empty(directory_));
  const Result result = made_up_result();
  ASSERT_TRUE(write_report_files(files, result));
  EXPECT_EQ(text_of(files.csv), csv_of(result));
  EXPECT_EQ(text_of(files.html), to_html(result));
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 3);
}

TEST_F(ReportFilesTest, TheJsonObjectHasTheShapeOfEveryMeasuringCommand) {
  ASSERT_TRUE(write_report_files({path("a.json"), "", ""}, made_up_result()));
  const Json json = Json::parse(text_of(path("a.json")));
  EXPECT_EQ(json["command"], "bench latency");
  EXPECT_EQ(json["clock"], "monotonic");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["config"]["link"]["delay_ms"], 0);
  EXPECT_EQ(json["metrics"]["tax_p50.cyclonedds.wake.256"], 1.021);
  EXPECT_EQ(json["series"]["partial"], true);
  const Json& one = json["series"]["256 B raw UDP"];
  EXPECT_EQ(one["unit"], "µs");
  EXPECT_EQ(one["count"], 12'000);
  EXPECT_EQ(one["lost"], 3);
  EXPECT_GT(one["p99.99"], one["p50"]);
  EXPECT_EQ(json.size(), 6u);
}

TEST_F(ReportFilesTest, NothingMeasuredIsNotWrittenAsANumber) {
  Result result;
  result.samples.push_back({.name = "a peer that never came", .unit = "µs", .sent = 10, .lost = 10});
  ASSERT_TRUE(write_report_files({path("a.json"), "", ""}, result));
  const Json json = Json::parse(text_of(path("a.json")));
  EXPECT_EQ(json["series"]["a peer that never came"]["lost"], 10);
  EXPECT_FALSE(json["series"]["a peer that never came"].contains("p50"));
}

TEST(ReportCsvTest, KeepsEveryRawSampleToTheLastBit) {
  Result result;
  result.samples.push_back({.name = "ours, \"wake\"", .unit = "us", .at_s = {0.001, 0.1}, .values = {0.1 + 0.2, 7}});
  result.samples.push_back({.name = "sorted", .unit = "us", .values = {1e-7}});
  EXPECT_EQ(csv_of(result),
            "name,unit,at_s,value\n"
            "\"ours, \"\"wake\"\"\",us,0.001,0.30000000000000004\n"
            "\"ours, \"\"wake\"\"\",us,0.1,7\n"
            "sorted,us,,1e-07\n");
}

TEST_F(ReportFilesTest, AFileThatCannotBeWrittenIsNamedBeforeTheWork) {
  for (const auto& [files, option] :
       std::initializer_list<std::pair<ReportFiles, std::string>>{{{path("no/a.json"), "", ""}, "--json"},
                                                                  {{"", path("no/a.csv"), ""}, "--csv"},
                                                                  {{"", "", path("no/a.html")}, "--html"}}) {
    const Status status = check_report_files(files);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().message.find(option + " " + path("no/a.")), 0u) << status.error().message;
    EXPECT_NE(status.error().message.find("No such file or directory"), std::string::npos);
  }
}

TEST_F(ReportFilesTest, OneThatFailsDoesNotCostTheOthers) {
  const Status status = write_report_files({path("no/a.json"), path("a.csv"), ""}, made_up_result());
  ASSERT_FALSE(status);
  EXPECT_TRUE(fs::exists(path("a.csv")));
}

}  // namespace
}  // namespace eciton::bench
