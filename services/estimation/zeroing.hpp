// The wrench observer's bias, measured in free hover before docking: a 5 % error of the thrust scale reads as
// 1.5 to 2 N of false contact force, and control on un-zeroed wrenches is worse than none. The model's errors are
// fitted to means over batches by least squares, weighed by what is known of them before (Gauss-Markov). What
// a level hover cannot tell, such as the height of the centre of mass, stays as likely as it was; a hover at other
// attitudes tells it.
#pragma once

#include <array>

#include "core/robot/frames.hpp"
#include "core/robot/model_errors.hpp"

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
  robot::ModelTolerance tolerance{};  // before anything is measured
  double batch_std_N_min = 0.05;      // of a batch's mean, by noise and gusts; more when the batches differ by more
  double batch_std_Nm_min = 0.005;
};

enum class ZeroingPhase { idle, measuring, done, refused };

/// Real-time safe; one thread.
class Zeroing {
 public:
  static constexpr std::size_t batches_max = 30;  // longer batches are made of a longer duration
  explicit Zeroing(const ZeroingConfig& config = {});

  /// Begins to measure; the last zero stays in force until the new one is done.
  void start();
  /// One observer output (M's axes, about the composite centre of mass) with the state it belongs to.
  ZeroingPhase update(const robot::Wrench& wrench_M, const robot::BiasJacobian& jacobian_M,
                      const robot::Vector3& v_WM, const robot::Vector3& w_WM_M, double dt_s);

  ZeroingPhase phase() const { return phase_; }
  /// Why it was refused; a static string.
  const char* reason() const { return reason_; }
  bool zeroed() const { return zeroed_; }
  /// What the errors found make of the observer's output, in M's axes.
  robot::Wrench bias_M(const robot::BiasJacobian& jacobian_M) const {
    return robot::false_wrench_M(jacobian_M, errors_);
  }
  const robot::ModelErrors& errors() const { return errors_; }
  /// Standard deviation of the bias itself, from the spread of the batches; the worst axis.
  double quality_N() const { return quality_N_; }
  double quality_Nm() const { return quality_Nm_; }
  int interruptions() const { return interruptions_; }

  /// The zero in force; a measurement under way begins again.
  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.zeroed_, self.errors_, self.quality_N_, self.quality_Nm_);
  }

 private:
  void begin();
  void close_batch();
  void finish();
  /// With batches' means that spread by so much, in force and in moment.
  void fit(double batch_std_N, double batch_std_Nm);
  /// What the batches differ by from what was fitted: standard deviation of one, per axis.
  robot::Vector6 spread() const;

  ZeroingConfig config_;
  ZeroingPhase phase_ = ZeroingPhase::idle;
  const char* reason_ = "";
  bool zeroed_ = false;
  robot::ModelErrors errors_ = robot::ModelErrors::Zero();
  double quality_N_ = 0, quality_Nm_ = 0;
  int interruptions_ = 0;
  double since_start_s_ = 0, measured_s_ = 0, batch_s_ = 0;
  int samples_ = 0, batch_samples_ = 0;
  struct Batch {
    robot::Vector6 wrench_M = robot::Vector6::Zero();  // sums, then means
    robot::BiasJacobian jacobian_M = robot::BiasJacobian::Zero();
  };
  Batch batch_;
  std::array<Batch, batches_max> batches_;
  std::size_t batch_count_ = 0;
};

}  // namespace eciton::estimation
