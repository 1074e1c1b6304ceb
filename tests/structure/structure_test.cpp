// The tree keeps its include rules, and the check that says so does find what breaks them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/structure/include_rules.hpp"

namespace eciton::structure {
namespace {

namespace fs = std::filesystem;

/// A source tree of one file, gone with the object.
class TreeOf {
 public:
  TreeOf(const std::string& file, const std::string& text)
      : root_(fs::temp_directory_path() / ("eciton_structure_" + std::to_string(::getpid()))) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << "\n";
  }
  ~TreeOf() { fs::remove_all(root_); }
  TreeOf(const TreeOf&) = delete;
  TreeOf& operator=(const TreeOf&) = delete;

  std::vector<std::string> found() const { return violations(root_); }

 private:
  fs::path root_;
};

struct Case {
  const char* name;
  const char* file;
  const char* text;
};

std::string name_of(const testing::TestParamInfo<Case>& test) { return test.param.name; }

std::string all_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(StructureTest, TheTreeKeepsItsRules) {
  const fs::path root = ECITON_SOURCE_DIR;
  EXPECT_GT(source_count(root), 40U);
  EXPECT_EQ(all_of(violations(root)), "");
}

class Forbidden : public testing::TestWithParam<Case> {};

TEST_P(Forbidden, IsFound) {
  const TreeOf tree(GetParam().file, GetParam().text);
  EXPECT_EQ(tree.found().size(), 1U) << all_of(tree.found());
}

INSTANTIATE_TEST_SUITE_P(
    Structure, Forbidden,
    testing::Values(
        Case{"BaseKnowsTheBus", "core/base/a.hpp", "#include \"core/bus/reader.hpp\""},
        Case{"BusKnowsTheIdl", "core/bus/a.cpp", "#include \"idl/state.hpp\""},
        Case{"BusKnowsAVendorPlugin", "core/bus/a.cpp", "#include \"core/bus/vendors/fastdds/plugin.hpp\""},
        Case{"OneVendorKnowsTheOther", "core/bus/vendors/fastdds/a.cpp",
             "#include \"core/bus/vendors/cyclonedds/sertype.hpp\""},
        Case{"VendorHeaderInTheBus", "core/bus/participant.cpp", "#include <dds/dds.h>"},
        Case{"CycloneInFastDds", "core/bus/vendors/fastdds/a.cpp", "#include <dds/dds.h>"},
        Case{"FastDdsInAService", "services/radio/radio_service.cpp", "#include <fastdds/dds/topic/Topic.hpp>"},
        Case{"FastCdrOutsideOfTheCodec", "core/bus/writer.hpp", "#include <fastcdr/Cdr.h>"},
        Case{"RobotKnowsTime", "core/robot/a.hpp", "#include \"core/base/time.hpp\""},
        Case{"RobotKnowsTheChain", "core/robot/a.hpp", "#include \"core/chain/view.hpp\""},
        Case{"ChainKnowsMessages", "core/chain/a.hpp", "#include \"idl/docking.hpp\""},
        Case{"MathsKnowsMessages", "services/control/pose_control.hpp", "#include \"idl/state.hpp\""},
        Case{"MathsKnowsTheBus", "services/control/pose_control.hpp", "#include \"core/bus/reader.hpp\""},
        Case{"MathsKnowsItsService", "services/control/a.cpp", "#include \"services/control/control_service.hpp\""},
        Case{"MathsHasThreads", "services/control/a.cpp", "#include <thread>"},
        Case{"MathsReadsTheSystem", "services/control/a.cpp", "#include <sys/time.h>"},
        Case{"OnlyDockingKnowsTheChain", "services/joints/a.cpp", "#include \"core/chain/view.hpp\""},
        Case{"MathsPrints", "services/control/a.cpp", "std::printf(\"here\");"},
        Case{"MathsAsksAClock", "services/control/a.cpp", "auto t = std::chrono::steady_clock::now();"},
        Case{"ServiceAsksAClock", "services/control/control_service.cpp",
             "auto t = std::chrono::system_clock::now();"},
        Case{"ServiceIncludesTheClock", "services/control/control_service.cpp",
             "#include \"core/base/wall_clock.hpp\""},
        Case{"ServiceKnowsAnother", "services/control/control_service.cpp",
             "#include \"services/estimation/observer.hpp\""},
        Case{"ServiceKnowsHardware", "services/joints/joints_service.cpp", "#include \"hal/interfaces.hpp\""},
        Case{"BackendKnowsMessages", "hal/dynamixel/bus.cpp", "#include \"idl/actuation.hpp\""},
        Case{"BackendKnowsAnother", "hal/dynamixel/bus.cpp", "#include \"hal/dshot/msp.hpp\""},
        Case{"PhysicsInTheHost", "hal/host/a.cpp", "#include <mujoco/mujoco.h>"},
        Case{"HostKnowsAService", "hal/host/a.cpp", "#include \"services/control/pose_control.hpp\""},
        Case{"NotFromTheRoot", "core/bus/a.cpp", "#include \"reader.hpp\""},
        Case{"AngleBracketsDoNotHide", "core/base/a.hpp", "#include <core/bus/reader.hpp>"},
        Case{"AnEmptyName", "core/base/string_utils.hpp", ""},
        Case{"AnEmptyDirectoryName", "core/base/common/a.hpp", ""}),
    name_of);

class Allowed : public testing::TestWithParam<Case> {};

TEST_P(Allowed, IsLeftAlone) {
  const TreeOf tree(GetParam().file, GetParam().text);
  EXPECT_EQ(all_of(tree.found()), "");
}

INSTANTIATE_TEST_SUITE_P(
    Structure, Allowed,
    testing::Values(
        Case{"VendorInItsPlugin", "core/bus/vendors/cyclonedds/a.cpp",
             "#include <dds/dds.h>\n#include \"core/bus/plugin.h\"\n#include \"core/bus/vendors/cyclonedds/b.hpp\""},
        Case{"MathsWithEigen", "services/control/a.hpp",
             "#include <Eigen/Dense>\n#include <cmath>\n#include \"core/robot/frames.hpp\"\n"
             "#include \"services/control/b.hpp\""},
        Case{"MathsThatWritesAMessage", "services/control/a.cpp",
             "#include <cstdio>\nstd::snprintf(text, 8, \"here\");"},
        Case{"DockingWithTheChain", "services/docking/a.hpp", "#include \"core/chain/view.hpp\""},
        Case{"ServiceWithItsMaths", "services/control/control_service.hpp",
             "#include \"services/control/a.hpp\"\n#include \"core/runtime/service.hpp\"\n#include "
             "\"idl/topics.hpp\""},
        Case{"PhysicsInTheSimulator", "hal/sim/world.cpp",
             "#include <mujoco/mujoco.h>\n#include \"hal/interfaces.hpp\"\n#include \"core/robot/airframe.hpp\""},
        Case{"GeneratorWithIdlc", "idl/generator/cpp.c", "#include <idl/processor.h>\n#include \"generator.h\""},
        Case{"AnInnocentName", "core/base/commonwealth.hpp", ""},
        Case{"TestsMayDoAnything", "tests/core/bus/a.cpp",
             "#include <dds/dds.h>\n#include \"hal/sim/world.hpp\"\n#include \"services/control/a.hpp\""}),
    name_of);

}  // namespace
}  // namespace eciton::structure
