// Domains of Cyclone DDS. A process may create each domain id once, with one configuration, so participants
// share it and the last one closes it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/bus/plugin.h"

namespace eciton::bus::cyclonedds {

class SharedDomain {
 public:
  /// Opens the domain or joins it; another configuration than the first is an error that names both.
  static Result<SharedDomain> acquire(const eciton_participant_config& config);
  SharedDomain(SharedDomain&& other) noexcept : id_(other.id_), held_(other.held_) { other.held_ = false; }
  SharedDomain& operator=(SharedDomain&&) = delete;
  ~SharedDomain();

 private:
  explicit SharedDomain(std::uint32_t id) : id_(id) {}
  std::uint32_t id_;
  bool held_ = true;
};

}  // namespace eciton::bus::cyclonedds
