// Slots for the bytes of samples, all reserved at creation and counted by reference. Memory is touched
// only as far as it is used, so a generous bound costs address space, not memory.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>

namespace eciton::bus::sim_network {

using KeyHash = std::array<std::uint8_t, 16>;

class SamplePool {
 public:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  struct Slot {
    std::uint64_t sequence;
    std::int64_t evicted_ns;  // when it left the writer's history
    KeyHash key;
    std::uint32_t size;
    std::uint32_t references;
    std::uint64_t origin;  // in a reader's pool: its writer's participant
  };

  SamplePool(std::uint32_t slots, std::uint32_t slot_size)
      : capacity_(slots),
        slot_size_(slot_size),
        slots_(std::make_unique_for_overwrite<Slot[]>(slots)),
        free_(std::make_unique_for_overwrite<std::uint32_t[]>(slots)),
        bytes_(std::make_unique_for_overwrite<std::uint8_t[]>(std::size_t{slots} * slot_size)) {}

  /// A copy of the sample with one reference, or `none` when all slots are in use.
  std::uint32_t acquire(std::span<const std::uint8_t> bytes, const KeyHash& key, std::uint64_t sequence) {
    if (bytes.size() > slot_size_ || (free_count_ == 0 && fresh_ == capacity_)) return none;
    const std::uint32_t slot = free_count_ > 0 ? free_[--free_count_] : fresh_++;
    slots_[slot] = {.sequence = sequence,
                    .evicted_ns = std::numeric_limits<std::int64_t>::max(),
                    .key = key,
                    .size = static_cast<std::uint32_t>(bytes.size()),
                    .references = 1,
                    .origin = 0};
    std::memcpy(data(slot), bytes.data(), bytes.size());
    return slot;
  }
  void retain(std::uint32_t slot) { ++slots_[slot].references; }
  void release(std::uint32_t slot) {
    if (--slots_[slot].references == 0) free_[free_count_++] = slot;
  }

  Slot& operator[](std::uint32_t slot) { return slots_[slot]; }
  std::span<const std::uint8_t> bytes(std::uint32_t slot) { return {data(slot), slots_[slot].size}; }

 private:
  std::uint8_t* data(std::uint32_t slot) { return bytes_.get() + std::size_t{slot} * slot_size_; }

  std::uint32_t capacity_;
  std::uint32_t slot_size_;
  std::uint32_t fresh_ = 0;       // slots from here on were never used
  std::uint32_t free_count_ = 0;  // those given back, used again last in, first out
  std::unique_ptr<Slot[]> slots_;
  std::unique_ptr<std::uint32_t[]> free_;
  std::unique_ptr<std::uint8_t[]> bytes_;
};

}  // namespace eciton::bus::sim_network
