// The physics model of a world: MJCF text from the airframe, compiled by MuJoCo, and where in it each
// module's parts are.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/robot/airframe.hpp"
#include "hal/sim/mismatch.hpp"
#include "hal/sim/world_config.hpp"

namespace eciton::hal::sim {

struct FreeModel {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
};
struct FreeData {
  void operator()(mjData* d) const { mj_deleteData(d); }
};
using ModelPtr = std::unique_ptr<mjModel, FreeModel>;
using DataPtr = std::unique_ptr<mjData, FreeData>;

inline constexpr double step_s = 1e-3;  // 2 kHz gives the same results (docs: simulated world)
/// Height of B above the floor on its feet: below the cone's lower lip, and clear of the links.
inline constexpr double rest_height_m = 0.13;

/// One module in mjModel and mjData.
struct ModuleIndex {
  std::uint32_t id;
  int body;  // its frame is B
  int qpos;  // of the free joint: p_WB, q_WB
  int dof;   // v_WB in W, then w_WB in B
  std::array<int, max_joints> joint_qpos;
  std::array<int, max_joints> joint_dof;
  robot::Vector3 p_B_com_m;  // centre of mass of the main body alone, where xfrc_applied acts
};

/// One docking port: a frame fixed on a link's body.
struct PortIndex {
  std::size_t module;  // index, not id
  std::size_t port;
  robot::PortKind kind;
  int link_body;
  robot::Pose X_LP;
  int geom_first;  // its contact geoms: a tip, or the boxes of a cone
  int geom_count;
};

/// A weld that can hold one male in one female port.
struct PairIndex {
  std::size_t male;  // indices into ports
  std::size_t female;
  int equality;
};

struct WorldModel {
  ModelPtr model;
  DataPtr data;
  std::vector<ModuleIndex> modules;
  std::vector<PortIndex> ports;
  std::vector<PairIndex> pairs;  // every male with every other module's female, male by male
};

/// MJCF text of all modules and the floor. `mismatch` has one entry per module.
std::string mjcf(const WorldConfig& config, const robot::Airframe& airframe, const std::vector<ModuleStart>& starts,
                 const std::vector<Mismatch>& mismatch);

/// The Error says what MuJoCo does not like.
Result<ModelPtr> compile_mjcf(const std::string& xml);

/// Compiles the model and finds its parts.
Result<WorldModel> build_model(const WorldConfig& config, const robot::Airframe& airframe,
                               const std::vector<ModuleStart>& starts, const std::vector<Mismatch>& mismatch);

}  // namespace eciton::hal::sim
