// The model that pictures are taken of: the airframe as it looks, with no physics in it.
#pragma once

#include <string>

#include "core/robot/airframe.hpp"

namespace eciton::hal::sim {

/// MJCF. The coordinates are those of World::posture(), in its order.
std::string picture_mjcf(const robot::Airframe& airframe, std::size_t modules, int width, int height);

}  // namespace eciton::hal::sim
