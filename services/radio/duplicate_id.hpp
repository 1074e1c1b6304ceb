// Two modules with one id: beacons of two incarnations that go on arriving by turns. One that gives way to
// another, once, is a restart; one that comes back with newer stamps is another module.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/time.hpp"

namespace eciton::radio {

struct DuplicateIdConfig {
  std::uint32_t returns = 2;    // of an incarnation that had given way, before it is called a duplicate
  Duration forget_after = 30s;  // without another return
};

/// One for each id; for the own id it is fed with the beacons sent as well. Real-time safe.
class DuplicateId {
 public:
  DuplicateId() = default;
  explicit DuplicateId(const DuplicateIdConfig& config) : config_(config) {}

  /// `stamp` is the beacon's own: an old one that comes late is no return.
  void hear(TimePoint now, std::uint64_t incarnation, TimePoint stamp);
  bool met(TimePoint now) const;

 private:
  struct Life {
    std::uint64_t incarnation;
    TimePoint stamp;
  };

  DuplicateIdConfig config_;
  std::optional<Life> current_;
  std::optional<Life> previous_;
  std::uint32_t returns_ = 0;
  TimePoint last_return_{};
};

}  // namespace eciton::radio
