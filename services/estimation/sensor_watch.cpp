// Judging samples, and counting what was refused.
#include "services/estimation/sensor_watch.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::estimation {
namespace {

template <std::size_t N>
bool finite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool deviation(double value) { return std::isfinite(value) && value > 0; }

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

const char* text(Refusal cause) {
  switch (cause) {
    case Refusal::not_finite:
      return "not finite";
    case Refusal::out_of_range:
      return "out of any sensor's range";
    case Refusal::not_normalised:
      return "a quaternion not of length 1";
    case Refusal::bad_deviation:
      return "a standard deviation that is not positive";
    case Refusal::stamp_repeated:
      return "a stamp repeated";
    case Refusal::stamp_backward:
      return "stamps that run backward";
    case Refusal::stamp_ahead:
      return "stamps from the future";
    case Refusal::too_late:
      return "too late";
    case Refusal::frozen:
      return "frozen, the same value again and again";
    case Refusal::implausible:
      return "far from what was expected";
    case Refusal::silent:
      return "silent";
    case Refusal::none:
    case Refusal::count:
      break;
  }
  return "";
}

Refusal ImuCheck::check(const ImuSample& sample, std::int64_t now_ns) {
  const Vector3 &f = sample.specific_force_B_m_s2, &w = sample.w_WB_B_rad_s;
  if (!f.allFinite() || !w.allFinite()) return Refusal::not_finite;
  if (f.norm() > config_.specific_force_m_s2_max || w.norm() > config_.rate_rad_s_max) return Refusal::out_of_range;
  if (seconds(sample.stamp_ns - now_ns) > config_.ahead_s_max) return Refusal::stamp_ahead;
  const int equal = repetition_.count({f.x(), f.y(), f.z(), w.x(), w.y(), w.z()});
  if (config_.frozen_samples > 0 && equal >= config_.frozen_samples) return Refusal::frozen;
  return Refusal::none;
}

Refusal PoseCheck::check(const RawPose& pose) {
  const std::array<double, 3>& p = pose.p_WB_m;
  const std::array<double, 4>& q = pose.q_WB;
  if (!finite(p) || !finite(q)) return Refusal::not_finite;
  if (std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) > config_.position_m_max) {
    return Refusal::out_of_range;
  }
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (std::abs(norm - 1) > config_.norm_error_max) return Refusal::not_normalised;
  if (!deviation(pose.position_std_m) || !deviation(pose.attitude_std_rad)) return Refusal::bad_deviation;
  if (const Refusal stamp = check_stamp(pose.stamp_ns); stamp != Refusal::none) return stamp;
  const int equal = repetition_.count({p[0], p[1], p[2], q[0], q[1], q[2], q[3]});
  if (config_.frozen_samples > 0 && equal >= config_.frozen_samples) return Refusal::frozen;
  return Refusal::none;
}

Refusal PoseCheck::check_stamp(std::int64_t stamp_ns) {
  if (has_stamp_ && stamp_ns == stamp_ns_) return Refusal::stamp_repeated;
  if (!has_stamp_ || stamp_ns > stamp_ns_) {
    has_stamp_ = true;
    stamp_ns_ = stamp_ns;
    backward_ = 0;
    return Refusal::none;
  }
  // A single source does not send out of order: what is older is wrong, until it goes on so, in order.
  backward_ = backward_ > 0 && stamp_ns > backward_ns_ ? backward_ + 1 : 1;
  backward_ns_ = stamp_ns;
  if (backward_ < config_.backward_max) return Refusal::stamp_backward;
  stamp_ns_ = stamp_ns;
  backward_ = 0;
  return Refusal::none;
}

void RefusalSpell::refuse(Refusal cause, std::int64_t now_ns) {
  open(cause, now_ns);
  ++refused_;
}

void RefusalSpell::open(Refusal cause, std::int64_t now_ns) {
  if (!open_) {
    open_ = true;
    told_ = false;
    first_ns_ = now_ns;
    refused_before_ = refused_;
    causes_.fill(0);
  }
  last_ns_ = now_ns;
  ++causes_[static_cast<std::size_t>(cause)];
}

SpellReport RefusalSpell::describe(bool over) const {
  const auto most = std::max_element(causes_.begin(), causes_.end());
  return {.over = over,
          .cause = static_cast<Refusal>(most - causes_.begin()),
          .refused = refused_ - refused_before_,
          .lasted_s = seconds(last_ns_ - first_ns_)};
}

std::optional<SpellReport> RefusalSpell::report(std::int64_t now_ns) {
  if (!open_) return std::nullopt;
  // Also when the clock was set back: no spell lasts for ever for that.
  const bool over = seconds(now_ns - last_ns_) >= config_.quiet_s || now_ns < last_ns_;
  const auto implausible = causes_[static_cast<std::size_t>(Refusal::implausible)];
  const SpellReport report = describe(over);
  const bool counts = report.refused != implausible || report.cause == Refusal::silent ||
                      implausible >= static_cast<std::uint64_t>(config_.implausible_min);
  if (over) open_ = false;
  if (!counts) return std::nullopt;
  if (over) return told_ ? std::optional(report) : std::nullopt;
  if (told_ || seconds(now_ns - first_ns_) < config_.gather_s) return std::nullopt;
  told_ = true;
  return report;
}

}  // namespace eciton::estimation
