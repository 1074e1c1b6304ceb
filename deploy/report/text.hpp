// Numbers and names as people read them, and as a page takes them.
#pragma once

#include <string>

namespace eciton::report {

/// "12.3", three significant digits, thousands in groups; "–" for NaN.
std::string number_text(double value);

/// A count without decimals, else three significant digits also below 1: "20", "0.0171".
std::string figure_text(double value);

/// "12,345", of digits alone.
std::string grouped(std::string digits);

/// For text and attributes.
std::string escaped(const std::string& text);

}  // namespace eciton::report
