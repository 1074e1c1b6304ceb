// Rotors and the wrench they make, both ways. Rotor convention: the thrust vector in body axes is
// Rx(phi) Ry(theta) (0,0,T); phi is the outer gimbal, theta the inner. Source: (3), (6), LEGION.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/robot/airframe.hpp"

namespace eciton::robot {

/// What one rotor does, or shall do.
struct RotorOutput {
  double thrust_N = 0;
  std::array<double, 2> gimbal_rad{};  // phi, theta; zero on fixed rotors
};

/// Thrust vector in body axes, N.
Vector3 thrust_vector_B(const RotorOutput& rotor);

/// The thrust and gimbal angles that make a thrust vector. Two pairs of angles do, (phi, theta) and
/// (phi -+ pi, +-pi - theta): the one nearer to `present_rad` is taken, being outside the limit counting
/// tenfold. Without this rule phi flips by pi at large pitch. At theta = +-pi/2 phi is undefined: it stays.
/// The result may lie outside the limit when both pairs do.
RotorOutput rotor_output(const Vector3& thrust_B_N, const std::array<double, 2>& present_rad, double gimbal_rad_max);

/// Q of (3): wrench of the rotors about the composite centre of mass, body axes.
Wrench rotor_wrench_B(const Airframe& airframe, std::span<const RotorOutput> rotors, const Vector3& com_offset_B);

struct AllocationConfig {
  /// The demanded force is scaled down to no less than this share, of it or of the weight if that is less, before the
  /// moment is scaled: dropping all of it would be free fall.
  double force_scale_min = 0.6;
};

/// One module's rotors for a demanded wrench, and what had to give.
struct Allocation {
  std::array<RotorOutput, rotors_max> rotors{};
  std::size_t rotor_count = 0;
  Wrench achieved_B;       // what `rotors` really make, about the composite centre of mass
  double force_scale = 1;  // share of the demanded force, and of the moment, that was asked of the rotors
  double moment_scale = 1;
  bool thrust_limited = false;  // some rotor at its least thrust, or at its greatest in spite of the scaling
  bool gimbal_limited = false;

  bool saturated() const { return force_scale < 1 || moment_scale < 1 || thrust_limited || gimbal_limited; }
  std::span<const RotorOutput> outputs() const { return {rotors.data(), rotor_count}; }
};

/// Q# = Q^T (Q Q^T)^-1 with limits; attitude goes first: force is scaled down before moment, and where rotors run
/// into their limits all the same the others make up for the moment, whatever becomes of the force. On an airframe
/// whose rotors are fixed Q has less than full rank and the wrench is reproduced where it can be, in the
/// least-squares sense (a robot that tilts to move chooses its attitude before it allocates).
/// Keeps the gimbal angles it last asked for. Real-time safe after construction; one thread.
class Allocator {
 public:
  explicit Allocator(const Airframe& airframe, const AllocationConfig& config = {});

  /// `demanded_B`: about the composite centre of mass, body axes.
  Allocation update(const Wrench& demanded_B, const Vector3& com_offset_B);

  /// Says where the gimbals are now, as after a restart in flight.
  void set_gimbals(std::span<const RotorOutput> rotors);

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.gimbal_rad_);
  }

 private:
  using Block = Eigen::Matrix<double, 6, 3>;
  using Blocks = std::array<Block, rotors_max>;
  /// The rotor's setting within its limits that is nearest to a thrust; notes what it ran into.
  RotorOutput limited(std::size_t rotor, const Vector3& thrust_B_N, Allocation& out) const;
  void keep_moment(const Blocks& Q, const Vector3& moment_B, Allocation& out) const;
  Vector6 solve(const Matrix6& QQt, const Vector6& wrench) const;

  AllocationConfig config_;
  Airframe airframe_;
  bool full_rank_;
  std::array<std::array<double, 2>, rotors_max> gimbal_rad_{};
};

}  // namespace eciton::robot
