// Plates, arms, guards, gimbals, dock links and cones out of plain shapes, from the airframe's own numbers.
#include "hal/sim/picture_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <numbers>
#include <sstream>

#include "hal/sim/camera.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;

struct Colour {
  const char* name;
  const char* rgb;
};

constexpr std::array<Colour, 8> colours{{{"blue", ".16 .45 .85"},
                                         {"orange", ".93 .45 .10"},
                                         {"green", ".10 .62 .38"},
                                         {"violet", ".47 .33 .80"},
                                         {"red", ".83 .20 .24"},
                                         {"yellow", ".92 .70 .05"},
                                         {"turquoise", ".05 .62 .68"},
                                         {"pink", ".88 .38 .62"}}};
constexpr const char* carbon = ".16 .17 .19";
constexpr const char* metal = ".62 .64 .67";
constexpr double guard_radius_m = 0.108, propeller_radius_m = 0.1;

class Mjcf {
 public:
  Mjcf() {
    text_.imbue(std::locale::classic());
    text_.precision(9);
  }

  template <class... Parts>
  void add(const Parts&... parts) {
    (add_part(parts), ...);
  }
  void box(const Vector3& p, const Vector3& half, const char* rgb, double alpha = 1) {
    add("<geom type='box' pos='", p, "' size='", half, "' rgba='", rgb, ' ', alpha, "'/>");
  }
  void capsule(const Vector3& from, const Vector3& to, double radius, const char* rgb) {
    add("<geom type='capsule' fromto='", from, ' ', to, "' size='", radius, "' rgba='", rgb, " 1'/>");
  }
  void cylinder(const Vector3& from, const Vector3& to, double radius, const char* rgb, double alpha = 1) {
    add("<geom type='cylinder' fromto='", from, ' ', to, "' size='", radius, "' rgba='", rgb, ' ', alpha, "'/>");
  }
  std::string text() const { return text_.str(); }

 private:
  void add_part(const Vector3& v) { text_ << v.x() << ' ' << v.y() << ' ' << v.z(); }
  template <class Part>
  void add_part(const Part& part) {
    text_ << part;
  }

  std::ostringstream text_;
};

void add_guard(Mjcf& out, const Vector3& p_BR, const char* rgb) {
  constexpr int pieces = 24;
  const auto on_ring = [&](int k) {
    const double angle = 2 * std::numbers::pi * k / pieces;
    return Vector3(p_BR + guard_radius_m * Vector3(std::cos(angle), std::sin(angle), 0));
  };
  for (int k = 0; k < pieces; ++k) out.capsule(on_ring(k), on_ring(k + 1), 0.0055, rgb);
}

/// A fixed guard; in it the rotor on its two gimbals, thrust along Rx(phi) Ry(theta) e_z.
void add_rotor(Mjcf& out, const robot::RotorGeometry& rotor, const char* rgb) {
  const Vector3 p = rotor.p_BR_m;
  const Vector3 outwards = Vector3(p.x(), p.y(), 0).normalized();
  add_guard(out, p, rgb);
  // The arm comes from below, ends under the gimbal and carries the guard by three struts.
  const Vector3 foot(p.x(), p.y(), p.z() - 0.035);
  out.capsule(Vector3(0, 0, -0.002) + 0.04 * outwards, foot, 0.009, carbon);
  for (const double turn : {0.0, 2.0944, 4.1888}) {
    const Vector3 edge = p + guard_radius_m * (Eigen::AngleAxisd(turn, Vector3::UnitZ()) * outwards);
    out.capsule(foot, edge, 0.004, carbon);
  }
  out.add("<body pos='", p, "'><joint axis='1 0 0'/>");
  out.box(Vector3::Zero(), {0.026, 0.005, 0.005}, metal);
  out.add("<body><joint axis='0 1 0'/>");
  out.cylinder({0, 0, -0.016}, {0, 0, 0.014}, 0.017, carbon);
  out.cylinder({0, 0, 0.017}, {0, 0, 0.0185}, propeller_radius_m, ".35 .37 .40", 0.28);
  out.box({0, 0, 0.0185}, {propeller_radius_m, 0.009, 0.0015}, ".25 .26 .28", 0.9);
  out.cylinder({0, 0, 0.014}, {0, 0, 0.026}, 0.009, rgb);
  out.add("</body></body>");
}

/// Discs that grow away from the docking point at 45 degrees, as the peer's cone does.
void add_male_cone(Mjcf& out, const robot::PortGeometry& port) {
  constexpr int discs = 18;
  constexpr double length_m = 0.045;
  const Vector3 x = port.R_JP.col(0);
  for (int k = 0; k < discs; ++k) {
    const double from = length_m * k / discs, to = length_m * (k + 1) / discs;
    out.cylinder(port.p_JP_m - to * x, port.p_JP_m - from * x, 0.010 + to, metal);
  }
}

void add_female_cone(Mjcf& out, const robot::PortGeometry& port, const char* rgb) {
  constexpr int walls = 24;
  constexpr double apex_radius_m = 0.016, mouth_radius_m = 0.075;
  const double half_width_m = 1.1 * mouth_radius_m * std::tan(std::numbers::pi / walls);
  const double half_length_m = (mouth_radius_m - apex_radius_m) * std::numbers::sqrt2 / 2;
  const double middle_m = 0.5 * (apex_radius_m + mouth_radius_m);
  for (int k = 0; k < walls; ++k) {
    const double angle = 2 * std::numbers::pi * k / walls;
    const Vector3 radial(0, std::cos(angle), std::sin(angle));
    const Vector3 x_P = (radial - Vector3::UnitX()).normalized();
    const Vector3 y_P = Vector3(0, -std::sin(angle), std::cos(angle)).cross(x_P);
    const Vector3 p_PG = (apex_radius_m - middle_m) * Vector3::UnitX() + middle_m * radial;
    out.add("<geom type='box' pos='", Vector3(port.p_JP_m + port.R_JP * p_PG), "' xyaxes='", Vector3(port.R_JP * x_P),
            ' ', Vector3(port.R_JP * y_P), "' size='", Vector3(half_length_m, 0.0022, half_width_m), "' rgba='", rgb,
            " 1'/>");
  }
}

void add_link(Mjcf& out, const robot::Airframe& airframe, std::size_t k, const char* rgb) {
  const robot::JointGeometry& joint = airframe.joints[k];
  out.add("<body pos='", joint.p_BJ_m, "'><joint axis='", joint.axis_B, "'/>");
  out.cylinder(-0.032 * joint.axis_B, 0.032 * joint.axis_B, 0.018, metal);
  for (const robot::PortGeometry& port : airframe.ports) {
    if (port.joint != static_cast<int>(k)) continue;
    const Vector3 x = port.R_JP.col(0);
    if (port.kind == robot::PortKind::male) {
      out.capsule(Vector3::Zero(), port.p_JP_m - 0.045 * x, 0.014, carbon);
      add_male_cone(out, port);
    } else {
      out.capsule(Vector3::Zero(), port.p_JP_m + 0.016 * x, 0.014, carbon);
      add_female_cone(out, port, rgb);
    }
  }
  out.add("</body>");
}

void add_module(Mjcf& out, const robot::Airframe& airframe, std::size_t module) {
  const char* rgb = colours[module % colours.size()].rgb;
  out.add("<body pos='", static_cast<double>(module), " 0 1'><freejoint/>");
  out.box({0.01, 0, -0.002}, {0.085, 0.060, 0.006}, carbon);
  out.box({0.015, 0, 0.024}, {0.060, 0.042, 0.020}, rgb);
  out.box({0.01, 0, -0.030}, {0.062, 0.032, 0.022}, ".30 .31 .34");
  if (airframe.name == "legion-lidar") out.cylinder({0.015, 0, 0.044}, {0.015, 0, 0.105}, 0.032, ".12 .12 .13");
  for (const robot::JointGeometry& joint : airframe.joints) {
    const Vector3 end = joint.p_BJ_m;
    for (const double side : {-0.022, 0.022}) {
      out.capsule({0.03 * (end.x() > 0 ? 1 : -1), side, -0.004}, {end.x(), end.y() + 0.4 * side, end.z()}, 0.006,
                  carbon);
    }
  }
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) add_link(out, airframe, k, rgb);
  for (const robot::RotorGeometry& rotor : airframe.rotors) add_rotor(out, rotor, rgb);
  out.add("</body>");
}

}  // namespace

std::string module_colour(std::size_t module) { return colours[module % colours.size()].name; }

std::string picture_mjcf(const robot::Airframe& airframe, std::size_t modules, int width, int height) {
  Mjcf out;
  out.add("<mujoco model='picture'><compiler angle='radian'/><statistic extent='2' center='0 0 1'/><visual>",
          "<global offwidth='", width, "' offheight='", height, "' fovy='32'/>",
          "<quality offsamples='4' shadowsize='4096'/><map znear='.02' zfar='60' fogstart='4' fogend='12'/>",
          "<headlight ambient='.42 .42 .42' diffuse='.34 .34 .34' specular='.1 .1 .1'/><rgba fog='.97 .98 .99 1'/>",
          "</visual><default><geom contype='0' conaffinity='0'/></default><asset>",
          "<texture type='skybox' builtin='gradient' rgb1='.97 .98 .99' rgb2='.90 .93 .97' width='64' height='384'/>",
          "<texture name='tiles' type='2d' builtin='checker' rgb1='.90 .915 .93' rgb2='.865 .885 .905' mark='edge' ",
          "markrgb='.78 .80 .83' width='512' height='512'/>",
          "<material name='floor' texture='tiles' texuniform='true' texrepeat='1 1' specular='0' reflectance='0'/>",
          "</asset><worldbody>",
          "<light directional='true' pos='0 0 6' dir='.35 .45 -1' diffuse='.5 .5 .5' specular='.15 .15 .15'/>",
          "<geom type='plane' size='40 40 1' material='floor'/>");
  for (std::size_t i = 0; i < modules; ++i) add_module(out, airframe, i);
  out.add("</worldbody></mujoco>");
  return out.text();
}

}  // namespace eciton::hal::sim
