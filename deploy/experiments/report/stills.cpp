// One camera for all moments; one view too, unless the flight is so wide that its modules would be specks.
#include "deploy/experiments/report/stills.hpp"

#include <algorithm>
#include <utility>

#include "deploy/report/png.hpp"
#include "hal/sim/camera.hpp"

namespace eciton::deploy {
namespace {

constexpr double wider_at_most = 1.35;

/// Of each posture.
std::vector<hal::sim::View> views_of(const hal::sim::Camera& camera,
                                     const std::vector<std::vector<double>>& postures) {
  std::vector<hal::sim::View> views;
  double furthest_m = 0;
  for (const std::vector<double>& posture : postures) {
    views.push_back(camera.framing(std::span(&posture, 1)));
    furthest_m = std::max(furthest_m, views.back().distance_m);
  }
  const hal::sim::View shared = camera.framing(postures);
  if (shared.distance_m <= wider_at_most * furthest_m) std::fill(views.begin(), views.end(), shared);
  return views;
}

}  // namespace

Pictures render_stills(const std::vector<Still>& stills, const robot::Airframe& airframe,
                       const std::string& egl_library) {
  Pictures out;
  if (stills.empty()) return out;
  const std::size_t modules = hal::sim::modules_of(stills.front().posture, airframe);
  for (std::size_t i = 0; i < modules; ++i) {
    out.colours += (i == 0 ? "module " : ", ") + std::to_string(i + 1) + " " + hal::sim::module_colour(i);
  }
  hal::sim::CameraConfig config;
  if (!egl_library.empty()) config.egl_library = egl_library;
  Result<hal::sim::Camera> camera = hal::sim::Camera::open(airframe, modules, config);
  if (!camera) {
    out.notice = camera.error().message;
    return out;
  }
  std::vector<std::vector<double>> postures;
  for (const Still& still : stills) postures.push_back(still.posture);
  const std::vector<hal::sim::View> views = views_of(*camera, postures);
  for (std::size_t i = 0; i < stills.size(); ++i) {
    const Result<hal::sim::Picture> taken = camera->take(stills[i].posture, views[i]);
    const Result<std::string> file = taken ? report::png(taken->width, taken->height, taken->rgb) : taken.error();
    if (!file) {
      out.notice = file.error().message;
      continue;
    }
    out.pictures.push_back({stills[i].title, stills[i].time_s, *file});
  }
  return out;
}

}  // namespace eciton::deploy
