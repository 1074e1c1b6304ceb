// How Cyclone DDS is taught to carry bytes that the framework serialized: a type ("sertype") whose samples
// ("serdata") are those bytes and their key hash, in blocks of the pool.
#pragma once

#include <cstdint>

#include "core/bus/plugin.h"
#include "core/bus/vendors/cyclonedds/vendor.hpp"

namespace eciton::bus::cyclonedds {

/// What dds_write is given as a sample.
struct Bytes {
  const std::uint8_t* cdr = nullptr;
  std::uint32_t size = 0;
};

struct BytesSertype : ddsi_sertype {
  eciton_type type;
};

struct BytesSerdata : ddsi_serdata {
  std::uint32_t size;
  std::uint8_t key_hash[16];

  std::uint8_t* cdr() { return reinterpret_cast<std::uint8_t*>(this + 1); }
  const std::uint8_t* cdr() const { return reinterpret_cast<const std::uint8_t*>(this + 1); }
};

/// With one reference, for dds_create_topic_sertype.
ddsi_sertype* new_bytes_sertype(const eciton_type& type);

/// What one sample of the type takes of the pool, and what one key does.
std::size_t sample_block_size(const eciton_type& type);
inline constexpr std::size_t kKeyBlockSize = sizeof(BytesSerdata);

}  // namespace eciton::bus::cyclonedds
