// How much of a message of Fast DDS to send: all but the submessage of statistics at its end. Pure.
#pragma once

#include <cstdint>

namespace eciton::bus::fastdds {

/// `message`: a whole RTPS message of `size` bytes. Less than `size` when it ends with statistics that can be left
/// out: the vendor's UDP takes any byte 0x80 where statistics would begin for theirs, and writes over what follows,
/// so a message that would look so without them keeps them (one in 256).
inline std::uint32_t lean_size(const std::uint8_t* message, std::uint32_t size) {
  constexpr std::uint32_t header = 20, statistics = 4 + 56;
  constexpr std::uint8_t statistics_id = 0x80;
  const auto begins_statistics = [&](std::uint32_t of) {
    return of >= header + statistics && message[of - statistics] == statistics_id;
  };
  if (!begins_statistics(size)) return size;
  const std::uint8_t* last = message + size - statistics;
  const bool little = (last[1] & 1) != 0;
  const std::uint32_t length = last[little ? 2 : 3] + 256u * last[little ? 3 : 2];
  if (length != statistics - 4) return size;
  return begins_statistics(size - statistics) ? size : size - statistics;
}

}  // namespace eciton::bus::fastdds
