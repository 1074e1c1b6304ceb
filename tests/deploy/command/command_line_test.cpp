// Wrong words: exit status 2, nothing on standard output, and one line that names the word and what would be
// right.
#include "deploy/command/command_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/deploy/command/process.hpp"

namespace eciton {
namespace {

tests::Ended eciton(std::vector<std::string> words) {
  words.insert(words.begin(), ECITON_PROGRAM);
  return tests::run(words);
}

struct Wrong {
  const char* name;
  std::vector<std::string> words;
  std::vector<std::string> said;
};

void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

std::string name_of(const testing::TestParamInfo<Wrong>& test) { return test.param.name; }

class WrongWords : public testing::TestWithParam<Wrong> {};

TEST_P(WrongWords, AreNamedWithWhatWouldBeRight) {
  const tests::Ended ended = eciton(GetParam().words);
  EXPECT_EQ(ended.status, 2) << ended.err;
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  for (const std::string& part : GetParam().said) {
    EXPECT_NE(ended.err.find(part), std::string::npos) << "no '" << part << "' in: " << ended.err;
  }
}

INSTANTIATE_TEST_SUITE_P(
    CommandLineTest, WrongWords,
    testing::Values(
        Wrong{"NoCommand", {}, {"eciton: a command is missing; there are ", "topic"}},
        Wrong{"AnUnknownCommand", {"topik"}, {"eciton: no command 'topik' (did you mean topic?)"}},
        Wrong{"NoSubcommand", {"topic"}, {"eciton topic: a command is missing; there are list, echo, hz"}},
        Wrong{"AnUnknownSubcommand",
              {"topic", "ehco", "imu"},
              {"eciton topic: no command 'ehco' (did you mean echo?); there are list, echo, hz, delay"}},
        Wrong{"AnUnknownOption",
              {"topic", "list", "--secnods", "1"},
              {"eciton topic list: no option '--secnods' (did you mean --seconds?)", "--module"}},
        Wrong{"AnUnknownOptionOfTheCommandItself", {"--frob"}, {"no option '--frob'"}},
        Wrong{"AMissingArgument", {"topic", "echo"}, {"eciton topic echo: TOPIC is required"}},
        Wrong{"AWordTooMany", {"topic", "echo", "imu", "clock"}, {"'clock' is one word too many"}},
        Wrong{"AnUnknownTopic",
              {"topic", "echo", "imo"},
              {"eciton topic echo: no topic 'imo' (did you mean imu?)", "module_state"}},
        Wrong{"AModuleOutOfRange",
              {"topic", "list", "--module", "91"},
              {"eciton topic list: --module: ", "91", "1 to 90"}},
        Wrong{
            "AModuleThatIsNoNumber", {"topic", "list", "--module", "two"}, {"eciton topic list: --module: ", "two"}},
        Wrong{"ADomainOutOfRange", {"topic", "list", "--domain", "233"}, {"--domain", "0 to 232"}},
        Wrong{"TwoRings",
              {"topic", "list", "--module", "1", "--swarm"},
              {"eciton topic list: ", "--module", "--swarm"}},
        Wrong{"AnOptionWithoutItsValue", {"topic", "list", "--module"}, {"--module"}},
        Wrong{"ANegativeCount", {"topic", "echo", "imu", "--count", "-1"}, {"--count", "-1"}},
        Wrong{"NobodyToArm", {"arm"}, {"eciton arm: "}},
        Wrong{"AModuleToArmThatCannotBe", {"arm", "91"}, {"eciton arm: ", "91", "1 to 90"}},
        Wrong{"APositionThatIsNone", {"goto", "1", "here", "0", "1"}, {"eciton goto: ", "here"}},
        Wrong{"AStopForNobody", {"stop"}, {"eciton stop: no module is named; expected ids, or --all"}},
        Wrong{"NoExperiment", {"experiment"}, {"eciton experiment: a command is missing; there are ", "hover"}},
        Wrong{"AnUnknownExperiment", {"experiment", "hoover"}, {"no command 'hoover' (did you mean hover?)"}},
        Wrong{"AnUnknownVendor",
              {"topic", "list", "--dds", "opendds"},
              {"eciton topic list: DDS vendor 'opendds'", "cyclonedds, fastdds"}},
        Wrong{"AnUnknownInterface",
              {"topic", "list", "--interface", "nosuch0"},
              {"eciton topic list: ", "nosuch0", "lo"}},
        Wrong{"AFileThatCannotBeWritten",
              {"topic", "list", "--contract", "--json", "/nonexistent/list.json"},
              {"--json /nonexistent/list.json: cannot be written"}},
        Wrong{"ADirectoryThatCannotBe",
              {"experiment", "docking", "--report", "/dev/null/report"},
              {"--report: /dev/null/report: cannot be written"}}),
    name_of);

TEST(CommandLineTest, HelpGoesToStandardOutputWithStatusZero) {
  for (const auto& words :
       std::vector<std::vector<std::string>>{{"--help"}, {"topic", "--help"}, {"topic", "hz", "-h"}}) {
    const tests::Ended ended = eciton(words);
    EXPECT_EQ(ended.status, 0);
    EXPECT_EQ(ended.err, "");
    EXPECT_NE(ended.out.find("Usage: eciton"), std::string::npos) << ended.out;
  }
}

TEST(CommandLineTest, SaysItsVersion) {
  const tests::Ended ended = eciton({"--version"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.out.find("eciton 0."), 0U) << ended.out;
}

TEST(NearestTest, PutsTheLikeliestFirstAndLeavesOutTheRest) {
  const std::vector<std::string> words{"list", "echo", "hz", "delay", "bw"};
  EXPECT_EQ(deploy::nearest("lsit", {"hz", "list", "sit"}), (std::vector<std::string>{"sit", "list"}));
  EXPECT_EQ(deploy::nearest("dela", words), std::vector<std::string>{"delay"});
  EXPECT_TRUE(deploy::nearest("xyz", words).empty());
  EXPECT_TRUE(deploy::nearest("", words).empty());
}

}  // namespace
}  // namespace eciton
