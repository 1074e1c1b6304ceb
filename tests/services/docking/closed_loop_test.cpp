// The follower's and the target's sequences in a noisy, kinematic world: gusts, drifting estimates, a cone
// that centres, a wall that pushes back and latches that close only when all is in place.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <random>

#include "services/docking/docking_sequence.hpp"
#include "services/docking/target_sequence.hpp"

namespace eciton::docking {
namespace {

constexpr double dt_s = 0.002;
constexpr double mass_kg = 3.9;

struct Trial {
  bool docked = false;
  double seconds = 0;
  DockingOutputs last;
};

class Loop {
 public:
  Loop(std::uint64_t seed, double gust_N, bool cone = true)
      : random_(seed), gust_N_(gust_N), cone_(cone), port_(seed % 2 == 0 ? PortKind::male : PortKind::female) {
    // maths.md section 4: start gap 1.5 +- 0.3 m, lateral +- 0.4, vertical +- 0.3 m
    p_ = (1.5 + 0.3 * uniform()) * outward_T(port_) + Vector3(0, 0.4 * uniform(), 0.3 * uniform());
    drift_ = 0.01 * normal3();
  }

  Trial run(const DockingConfig& config = {}) {
    DockingSequence follower(config);
    TargetSequence target{TargetConfig{}};
    in_.X_TF.p = p_;
    follower.start_docking(port_, in_.X_TF);
    target.accept();
    Trial trial;
    for (; trial.seconds < 30 && follower.outputs().outcome == Outcome::running; trial.seconds += dt_s) {
      measure();
      const DockingOutputs& out = follower.update(dt_s, in_);
      const TargetOutputs& t = target.update(dt_s, {.follower_fresh = true,
                                                    .follower_phase = out.phase,
                                                    .latch = in_.target_latch,
                                                    .view_active = in_.view_active,
                                                    .abort = false});
      move(out);
      latch(out.engage_latch && t.engage_latch);
    }
    trial.last = follower.outputs();
    trial.docked = trial.last.outcome == Outcome::docked && target.outputs().phase == DockingPhase::docked;
    return trial;
  }

 private:
  double uniform() { return 2 * static_cast<double>(random_() >> 11) * 0x1p-53 - 1; }
  double normal() {  // Irwin-Hall of 12, near enough
    double sum = 0;
    for (int k = 0; k < 12; ++k) sum += uniform();
    return sum / 2;
  }
  Vector3 normal3() { return {normal(), normal(), normal()}; }

  void measure() {
    drift_ = drift_ * std::exp(-dt_s / 10) + 0.01 * std::sqrt(1 - std::exp(-2 * dt_s / 10)) * normal3();
    if (drift_.norm() > 0.028) drift_ *= 0.028 / drift_.norm();
    in_.X_TF.p = p_ + drift_ + 0.001 * normal3();
    in_.X_TF.R = robot::exp_so3(0.005 * normal3());
    push_N_ += (1 - std::exp(-dt_s * 8)) * (contact_.dot(outward_T(port_)) + 0.3 * normal() - push_N_);
    in_.push_N = push_N_;
    in_.target_fresh = true;
  }

  void move(const DockingOutputs& out) {
    const double a = std::exp(-dt_s / 1.0);
    gust_ = a * gust_ + std::sqrt(1 - a * a) * gust_N_ * normal3().cwiseProduct(Vector3(1, 1, .5));
    observed_ += (1 - std::exp(-dt_s * 6)) * (gust_ - observed_);  // the feed-forward of the wrench observer
    const Vector3 p_seen = in_.X_TF.p;
    const Vector3 force =
        mass_kg * (20 * (out.X_TF_reference.p - p_seen) + 8 * (out.v_TF_reference - v_)) - observed_;
    contact_.setZero();
    const Vector3 outward = outward_T(port_);
    const double gap_m = outward.dot(p_);
    const Vector3 beside = p_ - gap_m * outward;
    // A cone of 45 degrees, 50 mm deep, with its apex at the docking point; a flat face around it.
    const double wall_m = cone_ ? std::min(beside.norm(), 0.05) : 0.05;
    if (gap_m < wall_m && gap_m > -0.2) {
      const double depth_m = wall_m - gap_m;
      contact_ += 3000 * depth_m * outward - 60 * v_.dot(outward) * outward;
      if (cone_ && beside.norm() > 1e-4)
        contact_ -= 3000 * depth_m * beside.normalized() + 60 * (v_ - v_.dot(outward) * outward);
    }
    v_ += dt_s / mass_kg * (force + gust_ + contact_);
    p_ += dt_s * v_;
    if (latched_) p_ = v_ = Vector3::Zero();
  }

  void latch(bool engaged) {
    const double gap_m = outward_T(port_).dot(p_);
    if (engaged && std::abs(gap_m) < 0.006 && std::hypot(p_.y(), p_.z()) < 0.008) latched_ = true;
    if (!engaged) latched_ = false;
    in_.latch = in_.target_latch = latched_ ? LatchStatus::latched : LatchStatus::open;
    view_s_ = latched_ ? view_s_ + dt_s : 0;
    in_.view_active = view_s_ > 0.25;
  }

  std::mt19937_64 random_;
  double gust_N_;
  bool cone_;
  PortKind port_;
  DockingInputs in_;
  Vector3 p_ = Vector3::Zero(), v_ = Vector3::Zero(), drift_ = Vector3::Zero(), gust_ = Vector3::Zero();
  Vector3 observed_ = Vector3::Zero(), contact_ = Vector3::Zero();
  double push_N_ = 0, view_s_ = 0;
  bool latched_ = false;
};

TEST(ClosedLoopTest, DocksInGustsFromEitherSide) {
  for (const double gust_N : {0.0, 1.0, 2.0}) {
    double seconds = 0, worst_s = 0;
    unsigned by_wrench = 0, recoveries = 0, false_declarations = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const Trial trial = Loop(seed, gust_N).run();
      EXPECT_TRUE(trial.docked) << "seed " << seed << ", gust " << gust_N << " N: " << to_text(trial.last.failure);
      seconds += trial.seconds / 40;
      worst_s = std::max(worst_s, trial.seconds);
      by_wrench += trial.last.declared_by == DeclaredBy::wrench;
      recoveries += trial.last.recoveries;
      false_declarations += trial.last.false_declarations;
    }
    std::cout << gust_N << " N gusts: mean " << seconds << " s, worst " << worst_s << " s, by wrench " << by_wrench
              << ", recoveries " << recoveries << ", false declarations " << false_declarations << '\n';
    EXPECT_LT(seconds, 6);
    EXPECT_LT(worst_s, 15);
  }
}

TEST(ClosedLoopTest, FailsWithoutTheConesGeometry) {
  DockingConfig config;
  config.recoveries_max = 2;
  int docked = 0;
  unsigned false_declarations = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Trial trial = Loop(seed, 1.0, false).run(config);
    docked += trial.docked;
    false_declarations += trial.last.false_declarations;
  }
  EXPECT_EQ(docked, 0);
  EXPECT_GT(false_declarations, 0u);
}

}  // namespace
}  // namespace eciton::docking
