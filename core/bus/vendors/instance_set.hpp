// The distinct keys that an endpoint has seen, up to its bound: what comes after is refused, not stored.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace eciton::bus::vendors {

using InstanceKey = std::array<std::uint8_t, 16>;

/// Open addressing, all memory allocated at construction. Real-time safe, not thread-safe.
class InstanceSet {
 public:
  explicit InstanceSet(std::uint32_t keys_max) : keys_max_(keys_max) {
    std::size_t slots = 4;
    while (slots < 2 * static_cast<std::size_t>(keys_max)) slots *= 2;
    slots_.resize(slots);
  }

  /// Whether the key is known, or was new and there was room for it.
  bool admit(const InstanceKey& key) {
    std::size_t k = hash(key) & (slots_.size() - 1);
    while (slots_[k].used) {
      if (slots_[k].key == key) return true;
      k = (k + 1) & (slots_.size() - 1);
    }
    if (keys_ == keys_max_) return false;
    slots_[k] = {key, true};
    ++keys_;
    return true;
  }

 private:
  struct Slot {
    InstanceKey key{};
    bool used = false;
  };
  static std::size_t hash(const InstanceKey& key) {
    std::uint64_t h = 14695981039346656037u;  // FNV-1a
    for (const std::uint8_t byte : key) h = (h ^ byte) * 1099511628211u;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }

  std::vector<Slot> slots_;
  std::uint32_t keys_max_;
  std::uint32_t keys_ = 0;
};

}  // namespace eciton::bus::vendors
