// Takes pictures of a posture of the world (World::posture()), off screen. It has a model of its own, made to be
// looked at: the physics' model is neither read nor changed.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/robot/airframe.hpp"

namespace eciton::hal::sim {

struct CameraConfig {
  int width = 1120, height = 560;           // of the pictures, at most 2560 x 1440
  std::string egl_library = "libEGL.so.1";  // a name that cannot be loaded: no pictures
};

struct View {
  robot::Vector3 look_at_W_m;
  double distance_m;
  double azimuth_rad;    // the direction of sight, about z; 0 looks along x
  double elevation_rad;  // negative looks down
};

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top
};

/// "blue", "orange", …: what tells the modules apart, in their order; the colours come again after eight.
std::string module_colour(std::size_t module);

/// One thread: it owns that thread's OpenGL context.
class Camera {
 public:
  /// The Error names what is missing: EGL, OpenGL, memory.
  static Result<Camera> open(const robot::Airframe& airframe, std::size_t modules, const CameraConfig& config = {});
  ~Camera();
  Camera(Camera&&) noexcept;
  Camera& operator=(Camera&&) noexcept;

  /// From the side and above, with every module of all postures inside. Postures of one flight that share a view
  /// show what moved.
  View framing(std::span<const std::vector<double>> postures) const;
  /// An Error when the posture is not of this camera's modules.
  Result<Picture> take(const std::vector<double>& posture, const View& view);

 private:
  struct Impl;
  explicit Camera(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

/// How many modules of this airframe a posture is of; 0: of none.
std::size_t modules_of(const std::vector<double>& posture, const robot::Airframe& airframe);

}  // namespace eciton::hal::sim
