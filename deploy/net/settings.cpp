// Numbers with their units. A number without one is refused: 20 may be milliseconds or microseconds.
#include "deploy/net/settings.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace eciton::net {
namespace {

constexpr Duration duration_max = std::chrono::seconds(60);
constexpr double rate_min_bit_s = 1e3, rate_max_bit_s = 1e11;

constexpr std::array<std::pair<const char*, double>, 4> time_units{{{"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}}};
constexpr std::array<std::pair<const char*, double>, 4> rate_units{
    {{"bit/s", 1}, {"kbit/s", 1e3}, {"Mbit/s", 1e6}, {"Gbit/s", 1e9}}};

/// The number at the beginning and what follows it.
std::optional<std::pair<double, std::string>> split(const std::string& text) {
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
  return std::pair(number, std::string(rest, text.data() + text.size()));
}

template <std::size_t N>
std::optional<double> with_unit(const std::string& text, const std::array<std::pair<const char*, double>, N>& units) {
  const auto parts = split(text);
  if (!parts) return std::nullopt;
  if (parts->first == 0 && parts->second.empty()) return 0;
  for (const auto& [unit, factor] : units) {
    if (parts->second == unit) return parts->first * factor;
  }
  return std::nullopt;
}

/// In the largest unit that leaves no fraction, or else the smallest.
template <std::size_t N>
std::string in_largest_unit(double value, const std::array<std::pair<const char*, double>, N>& units) {
  std::size_t unit = 0;
  while (unit + 1 < N && value != 0 && std::fmod(value, units[unit + 1].second) == 0) ++unit;
  char text[48];
  std::snprintf(text, sizeof text, "%.15g%s", value / units[unit].second, units[unit].first);
  return text;
}

}  // namespace

std::string to_text(Duration value) {
  return value == Duration::zero() ? "0" : in_largest_unit(static_cast<double>(value.count()), time_units);
}

std::string to_text(double probability) {
  char text[48];
  std::snprintf(text, sizeof text, "%.12g%%", 100 * probability);
  return text;
}

std::string to_text(bool value) { return value ? "on" : "off"; }

std::string to_text(BitRate value) {
  return value.bit_s <= 0 ? "unlimited" : in_largest_unit(value.bit_s, rate_units);
}

Status from_text(const std::string& text, Duration& value) {
  const auto ns = with_unit(text, time_units);
  if (!ns || *ns < 0 || *ns > static_cast<double>(duration_max.count()))
    return Error{"expected a time from 0 to 60s with its unit, as 20ms or 500us"};
  value = Duration{static_cast<Duration::rep>(std::llround(*ns))};
  return ok();
}

Status from_text(const std::string& text, double& probability) {
  const auto parts = split(text);
  const bool percent = parts && parts->second == "%";
  const double share = parts ? parts->first / (percent ? 100 : 1) : -1;
  if (!parts || !(percent || parts->second.empty()) || share < 0 || share > 1)
    return Error{"expected a share from 0 to 1 or from 0% to 100%, as 0.1 or 10%"};
  probability = share;
  return ok();
}

Status from_text(const std::string& text, bool& value) {
  if (text != "on" && text != "off") return Error{"expected on or off"};
  value = text == "on";
  return ok();
}

Status from_text(const std::string& text, BitRate& value) {
  if (text == "unlimited") {
    value = {};
    return ok();
  }
  const auto bit_s = with_unit(text, rate_units);
  if (!bit_s || *bit_s < rate_min_bit_s || *bit_s > rate_max_bit_s)
    return Error{"expected unlimited, or a rate from 1kbit/s to 100Gbit/s with its unit, as 6Mbit/s"};
  value = {*bit_s};
  return ok();
}

}  // namespace eciton::net
