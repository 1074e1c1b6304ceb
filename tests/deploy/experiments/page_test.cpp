// The page stands alone and is well formed, whatever the names in it, and says what it leaves out.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/report.hpp"
#include "tests/deploy/report/well_formed.hpp"

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;
using report::count_of;
using report::well_formed;

ReportInput made_up() {
  Figures figures;
  for (int i = 0; i < 400; ++i) {
    figures.series["time_s"].push_back(0.01 * i);
    figures.series["contact_force_N_1"].push_back(0.1 + 0.01 * (i % 7));
    figures.series["contact_force_N_1_estimated"].push_back(0.1 + 0.01 * (i % 5));
  }
  figures.series["mark_s"] = {1, 2};
  ReportInput input;
  input.experiment = "morph";
  input.summary = "three modules morph";
  input.command_line = "eciton experiment morph --seed 7";
  input.seed = 7;
  input.config = {{"sensing", "mocap"}, {"set", ""}};
  input.metrics = {{"contact_force_N_mean", 0.123}, {"joint_torque_Nm_max", 0.4}, {"own_metric", 3}};
  input.plots = morph_plots(figures);
  input.pictures.pictures = {{"T1: docked", 12.345, "not really a PNG\xff\xfe"}};
  return input;
}

constexpr const char* base64_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";

/// Ways for a page to fetch something; a picture's own bytes are none.
std::size_t references(const std::string& page) {
  const std::string embedded = " src=\"data:image/png;base64,";
  std::string text = page;
  for (std::size_t at = text.find(embedded); at != std::string::npos; at = text.find(embedded, at)) {
    const std::size_t end = text.find_first_not_of(base64_digits, at + embedded.size());
    if (end != std::string::npos && text[end] == '"')
      text.erase(at, end + 1 - at);
    else
      at += embedded.size();
  }
  std::size_t count = 0;
  for (const char* way : {" src=", " href=", " srcset=", " action=", " data=", " poster=", "url(", "@import", "//",
                          "fetch(", "import(", "<script"}) {
    count += count_of(text, way);
  }
  return count;
}

class Scratch {
 public:
  Scratch() : path_(fs::temp_directory_path() / ("eciton_report_test_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~Scratch() { fs::remove_all(path_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

TEST(ReportPageTest, IsWellFormedWhateverTheNames) {
  EXPECT_TRUE(well_formed(report_page(made_up())));
  ReportInput hostile = made_up();
  const std::string name = "</svg></script><b>&amp \"'\x01\n]]>";
  hostile.summary = hostile.command_line = hostile.config[0].first = hostile.config[0].second = name;
  hostile.metrics[name] = 1;
  hostile.plots[0].title = hostile.plots[0].note = name;
  hostile.pictures.pictures[0].title = hostile.pictures.notice = hostile.pictures.colours = name;
  EXPECT_TRUE(well_formed(report_page(hostile)));
  std::string broken = report_page(made_up());
  broken.replace(broken.find("</svg>"), 6, "");
  EXPECT_FALSE(well_formed(broken));
}

TEST(ReportPageTest, RefersToNothingOutside) {
  EXPECT_EQ(references(report_page(made_up())), 0u);
  EXPECT_EQ(references("<img src=\"https://a.b/c\"/>"), 2u);
}

TEST(ReportPageTest, ShowsOursBesideThePapers) {
  const std::string page = report_page(made_up());
  EXPECT_NE(page.find("<code>contact_force_N_mean</code></td><td>0.123</td><td>&lt; 0.3 N</td><td>≤ 0.3</td>"
                      "<td class=\"met\">met</td>"),
            std::string::npos);
  EXPECT_NE(page.find("<td>0.4</td><td>≤ 0.3 Nm</td><td>≤ 0.3</td><td class=\"missed\">missed</td>"),
            std::string::npos);
  EXPECT_NE(page.find("own_metric"), std::string::npos);
  EXPECT_NE(page.find("eciton experiment morph --seed 7"), std::string::npos);
  EXPECT_EQ(count_of(page, "<svg"), 1u);  // the one plot that has series
  EXPECT_NE(page.find("T1: docked <span>12.35 s</span>"), std::string::npos);
}

TEST(ReportPageTest, HoldsWithNothingMeasured) {
  const std::string page = report_page({});
  EXPECT_TRUE(well_formed(page));
  EXPECT_EQ(count_of(page, "id=\"stills\""), 0u);
}

TEST(StillsTest, WithoutEglThePageSaysWhy) {
  Still still{.title = "T1", .time_s = 1, .posture = std::vector<double>(15)};
  still.posture[3] = 1;
  ReportInput input = made_up();
  input.pictures = render_stills({still}, robot::legion(), "libNoSuchEgl.so.1");
  EXPECT_TRUE(input.pictures.pictures.empty());
  EXPECT_NE(input.pictures.notice.find("libNoSuchEgl.so.1"), std::string::npos);
  const std::string page = report_page(input);
  EXPECT_NE(page.find("<p class=\"partial\">no pictures: libNoSuchEgl.so.1 cannot be loaded"), std::string::npos);
  EXPECT_EQ(count_of(page, "<img"), 0u);
  EXPECT_TRUE(well_formed(page));
}

TEST(StillsTest, NoMomentsAreNoNotice) {
  const Pictures none = render_stills({}, robot::legion(), "libNoSuchEgl.so.1");
  EXPECT_TRUE(none.notice.empty());
}

TEST(StillsTest, APostureOfAnotherRobotIsANotice) {
  EXPECT_FALSE(render_stills({{"T1", 1, std::vector<double>(14)}}, robot::legion(), "").notice.empty());
}

TEST(ReportFilesTest, ThePageAndEveryPartAreWritten) {
  const Scratch scratch;
  const std::string directory = scratch / "a/b";
  ASSERT_TRUE(check_report_directory(directory).ok());
  EXPECT_TRUE(fs::is_empty(directory));
  const Result<std::string> page = write_report(directory, made_up());
  ASSERT_TRUE(page.ok());
  EXPECT_EQ(*page, directory + "/morph.html");
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(directory)) files += entry.is_regular_file();
  EXPECT_EQ(files, 4u);  // page, table, one plot, one still
  std::ifstream svg(directory + "/morph/contact_force_N.svg");
  EXPECT_TRUE(well_formed({std::istreambuf_iterator<char>(svg), {}}));
  EXPECT_EQ(fs::file_size(directory + "/morph/still_1.png"), 18u);
}

TEST(ReportFilesTest, ADirectoryThatCannotBeIsNamed) {
  const Scratch scratch;
  std::ofstream(scratch / "file") << "in the way";
  for (const char* name : {"file", "file/below"}) {
    const Status status = check_report_directory(scratch / name);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("--report: " + (scratch / name)), std::string::npos);
    EXPECT_FALSE(write_report(scratch / name, made_up()).ok());
  }
  EXPECT_TRUE(check_report_directory("").ok());  // nothing is asked for
}

}  // namespace
}  // namespace eciton::deploy
