// The model of the zero against hover worked out without linearising: a module whose rotors, mass, centre of mass and
// attitude sensor differ from the model by known amounts hangs in balance; what an observer by momentum then reads is
// what the model's own wrench lacks.
#include "core/robot/model_errors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "services/estimation/zeroing.hpp"
#include "tests/services/estimation/hanging_module.hpp"

namespace eciton::estimation {
namespace {

using robot::Matrix3;
using robot::Vector3;

constexpr double dt = 0.002;

Zeroing zeroed_by(const HangingModule& module, const std::vector<Matrix3>& attitudes) {
  Zeroing zeroing({.duration_s = 1.0 * static_cast<double>(attitudes.size()), .samples_min = 100});
  zeroing.start();
  for (const Matrix3& R : attitudes) {
    const Reading reading = module.read(R);
    for (int k = 0; k < 500; ++k)
      zeroing.update(reading.observed_M, reading.jacobian_M, Vector3::Zero(), Vector3::Zero(), dt);
  }
  EXPECT_EQ(zeroing.phase(), ZeroingPhase::done);
  return zeroing;
}

struct Left {
  double force_N, moment_Nm;
};
Left left_at(const HangingModule& module, const Zeroing& zeroing, const Matrix3& R) {
  const Reading reading = module.read(R);
  const robot::Wrench rest = reading.observed_M - zeroing.bias_M(reading.jacobian_M);
  return {rest.force.norm(), rest.moment.norm()};
}
Left both(Left a, Left b) { return {std::hypot(a.force_N, b.force_N), std::hypot(a.moment_Nm, b.moment_Nm)}; }

const Matrix3 level = Matrix3::Identity();
Matrix3 pitched(double rad) { return robot::exp_so3({0, rad, 0}); }
Matrix3 rolled(double rad) { return robot::exp_so3({rad, 0, 0}); }
/// As a member of a bent chain: turned and pitched.
const Matrix3 bent = robot::exp_so3({0, 0, 0.8}) * pitched(0.8);

TEST(ModelErrorsTest, TellsWhatEachErrorReadsAs) {
  // By hand, level: 1 % more mass pulls down by 0.01 m g; the centre of mass 1 mm forward pitches by m g 1 mm, nose
  // down (+y); a sensor that shows 1 mrad too much roll (+x) sees the thrust, which is vertical, leaned to -y, and
  // the module does not go there: a force to +y.
  const robot::Airframe airframe = robot::legion();
  const double weight_N = airframe.mass_kg * robot::gravity_m_s2;
  const HangingModule mass({.mass_share = 0.01}), com({.com_m = {0.001, 0, 0}}),
      roll({.attitude_rad = {0.001, 0, 0}});
  EXPECT_NEAR(mass.read(level).observed_M.force.z(), -0.01 * weight_N, 1e-9);
  EXPECT_NEAR(com.read(level).observed_M.moment.y(), 0.001 * weight_N, 1e-9);
  EXPECT_NEAR(roll.read(level).observed_M.force.y(), 0.001 * weight_N, 1e-6);
}

TEST(ModelErrorsTest, IsTheFirstOrderOfTheTruth) {
  // Every error alone, small, in a bent attitude: the Jacobian's column to a thousandth.
  for (int error = 0; error < robot::model_error_count; ++error) {
    const bool rotor = error < static_cast<int>(robot::rotors_max);
    if (rotor && error >= static_cast<int>(robot::legion().rotors.size())) continue;
    robot::ModelErrors errors = robot::ModelErrors::Zero();
    errors[error] = 1e-5;
    const Reading reading = HangingModule(TrueModel::of(errors)).read(bent);
    const robot::Vector6 predicted = reading.jacobian_M * errors;
    robot::Vector6 is;
    is << reading.observed_M.force, reading.observed_M.moment;
    EXPECT_LT((predicted - is).norm(), 1e-3 * is.norm()) << "error " << error;
    EXPECT_GT(is.norm(), 1e-6) << "error " << error;
  }
}

TEST(ModelErrorsTest, AZeroOfLevelHoverHoldsInABentChain) {
  // Errors as large as the mismatch draws them. What a level hover cannot tell is left: the height of the centre of
  // mass, and the sensor's error in yaw. The control that must fail is a constant zero: force in W, moment in M.
  std::mt19937 rng(5);
  Left by_model{}, by_constant{}, by_tilting{};
  for (int run = 0; run < 40; ++run) {
    const HangingModule module(TrueModel::drawn(rng));
    const Zeroing zeroing = zeroed_by(module, {level, level, level});
    const Left at_level = left_at(module, zeroing, level);
    EXPECT_LT(at_level.force_N, 0.02);
    EXPECT_LT(at_level.moment_Nm, 0.003);
    by_model = both(by_model, left_at(module, zeroing, bent));
    const robot::Wrench zero = module.read(level).observed_M, reads = module.read(bent).observed_M;
    by_constant = both(by_constant, {(bent * reads.force - zero.force).norm(), (reads.moment - zero.moment).norm()});
    const Zeroing tilted = zeroed_by(module, {level, pitched(0.2), pitched(-0.2), rolled(0.2), rolled(-0.2)});
    by_tilting = both(by_tilting, left_at(module, tilted, bent));
  }
  EXPECT_LT(by_model.force_N, 0.6 * by_constant.force_N);
  EXPECT_LT(by_model.moment_Nm, 0.5 * by_constant.moment_Nm);
  EXPECT_LT(by_tilting.force_N, 0.5 * by_model.force_N);
  EXPECT_LT(by_tilting.moment_Nm, 0.5 * by_model.moment_Nm);
}

}  // namespace
}  // namespace eciton::estimation
