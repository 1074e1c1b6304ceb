// What the config reader fills in, and that each kind of mistake is named: where it stands, what was
// found, what would be right.
#include "core/base/config.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace eciton {
namespace {

struct Gains {
  double kp = 6;
  std::array<double, 3> limit_N{1, 2, 3};
  template <class V>
  void visit_fields(V& v) {
    v("kp", kp, in_range(0, 100));
    v("limit_N", limit_N);
  }
};

struct Port {
  std::string kind = "male";
  int joint = 0;
  template <class V>
  void visit_fields(V& v) {
    v("kind", kind, one_of({"male", "female"}));
    v("joint", joint, in_range(0, 7));
  }
};

struct Config {
  std::uint32_t module_id = 1;
  std::uint64_t seed = 0;
  double rate_Hz = 500;
  bool composed = false;
  std::string law = "local";
  std::string name;
  Gains gains;
  std::vector<Port> ports;
  std::vector<double> joint_rad;
  std::map<std::string, std::string> environment;
  template <class V>
  void visit_fields(V& v) {
    v("module_id", module_id, in_range(1, 90));
    v("seed", seed);
    v("rate_Hz", rate_Hz, in_range(1, 1000));
    v("composed", composed);
    v("law", law, one_of({"none", "paper", "local"}));
    v("name", name);
    v("gains", gains);
    v("ports", ports);
    v("joint_rad", joint_rad);
    v("environment", environment);
  }
};

Config read(const ConfigTree& tree) {
  Config config;
  const Status status = read_config(tree, config);
  EXPECT_TRUE(status.ok()) << status.error().message;
  return config;
}

ConfigTree tree_of(const std::string& yaml) {
  ConfigTree tree;
  const Status status = tree.add_text(yaml, "legion.yaml");
  EXPECT_TRUE(status.ok()) << status.error().message;
  return tree;
}

/// The message for a text that is refused, by the parser or by the reader.
std::string message_for(const std::string& yaml) {
  ConfigTree tree;
  if (const Status status = tree.add_text(yaml, "legion.yaml"); !status) return status.error().message;
  Config config;
  const Status status = read_config(tree, config);
  return status ? "accepted" : status.error().message;
}

std::string message_for_setting(const std::string& assignment) {
  ConfigTree tree;
  if (const Status status = tree.set(assignment, "--set"); !status) return status.error().message;
  Config config;
  const Status status = read_config(tree, config);
  return status ? "accepted" : status.error().message;
}

TEST(ConfigTest, KeepsDefaultsForMissingKeys) {
  const Config config = read(tree_of("module_id: 7\n"));
  EXPECT_EQ(config.module_id, 7U);
  EXPECT_EQ(config.rate_Hz, 500);
  EXPECT_EQ(config.gains.kp, 6);
  EXPECT_EQ(config.law, "local");
}

TEST(ConfigTest, ReadsEveryKindOfField) {
  const Config config = read(tree_of(R"(
module_id: 90
seed: 18446744073709551615
rate_Hz: 2.5e2
composed: on
law: paper
name: "seven of nine"
gains: {kp: 0.5, limit_N: [4, 5.5, -6]}
ports:
  - {kind: female, joint: 1}
  - joint: 2
joint_rad: [0.1, -0.2]
environment: {ECITON_DDS: fastdds}
)"));
  EXPECT_EQ(config.module_id, 90U);
  EXPECT_EQ(config.seed, 18446744073709551615ULL);
  EXPECT_EQ(config.rate_Hz, 250);
  EXPECT_TRUE(config.composed);
  EXPECT_EQ(config.law, "paper");
  EXPECT_EQ(config.name, "seven of nine");
  EXPECT_EQ(config.gains.limit_N, (std::array<double, 3>{4, 5.5, -6}));
  ASSERT_EQ(config.ports.size(), 2U);
  EXPECT_EQ(config.ports[0].kind, "female");
  EXPECT_EQ(config.ports[1].kind, "male");
  EXPECT_EQ(config.ports[1].joint, 2);
  EXPECT_EQ(config.joint_rad, (std::vector<double>{0.1, -0.2}));
  EXPECT_EQ(config.environment.at("ECITON_DDS"), "fastdds");
}

TEST(ConfigTest, AcceptsAnEmptyFile) { EXPECT_EQ(message_for(""), "accepted"); }

TEST(ConfigTest, LaterLayersWinKeyByKey) {
  ConfigTree tree = tree_of("gains: {kp: 1, limit_N: [1, 1, 1]}\nlaw: none\njoint_rad: [1, 2]\n");
  ASSERT_TRUE(tree.add_text("gains: {kp: 2}\njoint_rad: [3]\n", "module_3.yaml").ok());
  ASSERT_TRUE(tree.set("gains.kp=3", "--set").ok());
  const Config config = read(tree);
  EXPECT_EQ(config.gains.kp, 3);
  EXPECT_EQ(config.gains.limit_N, (std::array<double, 3>{1, 1, 1}));  // untouched by the upper layers
  EXPECT_EQ(config.law, "none");
  EXPECT_EQ(config.joint_rad, (std::vector<double>{3}));  // a list is replaced as a whole
}

TEST(ConfigTest, SetsSingleKeysOfAnyKind) {
  ConfigTree tree;
  for (const char* assignment : {"law=paper", "gains.limit_N=[7, 8, 9]", "composed=true", "seed=5"}) {
    ASSERT_TRUE(tree.set(assignment, "--set").ok()) << assignment;
  }
  const Config config = read(tree);
  EXPECT_EQ(config.law, "paper");
  EXPECT_EQ(config.gains.limit_N, (std::array<double, 3>{7, 8, 9}));
  EXPECT_TRUE(config.composed);
  EXPECT_EQ(config.seed, 5U);
}

TEST(ConfigTest, NamesAnUnknownKeyAndTheKnownOnes) {
  EXPECT_EQ(message_for("law: none\nrate_hz: 3\n"),
            "legion.yaml:2: unknown key 'rate_hz'; known here: module_id, seed, rate_Hz, composed, law, name, gains, "
            "ports, joint_rad, environment");
  EXPECT_EQ(message_for("gains:\n  kp: 1\n  ki: 2\n"),
            "legion.yaml:3: unknown key 'gains.ki'; known here: kp, limit_N");
  EXPECT_EQ(message_for("ports:\n  - kind: male\n  - size: 2\n"),
            "legion.yaml:3: unknown key 'ports[1].size'; known here: kind, joint");
}

TEST(ConfigTest, NamesAValueOutOfRange) {
  EXPECT_EQ(message_for("module_id: 91\n"),
            "legion.yaml:1: module_id: found '91', expected a whole number from 1 to 90");
  EXPECT_EQ(message_for("rate_Hz: 0.5\n"), "legion.yaml:1: rate_Hz: found '0.5', expected a number from 1 to 1000");
  EXPECT_EQ(message_for("\n\nports: [{joint: 8}]\n"),
            "legion.yaml:3: ports[0].joint: found '8', expected a whole number from 0 to 7");
}

TEST(ConfigTest, NamesAValueOfTheWrongType) {
  EXPECT_EQ(message_for("module_id: two\n"),
            "legion.yaml:1: module_id: found 'two', expected a whole number from 1 to 90");
  EXPECT_EQ(message_for("seed: -1\n"), "legion.yaml:1: seed: found '-1', expected a whole number");
  EXPECT_EQ(message_for("module_id: 2.5\n"),
            "legion.yaml:1: module_id: found '2.5', expected a whole number from 1 to 90");
  EXPECT_EQ(message_for("composed: 2\n"), "legion.yaml:1: composed: found '2', expected true or false");
  EXPECT_EQ(message_for("law: fast\n"), "legion.yaml:1: law: found 'fast', expected one of none, paper, local");
}

TEST(ConfigTest, RefusesNumbersThatAreNotFinite) {
  for (const char* number : {".nan", "nan", "inf", "-inf", "1e999"}) {
    EXPECT_NE(message_for(std::string("rate_Hz: ") + number), "accepted") << number;
    EXPECT_NE(message_for(std::string("joint_rad: [") + number + "]"), "accepted") << number;
  }
}

TEST(ConfigTest, RefusesTriplesThatAreNotFinite) {
  EXPECT_EQ(message_for("gains:\n  limit_N: [0, nan, 1]\n"),
            "legion.yaml:2: gains.limit_N[1]: found 'nan', expected a number");
  for (const char* number : {".nan", "inf", "-inf", "1e999", "[1]"}) {
    EXPECT_NE(message_for(std::string("gains: {limit_N: [0, 0, ") + number + "]}"), "accepted") << number;
  }
  EXPECT_EQ(message_for("gains: {limit_N: [0, 0, 1e300]}"), "accepted");
}

TEST(ConfigTest, NamesAWrongShape) {
  EXPECT_EQ(message_for("rate_Hz: [1, 2]\n"),
            "legion.yaml:1: rate_Hz: found a list, expected a number from 1 to 1000");
  EXPECT_EQ(message_for("gains: 3\n"), "legion.yaml:1: gains: found '3', expected keys and values below it");
  EXPECT_EQ(message_for("ports: 3\n"), "legion.yaml:1: ports: found '3', expected a list, as in [a, b]");
  EXPECT_EQ(message_for("gains: {limit_N: [1, 2]}\n"),
            "legion.yaml:1: gains.limit_N: found a list, expected three numbers, as in [0, 0, 1.5]");
  EXPECT_EQ(message_for("environment: 3\n"),
            "legion.yaml:1: environment: found '3', expected keys and values below it");
}

TEST(ConfigTest, RefusesScalarsAndListsWhereStructsAreDue) {
  EXPECT_EQ(message_for("ports:\n  - {kind: male}\n  - female\n"),
            "legion.yaml:3: ports[1]: found 'female', expected keys and values, as in {key: value}");
  EXPECT_EQ(message_for("ports: [[male]]\n"),
            "legion.yaml:1: ports[0]: found a list, expected keys and values, as in {key: value}");
  EXPECT_EQ(message_for("ports: [~]\n"),
            "legion.yaml:1: ports[0]: found no value, expected keys and values, as in {key: value}");
  EXPECT_EQ(message_for("gains: [1, 2]\n"), "legion.yaml:1: gains: found a list, expected keys and values below it");
}

TEST(ConfigTest, RefusesListsAndMapsWhereTextsAndNumbersAreDue) {
  EXPECT_EQ(message_for("name: [a]\n"), "legion.yaml:1: name: found a list, expected a text ('' for an empty one)");
  EXPECT_EQ(message_for("law:\n  paper: 1\n"),
            "legion.yaml:1: law: found keys and values, expected one of none, paper, local");
  EXPECT_EQ(message_for("joint_rad: [0, {a: 1}]\n"),
            "legion.yaml:1: joint_rad[1]: found keys and values, expected a number");
  EXPECT_EQ(message_for("environment:\n  ECITON_DDS: fastdds\n  PATH: [a, b]\n"),
            "legion.yaml:3: environment.PATH: found a list, expected a text ('' for an empty one)");
}

TEST(ConfigTest, RefusesAKeyGivenTwiceInOneMap) {
  EXPECT_EQ(message_for("law: none\nname: a\nlaw: paper\n"),
            "legion.yaml:3: key 'law' is given twice, first at legion.yaml:1; expected it once");
  EXPECT_EQ(message_for("gains:\n  kp: 1\n  kp: 1\n"),
            "legion.yaml:3: key 'gains.kp' is given twice, first at legion.yaml:2; expected it once");
  EXPECT_EQ(message_for("ports:\n  - joint: 1\n    joint: 2\n"),
            "legion.yaml:3: key 'ports[0].joint' is given twice, first at legion.yaml:2; expected it once");
  EXPECT_EQ(message_for("gains: {kp: 1}\nlaw: none\ngains: {limit_N: [1, 1, 1]}\n"),
            "legion.yaml:3: key 'gains' is given twice, first at legion.yaml:1; expected it once");
  EXPECT_EQ(message_for_setting("gains={kp: 1, kp: 2}"),
            "--set gains={kp: 1, kp: 2}: key 'gains.kp' is given twice; expected it once");
  // The same key in different maps, and in different layers, is none of it.
  EXPECT_EQ(message_for("ports:\n  - joint: 1\n  - joint: 1\n"), "accepted");
}

TEST(ConfigTest, RefusesWhatNoConfigMeans) {
  EXPECT_EQ(message_for("? [a, b]\n: 1\n"),
            "legion.yaml:1: a list or a map stands where a key should; expected 'key: value'");
  EXPECT_EQ(message_for("law: none\n---\nlaw: paper\n"),
            "legion.yaml: it holds 2 YAML documents, parted by '---'; expected one");
  EXPECT_NE(message_for("ports: &again [*again]\n"), "accepted") << "and it comes to an end";
}

TEST(ConfigTest, TakesAnEmptyValueOnlyWhereItMeansSomething) {
  EXPECT_EQ(message_for_setting("name="), "--set name=: name: found no value, expected a text ('' for an empty one)");
  EXPECT_EQ(message_for_setting("name=''"), "accepted");
  EXPECT_EQ(message_for("name:\n"), "legion.yaml:1: name: found no value, expected a text ('' for an empty one)");
  EXPECT_EQ(message_for_setting("law="), "--set law=: law: found no value, expected one of none, paper, local");
  EXPECT_EQ(message_for_setting("rate_Hz="),
            "--set rate_Hz=: rate_Hz: found no value, expected a number from 1 to 1000");
  // Of these words the empty one is one: "the default", say.
  ConfigTree tree = tree_of("vendor: fastdds\n");
  ASSERT_TRUE(tree.set("vendor=", "--set").ok());
  struct Choice {
    std::string vendor = "cyclonedds";
    void visit_fields(ConfigReader& v) { v("vendor", vendor, one_of({"", "cyclonedds", "fastdds"})); }
  } choice;
  const Status status = read_config(tree, choice);
  EXPECT_TRUE(status.ok()) << status.error().message;
  EXPECT_EQ(choice.vendor, "");
  const Status other = read_config(tree_of("vendor: rti\n"), choice);
  ASSERT_FALSE(other.ok());
  EXPECT_EQ(other.error().message, "legion.yaml:1: vendor: found 'rti', expected one of '', cyclonedds, fastdds");
}

TEST(ConfigTest, SaysWhereTheYamlBreaks) {
  EXPECT_EQ(message_for("- a\n- b\n"), "legion.yaml: expected keys and values at the top, as in 'key: value'");
  const std::string message = message_for("law: none\ngains: {kp: 1\n");
  EXPECT_EQ(message.find("legion.yaml:"), 0U) << message;
  EXPECT_NE(message.find("not valid YAML"), std::string::npos) << message;
}

TEST(ConfigTest, NamesTheSettingThatIsWrong) {
  EXPECT_EQ(message_for_setting("rate_Hz"), "--set rate_Hz: expected key=value, as in control.law=local");
  EXPECT_EQ(message_for_setting("=3"), "--set =3: expected key=value, as in control.law=local");
  EXPECT_EQ(message_for_setting("rate_Hz=fast"),
            "--set rate_Hz=fast: rate_Hz: found 'fast', expected a number from 1 to 1000");
  EXPECT_NE(message_for_setting("gains.ki=3").find("--set gains.ki=3: unknown key 'gains.ki'"), std::string::npos);
  EXPECT_NE(message_for_setting("name=[").find("not valid YAML"), std::string::npos);
}

TEST(ConfigTest, ReportsTheFirstOfManyMistakes) {
  EXPECT_EQ(message_for("law: fast\nmodule_id: 0\nnonsense: 1\n"),
            "legion.yaml:2: module_id: found '0', expected a whole number from 1 to 90");
}

TEST(ConfigTest, NamesAFileThatIsNotThere) {
  ConfigTree tree;
  const Status status = tree.add_file("/nonexistent/legion.yaml");
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("/nonexistent/legion.yaml"), std::string::npos);
}

TEST(ConfigTest, NamesADirectoryThatIsTakenForAFile) {
  ConfigTree tree;
  const std::string directory = std::filesystem::temp_directory_path();
  const Status status = tree.add_file(directory);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message,
            "config file " + directory + " cannot be read: it is a directory; expected a YAML file");
}

TEST(ConfigTest, ReadsAFileAndRemembersItsName) {
  const auto path =
      std::filesystem::temp_directory_path() / ("eciton_config_" + std::to_string(::getpid()) + ".yaml");
  std::ofstream(path) << "law: none\nrate_Hz: x\n";
  ConfigTree tree;
  ASSERT_TRUE(tree.add_file(path.string()).ok());
  std::filesystem::remove(path);
  Config config;
  const Status status = read_config(tree, config);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message.find(path.string() + ":2: rate_Hz"), 0U) << status.error().message;
}

TEST(ConfigTest, PrintsWhatItHoldsSoThatItReadsTheSameAgain) {
  ConfigTree tree = tree_of("gains: {kp: 1.5, limit_N: [1, 2, 3]}\nname: 'a: b'\nports: [{kind: female}]\n");
  const Config again = read(tree_of(tree.to_yaml()));
  EXPECT_EQ(again.gains.kp, 1.5);
  EXPECT_EQ(again.name, "a: b");
  ASSERT_EQ(again.ports.size(), 1U);
  EXPECT_EQ(again.ports[0].kind, "female");
}

TEST(ConfigTest, CopiesAreIndependent) {
  ConfigTree tree = tree_of("law: none\n");
  ConfigTree copy = tree;
  ASSERT_TRUE(copy.set("law=paper", "--set").ok());
  EXPECT_EQ(read(tree).law, "none");
  EXPECT_EQ(read(copy).law, "paper");
}

}  // namespace
}  // namespace eciton
