// A type of the tests' own, made by hand: header, a 4-byte key, a counter and text. Independent of the
// framework's codec, so that the plugins alone are under test.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/bus/plugin.h"

namespace eciton::bus {

using Cdr = std::vector<std::uint8_t>;

inline Cdr sample(std::uint32_t key, std::uint32_t count, const std::string& text = "abc") {
  Cdr cdr = {0, 1, 0, 0};
  const auto put = [&cdr](std::uint32_t value) {
    for (int k = 0; k < 4; ++k) cdr.push_back(static_cast<std::uint8_t>(value >> 8 * k));
  };
  put(key);
  put(count);
  cdr.insert(cdr.end(), text.begin(), text.end());
  while (cdr.size() % 4 != 0) cdr.push_back(0);
  return cdr;
}

inline Cdr big_endian_sample(std::uint32_t key, std::uint32_t count) {
  Cdr cdr = {0, 0, 0, 0};
  for (const std::uint32_t value : {key, count}) {
    for (int k = 3; k >= 0; --k) cdr.push_back(static_cast<std::uint8_t>(value >> 8 * k));
  }
  return cdr;
}

inline std::uint32_t number_at(const Cdr& cdr, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value |= static_cast<std::uint32_t>(cdr[at + (cdr[1] != 0 ? k : 3 - k)]) << 8 * k;
  return value;
}
inline std::uint32_t key_of(const Cdr& cdr) { return number_at(cdr, 4); }
inline std::uint32_t count_of(const Cdr& cdr) { return number_at(cdr, 8); }

inline int key_hash(const std::uint8_t* cdr, std::uint32_t size, int, std::uint8_t hash[16]) {
  if (size < 8) return 0;
  const std::uint32_t key = key_of(Cdr(cdr, cdr + size));
  std::memset(hash, 0, 16);
  for (int k = 0; k < 4; ++k) hash[k] = static_cast<std::uint8_t>(key >> 8 * (3 - k));
  return 1;
}

/// What a peer with another idea of the type does: any bytes have a key.
inline int careless_key_hash(const std::uint8_t*, std::uint32_t, int, std::uint8_t hash[16]) {
  std::memset(hash, 0, 16);
  return 1;
}

inline constexpr std::uint32_t kSizeMax = 1024;
inline constexpr eciton_type kKeyed = {"eciton_test::Keyed", kSizeMax, 4, key_hash};
inline constexpr eciton_type kUnkeyed = {"eciton_test::Unkeyed", kSizeMax, 0, nullptr};

inline constexpr eciton_qos kSensor = {0, 0, 1, 8};
inline constexpr eciton_qos kCommand = {1, 0, 1, 8};
inline constexpr eciton_qos kState = {1, 1, 1, 8};
inline constexpr eciton_qos kEvent = {1, 1, 64, 8};

}  // namespace eciton::bus
