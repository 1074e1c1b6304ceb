// Readable lengths of numbers, and what XML wants escaped.
#include "deploy/report/text.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace eciton::report {

std::string grouped(std::string digits) {
  for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3) {
    digits.insert(static_cast<std::size_t>(at), 1, ',');
  }
  return digits;
}

std::string number_text(double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "∞" : "-∞";
  const double size = std::abs(value);
  const std::string sign = value < 0 ? "-" : "";
  char digits[64];
  if (size >= 1e15) {
    std::snprintf(digits, sizeof(digits), "%.3g", size);
    return sign + digits;
  }
  if (size >= 999.5) {
    std::snprintf(digits, sizeof(digits), "%.0f", size);
    return sign + grouped(digits);
  }
  if (size > 0 && size < 0.00095) {
    std::snprintf(digits, sizeof(digits), "%.2e", size);
    return sign + digits;
  }
  const int decimals = size >= 99.95 ? 0 : size >= 9.995 ? 1 : size >= 0.9995 ? 2 : 3;
  std::snprintf(digits, sizeof(digits), "%.*f", size == 0 ? 0 : decimals, size);
  return sign + digits;
}

std::string figure_text(double value) {
  if (value == std::round(value) && std::abs(value) < 1e9) {
    const std::string digits = grouped(std::to_string(std::llabs(std::llround(value))));
    return value < 0 ? "-" + digits : digits;
  }
  if (std::abs(value) >= 1 || !std::isfinite(value)) return number_text(value);
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.3g", value);
  return digits;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        // Control characters have no place in a page; what is not UTF-8 is the caller's.
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

}  // namespace eciton::report
