// Poses the picture model, frames it, renders it with MuJoCo into an off-screen buffer and reads that back.
#include "hal/sim/camera.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "hal/sim/model.hpp"
#include "hal/sim/off_screen.hpp"
#include "hal/sim/picture_model.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;

constexpr int geoms_max = 20'000;
/// Half of what a module takes to the right, up and towards the camera, and some air.
const Vector3 module_half_m(0.50, 0.34, 0.40);
constexpr double azimuth_rad = 1.78;  // a chain along x lies across the picture, and a little into it
constexpr double elevation_rad = -0.40;

std::size_t size_of_one(const robot::Airframe& airframe) {
  return 7 + airframe.joints.size() + 2 * airframe.rotors.size();
}

/// While it lives MuJoCo throws where it would end the process: its renderer has no other way to say what fails.
class ThrowingMujoco {
 public:
  ThrowingMujoco() : before_(mju_user_error) {
    mju_user_error = [](const char* message) { throw std::runtime_error(message); };
  }
  ~ThrowingMujoco() { mju_user_error = before_; }
  ThrowingMujoco(const ThrowingMujoco&) = delete;
  ThrowingMujoco& operator=(const ThrowingMujoco&) = delete;

 private:
  void (*before_)(const char*);
};

struct Box {
  Vector3 least = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 greatest = Vector3::Constant(-std::numeric_limits<double>::infinity());
};

}  // namespace

struct Camera::Impl {
  Impl(OffScreenContext&& off_screen_in, ModelPtr&& model_in, std::size_t size_in, const CameraConfig& config_in)
      : off_screen(std::move(off_screen_in)), model(std::move(model_in)), size(size_in), config(config_in) {
    mjv_defaultScene(&scene);
    mjr_defaultContext(&render);
    mjv_defaultOption(&option);
  }
  ~Impl() {
    mjr_freeContext(&render);
    mjv_freeScene(&scene);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Status prepare();

  OffScreenContext off_screen;
  ModelPtr model;
  DataPtr data;
  std::size_t size;  // of one module's part of a posture
  CameraConfig config;
  mjvScene scene;
  mjvOption option;
  mjrContext render;
};

Status Camera::Impl::prepare() try {
  const ThrowingMujoco throwing;
  data.reset(mj_makeData(model.get()));
  mjv_makeScene(model.get(), &scene, geoms_max);
  mjr_makeContext(model.get(), &render, mjFONTSCALE_100);
  mjr_setBuffer(mjFB_OFFSCREEN, &render);
  if (data == nullptr || render.currentBuffer != mjFB_OFFSCREEN) {
    return Error{"no pictures: OpenGL has no off-screen buffer"};
  }
  scene.flags[mjRND_FOG] = 1;
  return ok();
} catch (const std::runtime_error& refused) {
  return Error{std::string("no pictures: ") + refused.what()};
}

Camera::Camera(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Camera::~Camera() = default;
Camera::Camera(Camera&&) noexcept = default;
Camera& Camera::operator=(Camera&&) noexcept = default;

Result<Camera> Camera::open(const robot::Airframe& airframe, std::size_t modules, const CameraConfig& config) {
  if (modules == 0 || config.width < 16 || config.width > 2560 || config.height < 16 || config.height > 1440) {
    return Error{"no pictures: " + std::to_string(modules) + " modules on " + std::to_string(config.width) + " x " +
                 std::to_string(config.height) + "; it takes at least one, on 16 x 16 to 2560 x 1440"};
  }
  Result<OffScreenContext> off_screen = OffScreenContext::open(config.egl_library);
  if (!off_screen) return off_screen.error();
  Result<ModelPtr> model = compile_mjcf(picture_mjcf(airframe, modules, config.width, config.height));
  if (!model) return model.error();
  auto impl =
      std::make_unique<Impl>(std::move(off_screen).value(), std::move(model).value(), size_of_one(airframe), config);
  if (Status status = impl->prepare(); !status) return status.error();
  return Camera(std::move(impl));
}

View Camera::framing(std::span<const std::vector<double>> postures) const {
  // All that the camera will see, along its own axes: to the right, up, and towards it.
  const Vector3 sight(std::cos(elevation_rad) * std::cos(azimuth_rad),
                      std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
  const Vector3 right = sight.cross(Vector3::UnitZ()).normalized();
  robot::Matrix3 axes;
  axes << right, right.cross(sight), -sight;
  Box box;
  for (const std::vector<double>& posture : postures) {
    for (std::size_t at = 0; at + impl_->size <= posture.size(); at += impl_->size) {
      const Vector3 p = axes.transpose() * Vector3(posture.data() + at);
      box.least = box.least.cwiseMin(p - module_half_m);
      box.greatest = box.greatest.cwiseMax(p + module_half_m);
    }
  }
  if (!(box.least.x() <= box.greatest.x())) box.least = box.greatest = Vector3::Zero();
  const Vector3 half = 0.5 * (box.greatest - box.least);
  const double tangent = std::tan(0.5 * impl_->model->vis.global.fovy * std::numbers::pi / 180);
  const double aspect = static_cast<double>(impl_->config.width) / impl_->config.height;
  const double distance_m = half.z() + std::max(half.y(), half.x() / aspect) / tangent;
  return {.look_at_W_m = axes * (0.5 * (box.least + box.greatest)),
          .distance_m = std::max(distance_m, 1.0),
          .azimuth_rad = azimuth_rad,
          .elevation_rad = elevation_rad};
}

Result<Picture> Camera::take(const std::vector<double>& posture, const View& view) try {
  mjModel* m = impl_->model.get();
  mjData* d = impl_->data.get();
  if (posture.size() != static_cast<std::size_t>(m->nq)) {
    return Error{"no picture: a posture of " + std::to_string(posture.size()) + " numbers; this camera's has " +
                 std::to_string(m->nq)};
  }
  const ThrowingMujoco throwing;
  std::copy(posture.begin(), posture.end(), d->qpos);
  mj_kinematics(m, d);
  mj_comPos(m, d);
  mj_camlight(m, d);
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  for (int axis = 0; axis < 3; ++axis) camera.lookat[axis] = view.look_at_W_m[axis];
  camera.distance = view.distance_m;
  camera.azimuth = view.azimuth_rad * 180 / std::numbers::pi;
  camera.elevation = view.elevation_rad * 180 / std::numbers::pi;
  mjv_updateScene(m, d, &impl_->option, nullptr, &camera, mjCAT_ALL, &impl_->scene);
  Picture picture{impl_->config.width, impl_->config.height, {}};
  const mjrRect all{0, 0, picture.width, picture.height};
  const std::size_t row = 3 * static_cast<std::size_t>(picture.width);
  std::vector<std::uint8_t> upwards(row * static_cast<std::size_t>(picture.height));
  mjr_render(all, &impl_->scene, &impl_->render);
  mjr_readPixels(upwards.data(), nullptr, all, &impl_->render);
  picture.rgb.reserve(upwards.size());
  for (std::size_t y = upwards.size(); y > 0; y -= row) {
    picture.rgb.insert(picture.rgb.end(), upwards.data() + y - row, upwards.data() + y);
  }
  return picture;
} catch (const std::runtime_error& refused) {
  return Error{std::string("no picture: ") + refused.what()};
}

std::size_t modules_of(const std::vector<double>& posture, const robot::Airframe& airframe) {
  return posture.size() % size_of_one(airframe) == 0 ? posture.size() / size_of_one(airframe) : 0;
}

}  // namespace eciton::hal::sim
