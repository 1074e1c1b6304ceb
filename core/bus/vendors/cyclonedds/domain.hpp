// Domains of Cyclone DDS. A process may create each domain id once, with one configuration, so participants
// share it and the last one closes it.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/bus/plugin.h"
#include "core/bus/vendors/cyclonedds/vendor.hpp"

namespace eciton::bus::cyclonedds {

/// Writers made while it lives send no key hashes. The domain's own writers, of participants and endpoints, need them
/// (domain.cpp says why); a sample's key is its leading members, and each sample would be 24 bytes larger. The vendor
/// has one setting for all, which a writer reads when it is made.
class WithoutKeyHashes {
 public:
  /// Of the domain that the type is registered in.
  explicit WithoutKeyHashes(const ddsi_sertype& registered);
  ~WithoutKeyHashes();
  WithoutKeyHashes(const WithoutKeyHashes&) = delete;
  WithoutKeyHashes& operator=(const WithoutKeyHashes&) = delete;

  /// Held while a domain's own writers are made.
  static std::mutex& mutex();

 private:
  std::lock_guard<std::mutex> lock_;
  ddsi_domaingv* domain_;
};

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
