// Broken sensors, on demand: what a fault makes of the samples that it befalls.
#pragma once

#include <array>
#include <limits>

#include "hal/interfaces.hpp"
#include "hal/sim/random.hpp"

namespace eciton::hal::sim {

enum class SimSensor { imu, pose };

enum class SensorFaultKind {
  none,
  silent,          // no sample comes
  frozen,          // the values of the last good sample under new stamps
  nan,             // one value is no number
  stamp_repeated,  // new values under the stamp of the last sample
  stamp_backward,  // stamps run backward from when the fault began
  jump             // values off by `jump`: of the specific force, m/s^2; of the position, m
};

struct SensorFault {
  SensorFaultKind kind = SensorFaultKind::none;
  double share = 1;  // of the samples, at random
  std::array<double, 3> jump{1, 0, 0};
};

/// One sensor's faults; its random numbers are its own, so that a fault shifts nobody's noise. Real-time safe.
class FaultySensor {
 public:
  explicit FaultySensor(Random random) : random_(random) {}

  void set(const SensorFault& fault, TimePoint now) {
    fault_ = fault;
    since_ = now;
  }

  /// What becomes of `fresh` after `last`. False: it does not come.
  template <class Reading>
  bool befall(Reading& fresh, const Reading& last) {
    if (fault_.kind == SensorFaultKind::none || random_.uniform() >= fault_.share) return true;
    const TimePoint stamp = fresh.stamp;
    std::array<double, 3>& values = vector_of(fresh);
    switch (fault_.kind) {
      case SensorFaultKind::none:
        break;
      case SensorFaultKind::silent:
        return false;
      case SensorFaultKind::frozen:
        fresh = last;
        fresh.stamp = stamp;
        break;
      case SensorFaultKind::nan:
        values[1] = std::numeric_limits<double>::quiet_NaN();
        break;
      case SensorFaultKind::stamp_repeated:
        fresh.stamp = last.stamp;
        break;
      case SensorFaultKind::stamp_backward:
        fresh.stamp = since_ - (stamp - since_);
        break;
      case SensorFaultKind::jump:
        for (std::size_t k = 0; k < values.size(); ++k) values[k] += fault_.jump[k];
        break;
    }
    return true;
  }

 private:
  static std::array<double, 3>& vector_of(ImuReading& reading) { return reading.specific_force_M_m_s2; }
  static std::array<double, 3>& vector_of(PoseReading& reading) { return reading.p_WB_m; }

  SensorFault fault_;
  TimePoint since_{};
  Random random_;
};

}  // namespace eciton::hal::sim
