// A scale of a chart: where a value stands on it, and which values are named.
#pragma once

#include <string>
#include <vector>

namespace eciton::report {

struct Tick {
  double value;
  std::string label;
};

class Axis {
 public:
  /// Holds [least, greatest] with a little room; from zero, or logarithmic where the values span more than
  /// a factor of 20.
  static Axis around(double least, double greatest);
  static Axis from_zero(double greatest);
  static Axis exactly(double least, double greatest);
  /// Holds them with a little room, from zero where they are on one side of it.
  static Axis with_room(double least, double greatest);
  static Axis of_logarithms(double least, double greatest);

  bool logarithmic() const { return logarithmic_; }
  /// 0 at the lower end, 1 at the upper, and never beyond.
  double position(double value) const;
  /// About five; all inside.
  std::vector<Tick> ticks() const;

 private:
  double least_ = 0, greatest_ = 1;
  bool logarithmic_ = false;
};

}  // namespace eciton::report
