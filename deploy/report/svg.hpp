// Writes SVG elements into a text. Coordinates are rounded to a tenth of a pixel.
#pragma once

#include <cstdio>
#include <string>
#include <utility>

namespace eciton::report {

class Svg {
 public:
  Svg(double width, double height, const std::string& described) {
    text_ = "<svg viewBox=\"0 0 " + number(width) + " " + number(height) + "\" role=\"img\" aria-label=\"" +
            described + "\">\n";
  }

  void line(double x1, double y1, double x2, double y2, const std::string& css_class) {
    text_ += "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" +
             number(y2) + "\" class=\"" + css_class + "\"/>\n";
  }
  /// `anchor`: start, middle or end. The words must be escaped.
  void words(double x, double y, const std::string& anchor, const std::string& words, const std::string& css_class) {
    text_ += "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\" class=\"" +
             css_class + "\">" + words + "</text>\n";
  }
  void bar(double x, double y, double width, double height, const std::string& css_class, const std::string& tip) {
    text_ += "<rect x=\"" + number(x) + "\" y=\"" + number(y) + "\" width=\"" + number(width) + "\" height=\"" +
             number(height) + "\" rx=\"2\" class=\"" + css_class + "\"><title>" + tip + "</title></rect>\n";
  }
  /// `data`: M, L and Z commands.
  void path(const std::string& data, const std::string& css_class, const std::string& tip) {
    text_ += "<path d=\"" + data + "\" class=\"" + css_class + "\"><title>" + tip + "</title></path>\n";
  }
  /// From bottom to top, about its middle.
  void words_upwards(double x, double y, const std::string& words, const std::string& css_class) {
    text_ += "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"middle\" transform=\"rotate(-90 " +
             number(x) + " " + number(y) + ")\" class=\"" + css_class + "\">" + words + "</text>\n";
  }
  void shape(const std::string& data, const std::string& css_class) {
    text_ += "<path d=\"" + data + "\" class=\"" + css_class + "\"/>\n";
  }
  /// A line of a colour of its own: "#31688e".
  void stroke(const std::string& data, const std::string& colour, const std::string& css_class) {
    text_ += "<path d=\"" + data + "\" stroke=\"" + colour + "\" class=\"" + css_class + "\"/>\n";
  }
  void area(double x, double y, double width, double height, const std::string& css_class) {
    text_ += "<rect x=\"" + number(x) + "\" y=\"" + number(y) + "\" width=\"" + number(width) + "\" height=\"" +
             number(height) + "\" class=\"" + css_class + "\"/>\n";
  }
  void dot(double x, double y, double radius, const std::string& css_class) {
    text_ += "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"" + number(radius) + "\" class=\"" +
             css_class + "\"/>\n";
  }
  std::string finished() && { return std::move(text_) + "</svg>\n"; }

  static std::string number(double value) {
    char digits[32];
    std::snprintf(digits, sizeof(digits), "%.1f", value);
    return digits;
  }
  static std::string point(double x, double y) { return number(x) + "," + number(y); }

 private:
  std::string text_;
};

}  // namespace eciton::report
