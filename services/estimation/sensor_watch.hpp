// What an IMU and a pose source say, judged before the filter sees it, and the bookkeeping of what was refused:
// totals for the heartbeat, and one report when a bad spell begins and one when it is over.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "services/estimation/error_state_filter.hpp"

namespace eciton::estimation {

enum class Refusal {
  none,
  not_finite,
  out_of_range,    // of any such sensor
  not_normalised,  // a quaternion
  bad_deviation,   // a standard deviation that is no positive number
  stamp_repeated,
  stamp_backward,
  stamp_ahead,  // of the module's own time, or of the IMU's
  too_late,     // older than the filter can roll back to
  frozen,       // the same bits again and again: a live sensor has noise
  implausible,  // beyond the filter's gate
  silent,       // nothing came
  count
};

/// For people; a static string.
const char* text(Refusal cause);

struct ImuCheckConfig {
  double specific_force_m_s2_max = 320;  // 32 g, the widest range of such chips
  double rate_rad_s_max = 70;            // 4000 deg/s, likewise
  double ahead_s_max = 0.05;             // of the module's time
  /// Equal samples in a row; 0: never. Standing still with motors off, six 16-bit values of a usual chip repeat
  /// together less than once in a hundred: ten times in a row they do not.
  int frozen_samples = 10;
};

struct PoseCheckConfig {
  double position_m_max = 1e5;
  double norm_error_max = 1e-3;  // of the quaternion
  /// Equal poses in a row; 0: never. Seven floating-point numbers with a noise of 0.1 mm do not repeat once.
  int frozen_samples = 3;
  int backward_max = 8;  // so many in a row behind, yet in order: the clock was set back
};

/// Counts how often the same values came in a row.
template <std::size_t N>
class Repetition {
 public:
  using Values = std::array<double, N>;
  /// How many equal ones end with this one.
  int count(const Values& values) {
    times_ = times_ > 0 && values == last_ ? times_ + 1 : 1;
    last_ = values;
    return times_;
  }

 private:
  Values last_{};
  int times_ = 0;
};

/// All but the order of stamps, which the filter judges. Real-time safe; one thread.
class ImuCheck {
 public:
  explicit ImuCheck(const ImuCheckConfig& config = {}) : config_(config) {}
  Refusal check(const ImuSample& sample, std::int64_t now_ns);

 private:
  ImuCheckConfig config_;
  Repetition<6> repetition_;
};

/// As it came: a quaternion (w, x, y, z), perhaps none.
struct RawPose {
  std::int64_t stamp_ns = 0;
  std::array<double, 3> p_WB_m{};
  std::array<double, 4> q_WB{};
  double position_std_m = 0;
  double attitude_std_rad = 0;
};

/// Real-time safe; one thread.
class PoseCheck {
 public:
  explicit PoseCheck(const PoseCheckConfig& config = {}) : config_(config) {}
  Refusal check(const RawPose& pose);
  /// The clock of the stamps began anew.
  void forget_stamps() { has_stamp_ = false; }

 private:
  Refusal check_stamp(std::int64_t stamp_ns);

  PoseCheckConfig config_;
  Repetition<7> repetition_;
  bool has_stamp_ = false;
  std::int64_t stamp_ns_ = 0;
  int backward_ = 0;  // in a row
  std::int64_t backward_ns_ = 0;
};

struct SpellConfig {
  double gather_s = 0.05;  // from the first refusal to the report, so that it can say how many
  double quiet_s = 1.0;    // without a refusal: over
  int implausible_min =
      5;  // fewer than so many beyond the gate, and nothing else, are no fault: 4e-5 of good ones are
};

struct SpellReport {
  bool over = false;
  Refusal cause = Refusal::none;  // the most frequent one
  std::uint64_t refused = 0;      // in this spell so far
  double lasted_s = 0;            // from the first refusal to the last
};

/// Refusals of one device. Real-time safe; one thread.
class RefusalSpell {
 public:
  explicit RefusalSpell(const SpellConfig& config = {}) : config_(config) {}

  void refuse(Refusal cause, std::int64_t now_ns);
  /// Nothing came: a spell too, but no sample was refused.
  void silent(std::int64_t now_ns) { open(Refusal::silent, now_ns); }
  /// At most two reports a spell, and so at most two per `quiet_s`.
  std::optional<SpellReport> report(std::int64_t now_ns);

  std::uint64_t refused() const { return refused_; }  // since the start

 private:
  void open(Refusal cause, std::int64_t now_ns);
  SpellReport describe(bool over) const;

  SpellConfig config_;
  std::uint64_t refused_ = 0;
  bool open_ = false, told_ = false;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::uint64_t refused_before_ = 0;
  std::array<std::uint64_t, static_cast<std::size_t>(Refusal::count)> causes_{};
};

}  // namespace eciton::estimation
