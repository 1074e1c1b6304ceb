// Position, velocity and attitude from an IMU and late, occasional pose measurements: a 15-state
// error-state Kalman filter. Error state: position (W), velocity (W), attitude (body: R_true = R exp(e)),
// gyroscope bias, accelerometer bias (body). The IMU sits at B's origin; poses are of B in W.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/robot/frames.hpp"

namespace eciton::estimation {

using robot::Matrix3;
using robot::Pose;
using robot::Vector3;
using robot::Vector6;

struct ImuSample {
  std::int64_t stamp_ns = 0;
  Vector3 specific_force_B_m_s2 = Vector3::Zero();
  Vector3 w_WB_B_rad_s = Vector3::Zero();
};

struct PoseMeasurement {
  std::int64_t stamp_ns = 0;  // when it was measured, on the IMU's clock
  Pose X_WB;
  double position_std_m = 0;
  double attitude_std_rad = 0;
};

struct ErrorStateFilterConfig {
  // Noise densities, somewhat above the sensors' own, to leave room for vibration.
  double accelerometer_noise_m_s2_rtHz = 0.010;
  double gyroscope_noise_rad_s_rtHz = 0.0010;
  double accelerometer_bias_walk_m_s2_rts = 2e-3;
  double gyroscope_bias_walk_rad_s_rts = 1e-4;
  // What is not known at the start. An attitude bias of the poses (10 mrad) reads as an accelerometer
  // bias of 0.1 m/s^2 and must fit into its spread.
  double velocity_std_initial_m_s = 1.0;
  double accelerometer_bias_std_initial_m_s2 = 0.12;
  double gyroscope_bias_std_initial_rad_s = 0.02;
  double bias_kept_stds = 3;         // at a new start: biases beyond so many of these spreads are dropped, not kept
  double position_std_min_m = 5e-4;  // of a measurement: no claim below this is believed
  double attitude_std_min_rad = 1e-3;
  double gate_chi2 = 30;            // 6 degrees of freedom: 4e-5 of good measurements are refused
  double restart_rejected_s = 0.5;  // refused for so long without a break: the filter is wrong, not they
  double future_s_max = 0.02;       // a pose may be newer than the newest IMU sample by this
  double imu_gap_s_max = 0.1;       // longer: what was known is lost
  int imu_backward_max = 25;        // so many in a row behind, yet in order: the clock was set back; begin anew
  double dead_reckoning_s = 0.25;   // age of the last good pose
  double lost_s = 2.0;
  double lost_position_std_m = 0.5;
  int ready_measurements = 8;  // and, to be ready for the first time:
  double ready_position_std_m = 0.05;
  double ready_velocity_std_m_s = 0.15;
  double ready_attitude_std_rad = 0.05;
  std::size_t buffer_samples = 128;  // of the IMU: how far back a pose may lie
};

enum class FilterMode { initialising, ready, dead_reckoning, lost };

enum class ImuVerdict {
  used,
  invalid,   // not finite
  repeated,  // the stamp of the one before
  backward,  // older than the one before
};

enum class PoseVerdict {
  fused,
  started,   // the filter (re)started from it
  rejected,  // by the gate
  too_old,   // older than the buffer
  too_new,   // further ahead of the newest IMU sample than can be bridged
  repeated,  // the IMU interval it lies in has had its pose: the same one again, or a source faster than the IMU
  invalid,   // not finite, no rotation, a standard deviation that is none, or before any IMU sample
};

struct Estimate {
  std::int64_t stamp_ns = 0;  // of the last IMU sample
  FilterMode mode = FilterMode::initialising;
  Pose X_WB;
  Vector3 v_WB = Vector3::Zero();
  Vector3 a_WB = Vector3::Zero();    // gravity taken off
  Vector3 w_WB_B = Vector3::Zero();  // bias taken off
  Vector3 gyroscope_bias = Vector3::Zero();
  Vector3 accelerometer_bias = Vector3::Zero();
  /// Position, attitude (body), velocity, angular velocity. Those of the pose are never below one measurement's:
  /// a source's constant offset and its drift do not average out, whatever the filter's P makes of their sum.
  std::array<double, 12> variance{};
  double pose_age_s = 0;  // since the last good pose; from the start without one
};

/// The last measurement put to the gate: what it said less what was expected, position (W) and attitude (body),
/// and the covariance that was expected of it.
struct Innovation {
  Vector6 value = Vector6::Zero();
  robot::Matrix6 covariance = robot::Matrix6::Identity();
  double chi2 = 0;  // 6 degrees of freedom
};

struct FilterCounters {
  std::uint64_t imu = 0;
  std::uint64_t imu_refused = 0;  // not finite, or not newer than the one before
  std::uint64_t imu_gaps = 0;
  std::uint64_t fused = 0;
  std::uint64_t rejected = 0;
  std::uint64_t too_old = 0;
  std::uint64_t too_new = 0;
  std::uint64_t repeated = 0;
  std::uint64_t invalid = 0;
  std::uint64_t restarts = 0;
};

/// Allocates in the constructor only. A late pose rolls back to its time and replays the IMU samples since:
/// at most `buffer_samples` predictions, the bound on the cost. Poses may come out of order. One thread.
///
/// On LiDAR odometry: its claimed deviation holds its drift, which is correlated over seconds. Taken as white noise
/// the drift is followed, slowly, and the innovations come out smaller than claimed (NIS below its mean, the gate
/// looser). A Schmidt filter with a drift state would claim a more honest P, but no better pose: one source's drift
/// cannot be seen beside its own pose, and the IMU's wander hides it within seconds. So the filter stays as it is,
/// and what it publishes of the pose is never claimed to be better than one measurement.
class ErrorStateFilter {
 public:
  using Covariance = Eigen::Matrix<double, 15, 15>;

  explicit ErrorStateFilter(const ErrorStateFilterConfig& config = {});

  /// One prediction, or a refusal, which is counted.
  ImuVerdict update(const ImuSample& sample);
  PoseVerdict update(const PoseMeasurement& measurement);

  Estimate estimate() const;
  const FilterCounters& counters() const { return counters_; }
  const Covariance& covariance() const { return newest().P; }
  const Innovation& innovation() const { return innovation_; }
  /// As if nothing had been measured yet, the counters apart.
  void forget();

 private:
  struct Nominal {
    Vector3 p = Vector3::Zero(), v = Vector3::Zero();
    Matrix3 R = Matrix3::Identity();
    Vector3 bg = Vector3::Zero(), ba = Vector3::Zero();
  };
  struct Entry {
    ImuSample imu;
    Nominal x;  // at the sample's time
    Covariance P = Covariance::Zero();
    std::optional<PoseMeasurement> pose;  // fused here
    bool occupied = false;                // a pose was fused here, or the filter started from one
  };

  Entry& at(std::size_t age) { return buffer_[(head_ + buffer_.size() - age) % buffer_.size()]; }
  const Entry& newest() const { return buffer_[head_]; }
  ImuVerdict judge(const ImuSample& sample);
  void begin_anew();
  void predict(const Entry& from, Entry& to) const;
  void replay(std::size_t age);
  std::optional<std::size_t> find(std::int64_t stamp_ns) const;
  /// Innovation and update at one entry; false: beyond the gate, nothing changed.
  bool fuse(Entry& entry, const PoseMeasurement& measurement, double gate_chi2, Innovation& innovation) const;
  void restart(Entry& entry, const PoseMeasurement& measurement);
  PoseVerdict start_at(std::size_t age, const PoseMeasurement& measurement);
  bool converged() const;
  void refresh_mode();

  ErrorStateFilterConfig config_;
  std::vector<Entry> buffer_;
  std::size_t head_ = 0;
  std::size_t count_ = 0;
  FilterMode mode_ = FilterMode::initialising;
  bool started_ = false;
  bool was_ready_ = false;
  int good_since_start_ = 0;
  std::int64_t last_good_ns_ = 0;
  std::optional<std::int64_t> rejected_since_ns_;
  int imu_backward_ = 0;  // in a row
  std::int64_t imu_backward_ns_ = 0;
  double position_std_m_ = 0, attitude_std_rad_ = 0;  // of the last good measurement
  Innovation innovation_;
  FilterCounters counters_;
};

}  // namespace eciton::estimation
