// The wrench observer's bias, measured in free hover before docking: a 5 % error of the thrust scale reads as
// 1.5 to 2 N of false contact force, and control on un-zeroed wrenches is worse than none.
#pragma once

#include "core/robot/frames.hpp"

namespace eciton::estimation {

struct ZeroingConfig {
  double duration_s = 6;
  double batch_s = 1;  // means over batches of this length give the quality, gusts included
  int samples_min = 300;
  double speed_m_s_max = 0.25;  // faster: not hovering, measured anew
  double rate_rad_s_max = 0.25;
  double timeout_s = 30;       // of being measured anew again and again
  double quality_N_max = 1.5;  // worse: refused
  double quality_Nm_max = 0.3;
};

enum class ZeroingPhase { idle, measuring, done, refused };

/// Constant part of the observer's output. Force in world axes (a false thrust scale lifts along gravity in
/// any attitude), moment in body axes (a false centre of mass turns with the body).
struct WrenchBias {
  robot::Vector3 force_W = robot::Vector3::Zero();
  robot::Vector3 moment_M = robot::Vector3::Zero();

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.force_W, self.moment_M);
  }
  robot::Wrench take_off(const robot::Wrench& wrench_W, const robot::Matrix3& R_WM) const {
    return {wrench_W.force - force_W, wrench_W.moment - R_WM * moment_M};
  }
};

/// Real-time safe; one thread.
class Zeroing {
 public:
  explicit Zeroing(const ZeroingConfig& config = {}) : config_(config) {}

  /// Begins to measure; the last bias stays in force until the new one is done.
  void start();
  /// One observer output (world axes) with the motion it belongs to.
  ZeroingPhase update(const robot::Wrench& wrench_W, const robot::Matrix3& R_WM, const robot::Vector3& v_WM,
                      const robot::Vector3& w_WM_M, double dt_s);

  ZeroingPhase phase() const { return phase_; }
  /// Why it was refused; a static string.
  const char* reason() const { return reason_; }
  bool zeroed() const { return zeroed_; }
  const WrenchBias& bias() const { return bias_; }
  /// Standard deviation of the bias itself, from the spread of the batches; the worst axis.
  double quality_N() const { return quality_N_; }
  double quality_Nm() const { return quality_Nm_; }
  int interruptions() const { return interruptions_; }

  /// The bias in force; a measurement under way begins again.
  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.zeroed_, self.bias_, self.quality_N_, self.quality_Nm_);
  }

 private:
  void begin();
  void close_batch();
  void finish();

  ZeroingConfig config_;
  ZeroingPhase phase_ = ZeroingPhase::idle;
  const char* reason_ = "";
  bool zeroed_ = false;
  WrenchBias bias_;
  double quality_N_ = 0, quality_Nm_ = 0;
  int interruptions_ = 0;
  double since_start_s_ = 0, measured_s_ = 0, batch_s_ = 0;
  int samples_ = 0, batch_samples_ = 0, batches_ = 0;
  robot::Vector6 batch_sum_ = robot::Vector6::Zero();
  robot::Vector6 mean_sum_ = robot::Vector6::Zero(), square_sum_ = robot::Vector6::Zero();  // of batch means
};

}  // namespace eciton::estimation
