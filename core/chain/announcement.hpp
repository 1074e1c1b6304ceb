// What a module announces about the view it holds, and the table of everyone's last announcement.
#pragma once

#include "core/base/time.hpp"
#include "core/chain/registers.hpp"
#include "core/chain/view.hpp"

namespace eciton::chain {

enum class ViewPhase : std::uint8_t {
  none,      // holds no view yet: it has not spoken for all its ports since it started
  proposed,  // holds the view, which is not active here; the one active before stays so
  active
};

struct Announcement {
  std::uint32_t module = 0;
  std::uint64_t incarnation = 0;
  std::uint64_t sequence_number = 0;  // grows with every change within one incarnation
  std::uint64_t epoch = 0;            // of the view held
  ViewPhase phase = ViewPhase::none;
  TimePoint start{};  // on the clock of the view's base, whoever announces it; zero: not decided

  bool operator==(const Announcement&) const = default;
  bool has_start() const { return start != TimePoint{}; }

  auto key() const { return module; }
  auto version() const { return std::tuple(incarnation, sequence_number); }
  auto content() const { return std::tuple(epoch, phase, start); }
};

/// One register per module, joined as claims are.
using AnnouncementTable = Registers<Announcement, 4 * max_modules>;

}  // namespace eciton::chain
