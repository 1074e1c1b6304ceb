// A reader's bounded queue of decoded samples: keep last per key, drops counted by cause. Used from one
// thread; allocates only when made.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/time.hpp"
#include "core/bus/codec.hpp"

namespace eciton::bus {

/// Every sample that arrived is in exactly one of delivered, replaced, or a dropped_* count, or queued. What the
/// vendor lost before is beside these: counted as far as the vendor tells (core/bus/plugin.h), and in none of them.
struct ReaderStatistics {
  std::uint64_t received = 0;
  std::uint64_t delivered = 0;
  std::uint64_t replaced = 0;           // by a newer one of its key before it was taken: keep last
  std::uint64_t dropped_malformed = 0;  // not a well-formed sample of the type
  std::uint64_t dropped_late = 0;       // a newer one of its key had been delivered (sensor class)
  std::uint64_t dropped_expired = 0;    // older than the topic's lifespan when taken
  std::uint64_t dropped_overflow = 0;   // over the queue's bound
  std::uint64_t vendor_lost = 0;        // on the way
  std::uint64_t vendor_rejected = 0;    // malformed, or over a bound of the vendor's
  std::uint64_t vendor_replaced = 0;    // by a newer one of its key, in the vendor's own history

  std::uint64_t dropped() const { return dropped_malformed + dropped_late + dropped_expired + dropped_overflow; }
  std::uint64_t dropped_by_vendor() const { return vendor_lost + vendor_rejected; }
};

template <Message T>
class Inbox {
 public:
  /// `keep_last`: 1 replaces the queued sample of the same key; more queues them all up to `capacity`.
  Inbox(std::size_t keep_last, std::size_t capacity, bool ordered)
      : keep_last_(keep_last), ordered_(ordered), slots_(capacity + 1), newest_(ordered ? capacity : 0) {}

  /// Returns the queued sample, nullptr if it was dropped.
  const T* push(std::span<const std::uint8_t> cdr, ReaderStatistics& statistics, std::uint64_t origin = 0) {
    ++statistics.received;
    // Decoded in place, into the slot that is always free: nothing gives way to a sample that is not wanted.
    Slot& slot = slots_[next(first_, count_)];
    if (!decode(cdr, slot.value)) {
      ++statistics.dropped_malformed;
      return nullptr;
    }
    slot.key = key_hash(slot.value);
    slot.origin = origin;
    if (ordered_ && !is_newest(slot)) {
      ++statistics.dropped_late;
      return nullptr;
    }
    if (keep_last_ == 1) {
      for (std::size_t k = 0; k < count_; ++k) {
        Slot& queued = slots_[next(first_, k)];
        if (queued.key != slot.key) continue;
        queued.value = slot.value;
        queued.origin = origin;
        ++statistics.replaced;
        return &queued.value;
      }
    }
    if (count_ + 1 == slots_.size()) {
      first_ = next(first_, 1);
      --count_;
      ++statistics.dropped_overflow;
    }
    ++count_;
    return &slot.value;
  }

  bool empty() const { return count_ == 0; }

  /// The oldest queued sample, valid until the next push; nullptr: none.
  const T* pop() {
    if (count_ == 0) return nullptr;
    const T* value = &slots_[first_].value;
    origin_ = slots_[first_].origin;
    first_ = next(first_, 1);
    --count_;
    return value;
  }

  /// Of the sample popped last.
  std::uint64_t origin() const { return origin_; }

 private:
  struct Slot {
    T value;
    KeyHash key;
    std::uint64_t origin = 0;
  };
  struct Newest {
    KeyHash key;
    std::int64_t stamp_ns;
  };
  /// A writer whose stamps fall back by more than this has restarted its clock; it is heard again.
  static constexpr Duration restart_gap = std::chrono::seconds(1);

  std::size_t next(std::size_t from, std::size_t by) const { return (from + by) % slots_.size(); }

  bool is_newest(const Slot& slot) {
    for (std::size_t k = 0; k < newest_count_; ++k) {
      Newest& n = newest_[k];
      if (n.key != slot.key) continue;
      const std::int64_t behind_ns = n.stamp_ns - slot.value.stamp_ns;
      if (behind_ns > 0 && behind_ns < restart_gap.count()) return false;
      n.stamp_ns = slot.value.stamp_ns;
      return true;
    }
    if (newest_count_ < newest_.size()) newest_[newest_count_++] = {slot.key, slot.value.stamp_ns};
    return true;
  }

  std::size_t keep_last_;
  bool ordered_;
  std::vector<Slot> slots_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::uint64_t origin_ = 0;
  std::vector<Newest> newest_;
  std::size_t newest_count_ = 0;
};

}  // namespace eciton::bus
