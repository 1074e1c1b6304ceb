// Writes the MJCF of a world, compiles it and indexes the result.
#include "hal/sim/model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <locale>
#include <numbers>
#include <sstream>

namespace eciton::hal::sim {
namespace {

using robot::Matrix3;
using robot::Vector3;

// Contact classes: a tip meets cones, feet meet the floor, nothing else collides.
constexpr const char* tip_contact = " contype='1' conaffinity='0' solref='.01 1' friction='.2 .001 .001'";
constexpr const char* cone_contact = " contype='0' conaffinity='1' solref='.01 1' friction='.2 .001 .001'";
constexpr const char* foot_contact = " contype='0' conaffinity='2' priority='0'";
// Firm, and with friction that hardly creeps: a landed module must stand still under a gust.
constexpr const char* floor_contact =
    " contype='2' conaffinity='0' priority='1' condim='3' friction='.8 .005 .0001' solref='.01 1' solimp='.95 .99 "
    ".001'";

constexpr double tip_radius_m = 0.018;
constexpr double foot_radius_m = 0.01;
constexpr double guard_radius_m = 0.075;
constexpr int cone_boxes = 12;

/// Text with every digit of a double, whatever the process's locale.
std::ostringstream precise_text() {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  return text;
}

std::string numbers(const Vector3& v) {
  std::ostringstream text = precise_text();
  text << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

std::string inertial(double mass_kg, const Vector3& p_m, const Matrix3& I) {
  std::ostringstream text = precise_text();
  text << "<inertial pos='" << numbers(p_m) << "' mass='" << mass_kg << "' fullinertia='" << I(0, 0) << ' ' << I(1, 1)
       << ' ' << I(2, 2) << ' ' << I(0, 1) << ' ' << I(0, 2) << ' ' << I(1, 2) << "'/>";
  return text.str();
}

std::string name(const char* part, std::size_t module, std::size_t k) {
  return part + std::to_string(module) + "_" + std::to_string(k);
}

/// The male port's tip: a ball just behind the docking point.
std::string tip(const robot::PortGeometry& port, const std::string& geom_name) {
  std::ostringstream text = precise_text();
  text << "<geom name='" << geom_name << "' type='sphere' pos='"
       << numbers(port.p_JP_m - tip_radius_m * port.R_JP.col(0)) << "' size='" << tip_radius_m << "'" << tip_contact
       << "/>";
  return text.str();
}

/// The female port's cone: twelve boxes at 45 degrees, mouth 75 mm in radius, closed at the apex so that
/// a tip's ball comes to rest with the docking points together.
std::string cone(const robot::PortGeometry& port, const std::string& geom_name) {
  constexpr double apex_radius_m = 0.008, mouth_radius_m = 0.075, wall_m = 0.003;
  const double middle_m = 0.5 * (apex_radius_m + mouth_radius_m) + wall_m;
  const double half_width_m = 1.15 * mouth_radius_m * std::tan(std::numbers::pi / cone_boxes);
  const double half_length_m = (mouth_radius_m - apex_radius_m) * std::numbers::sqrt2 / 2 + 0.004;
  // The ball touches 45 degree walls (tan 22.5 ahead of its centre), whose surface is a wall's thickness
  // off the box's middle; a millimetre of play on top.
  const double set_back_m = tip_radius_m * 0.4142 + wall_m * std::numbers::sqrt2 + 0.001;
  std::ostringstream text = precise_text();
  for (int k = 0; k < cone_boxes; ++k) {
    const double angle = 2 * std::numbers::pi * k / cone_boxes;
    const Vector3 radial(0, std::cos(angle), std::sin(angle));
    const Vector3 p_PG = (set_back_m - middle_m) * Vector3::UnitX() + middle_m * radial;
    const Vector3 x_P = (radial - Vector3::UnitX()).normalized();
    const Vector3 z_P(0, -std::sin(angle), std::cos(angle));
    text << "<geom name='" << geom_name << '_' << k << "' type='box' pos='" << numbers(port.p_JP_m + port.R_JP * p_PG)
         << "' xyaxes='" << numbers(port.R_JP * x_P) << ' ' << numbers(port.R_JP * z_P.cross(x_P)) << "' size='"
         << half_length_m << ' ' << wall_m << ' ' << half_width_m << "'" << cone_contact << "/>";
  }
  return text.str();
}

std::string link_body(const robot::Airframe& airframe, std::size_t module, std::size_t k, double scale) {
  const robot::JointGeometry& joint = airframe.joints[k];
  std::ostringstream text = precise_text();
  text << "<body name='" << name("link", module, k) << "' pos='" << numbers(joint.p_BJ_m) << "'>"
       << "<joint name='" << name("joint", module, k) << "' axis='" << numbers(joint.axis_B)
       << "' damping='2' armature='.02' limited='true' range='" << -1.05 * joint.position_rad_max << ' '
       << 1.05 * joint.position_rad_max << "'/>"
       << inertial(scale * joint.link_mass_kg, joint.p_JL_m, scale * joint.I_L_kg_m2);
  for (std::size_t p = 0; p < airframe.ports.size(); ++p) {
    const robot::PortGeometry& port = airframe.ports[p];
    if (port.joint != static_cast<int>(k)) continue;
    text << (port.kind == robot::PortKind::male ? tip(port, name("tip", module, p))
                                                : cone(port, name("cone", module, p)));
  }
  text << "</body>";
  return text.str();
}

/// What of a module can touch the floor: a foot under each rotor (three are a tripod, which stands still on
/// any floor), and, should it fall over, the rotors' guards.
std::string feet(const robot::Airframe& airframe) {
  std::ostringstream text = precise_text();
  for (const robot::RotorGeometry& rotor : airframe.rotors) {
    text << "<geom type='sphere' size='" << foot_radius_m << "' pos='"
         << numbers({rotor.p_BR_m.x(), rotor.p_BR_m.y(), foot_radius_m - rest_height_m}) << "'" << foot_contact
         << "/><geom type='sphere' size='" << guard_radius_m << "' pos='" << numbers(rotor.p_BR_m) << "'"
         << foot_contact << "/>";
  }
  return text.str();
}

std::string module_body(const robot::Airframe& airframe, std::size_t module, const ModuleStart& start,
                        const Mismatch& mismatch, bool floor) {
  const TrueInertia inertia = true_inertia(airframe, mismatch);
  const double z = floor ? std::max(start.p_WB_m[2], rest_height_m) : start.p_WB_m[2];
  std::ostringstream text = precise_text();
  text << "<body name='module" << module << "' pos='" << numbers({start.p_WB_m[0], start.p_WB_m[1], z}) << "' quat='"
       << std::cos(start.yaw_rad / 2) << " 0 0 " << std::sin(start.yaw_rad / 2) << "'><freejoint name='free" << module
       << "'/>" << inertial(inertia.body_mass_kg, inertia.p_B_body_com_m, inertia.I_body_kg_m2);
  if (floor) text << feet(airframe);
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
    text << link_body(airframe, module, k, inertia.link_scale);
  }
  text << "</body>";
  return text.str();
}

/// Calls `visit(male module, male port, female module, female port)` for every pair that may latch.
template <class Visit>
void each_pair(const robot::Airframe& airframe, std::size_t modules, Visit visit) {
  for (std::size_t i = 0; i < modules; ++i) {
    for (std::size_t a = 0; a < airframe.ports.size(); ++a) {
      if (airframe.ports[a].kind != robot::PortKind::male) continue;
      for (std::size_t j = 0; j < modules; ++j) {
        for (std::size_t b = 0; b < airframe.ports.size(); ++b) {
          if (i != j && airframe.ports[b].kind == robot::PortKind::female) visit(i, a, j, b);
        }
      }
    }
  }
}

std::string weld_name(std::size_t i, std::size_t a, std::size_t j, std::size_t b) {
  return name("weld", i, a) + "_" + name("", j, b);
}

void index_modules(WorldModel& world, const robot::Airframe& airframe, const std::vector<ModuleStart>& starts) {
  const mjModel* m = world.model.get();
  for (std::size_t i = 0; i < starts.size(); ++i) {
    ModuleIndex module{};
    module.id = starts[i].id;
    module.body = mj_name2id(m, mjOBJ_BODY, ("module" + std::to_string(i)).c_str());
    module.qpos = m->jnt_qposadr[m->body_jntadr[module.body]];
    module.dof = m->body_dofadr[module.body];
    module.p_B_com_m = Eigen::Map<const Vector3>(m->body_ipos + 3 * module.body);
    for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
      const int joint = mj_name2id(m, mjOBJ_JOINT, name("joint", i, k).c_str());
      module.joint_qpos[k] = m->jnt_qposadr[joint];
      module.joint_dof[k] = m->jnt_dofadr[joint];
    }
    world.modules.push_back(module);
    for (std::size_t p = 0; p < airframe.ports.size(); ++p) {
      const robot::PortGeometry& port = airframe.ports[p];
      const bool male = port.kind == robot::PortKind::male;
      const std::string geom = male ? name("tip", i, p) : name("cone", i, p) + "_0";
      world.ports.push_back(
          {.module = i,
           .port = p,
           .kind = port.kind,
           .link_body = mj_name2id(m, mjOBJ_BODY, name("link", i, static_cast<std::size_t>(port.joint)).c_str()),
           .X_LP = {port.p_JP_m, port.R_JP},
           .geom_first = mj_name2id(m, mjOBJ_GEOM, geom.c_str()),
           .geom_count = male ? 1 : cone_boxes});
    }
  }
  each_pair(airframe, starts.size(), [&](std::size_t i, std::size_t a, std::size_t j, std::size_t b) {
    world.pairs.push_back({.male = i * airframe.ports.size() + a,
                           .female = j * airframe.ports.size() + b,
                           .equality = mj_name2id(m, mjOBJ_EQUALITY, weld_name(i, a, j, b).c_str())});
  });
}

}  // namespace

Result<ModelPtr> compile_mjcf(const std::string& xml) {
  const std::unique_ptr<mjVFS, decltype(&std::free)> vfs(static_cast<mjVFS*>(std::malloc(sizeof(mjVFS))), &std::free);
  if (vfs == nullptr) return Error{"no memory for a model of the simulated world"};
  constexpr const char* file = "world.xml";
  // By default MuJoCo logs to a file in the working directory; the world reads its warning counters instead.
  mju_user_warning = [](const char*) {};
  mj_defaultVFS(vfs.get());
  if (mj_makeEmptyFileVFS(vfs.get(), file, static_cast<int>(xml.size())) != 0) {
    mj_deleteVFS(vfs.get());
    return Error{"MuJoCo's virtual file system refuses the world's model"};
  }
  std::memcpy(vfs->filedata[mj_findFileVFS(vfs.get(), file)], xml.data(), xml.size());
  char message[1000] = "";
  ModelPtr model(mj_loadXML(file, vfs.get(), message, sizeof message));
  mj_deleteVFS(vfs.get());
  if (model == nullptr) return Error{std::string("MuJoCo refuses the model of the simulated world: ") + message};
  return model;
}

std::string mjcf(const WorldConfig& config, const robot::Airframe& airframe, const std::vector<ModuleStart>& starts,
                 const std::vector<Mismatch>& mismatch) {
  const std::size_t n = starts.size();
  std::ostringstream text = precise_text();
  text << "<mujoco model='eciton'><compiler angle='radian' inertiafromgeom='false'/><option timestep='" << step_s
       << "' gravity='0 0 " << -robot::gravity_m_s2
       << "' integrator='Euler' solver='Newton' iterations='30' tolerance='1e-10'/><size njmax='" << 120 + 80 * n
       << "' nconmax='" << 20 + 20 * n
       << "'/><default><geom contype='0' conaffinity='0' mass='0'/></default><worldbody>";
  if (config.floor) text << "<geom name='floor' type='plane' size='50 50 1'" << floor_contact << "/>";
  for (std::size_t i = 0; i < n; ++i) text << module_body(airframe, i, starts[i], mismatch[i], config.floor);
  text << "</worldbody><contact>";
  for (std::size_t i = 0; i < n; ++i) {  // a module's own tip never reaches its own cone
    for (std::size_t a = 0; a < airframe.joints.size(); ++a) {
      for (std::size_t b = a + 1; b < airframe.joints.size(); ++b) {
        text << "<exclude body1='" << name("link", i, a) << "' body2='" << name("link", i, b) << "'/>";
      }
    }
  }
  text << "</contact><equality>";
  each_pair(airframe, n, [&](std::size_t i, std::size_t a, std::size_t j, std::size_t b) {
    text << "<weld name='" << weld_name(i, a, j, b) << "' body1='"
         << name("link", i, static_cast<std::size_t>(airframe.ports[a].joint)) << "' body2='"
         << name("link", j, static_cast<std::size_t>(airframe.ports[b].joint))
         << "' active='false' relpose='0 0 0 1 0 0 0' solimp='.99 .999 .0005'/>";
  });
  text << "</equality></mujoco>";
  return text.str();
}

Result<WorldModel> build_model(const WorldConfig& config, const robot::Airframe& airframe,
                               const std::vector<ModuleStart>& starts, const std::vector<Mismatch>& mismatch) {
  WorldModel world;
  Result<ModelPtr> model = compile_mjcf(mjcf(config, airframe, starts, mismatch));
  if (!model) return model.error();
  world.model = std::move(model).value();
  world.data.reset(mj_makeData(world.model.get()));
  if (world.data == nullptr) return Error{"MuJoCo has no memory for the simulated world"};
  index_modules(world, airframe, starts);
  return world;
}

}  // namespace eciton::hal::sim
