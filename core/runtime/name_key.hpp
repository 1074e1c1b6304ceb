// The number that stands for a name where a message needs a key of few bytes: service_key of heartbeats,
// process_key of clock acknowledgements.
#pragma once

#include <cstdint>
#include <string_view>

namespace eciton::runtime {

/// FNV-1a, 32 bits.
constexpr std::uint32_t name_key(std::string_view name) {
  std::uint32_t hash = 2166136261u;
  for (const char c : name) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u;
  return hash;
}

}  // namespace eciton::runtime
