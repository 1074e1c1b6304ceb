// A plot as data: what is shown, not how. Series may be empty; draw() leaves out what has nothing to show.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace eciton::report {

enum class TraceStyle { solid, thin, dashed, points };

/// y over x. `band`: half the height of a shaded region about the line, one value for each sample or one for all.
struct Trace {
  std::string name;
  std::vector<double> x, y;
  std::vector<double> band = {};
  TraceStyle style = TraceStyle::solid;
  /// Values from this on are drawn at it, with an open marker: "no convergence in 60 s". 0: none.
  double cut_off = 0;
  /// Traces that belong together (a truth and its estimate) share a colour; negative: the next free one.
  int colour = -1;
};

/// A moment, as a vertical line: "T1".
struct Mark {
  double at;
  std::string label;
};

/// A value to compare with, as a horizontal line: "paper: 16.0 s".
struct Level {
  double at;
  std::string label;
};

/// A tolerance, as a shaded rectangle.
struct Range {
  double x_from, x_to, y_from, y_to;
  std::string label;
};

struct Lines {
  std::string x_label, y_label;
  std::vector<Trace> traces;
  std::vector<Mark> marks = {};
  std::vector<Level> levels = {};
  std::vector<Range> ranges = {};
  bool y_logarithmic = false;
  bool x_whole = false;  // ticks at whole numbers only: a count of modules
};

/// One column of a box and violin plot.
struct Distribution {
  std::string name;
  std::vector<double> values;
};

/// Violin (Gaussian kernel density), box (quartiles, whiskers to 1.5 times their distance), mean and values.
struct Distributions {
  std::string x_label, y_label;
  std::vector<Distribution> columns;
  std::vector<Level> levels = {};
};

/// A flight in plan (x, y) and from the side (x, z), coloured by its speed, over the path it was to fly.
struct Path {
  std::vector<double> x_m, y_m, z_m, speed_m_s;
  std::vector<double> x_reference_m = {}, y_reference_m = {}, z_reference_m = {};
};

struct Plot {
  std::string name;   // of the file it is kept in: "position_error"
  std::string title;  // "Position error (Fig. S1 C)"
  std::string note;   // what is drawn, and what to compare it with; may be empty
  std::variant<Lines, Distributions, Path> what;
};

}  // namespace eciton::report
