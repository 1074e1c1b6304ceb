// How Cyclone DDS is taught to carry bytes that the framework serialized: a type ("sertype") whose samples
// ("serdata") are those bytes and their key hash, in blocks of the pool.
#pragma once

#include <cstdint>

#include "core/bus/plugin.h"
#include "core/bus/vendors/cyclonedds/vendor.hpp"
#include "core/bus/vendors/sequence_gaps.hpp"

namespace eciton::bus::cyclonedds {

/// Who sent a sample, and its number among the writer's; 0: not known, as of a writer in this process.
struct Origin {
  vendors::WriterGuid writer{};
  std::int64_t number = 0;
};

/// What dds_write is given as a sample, and what a reader's filter is shown.
struct Bytes {
  const std::uint8_t* cdr = nullptr;
  std::uint32_t size = 0;
  const Origin* origin = nullptr;
};

struct BytesSertype : ddsi_sertype {
  eciton_type type;
};

struct BytesSerdata : ddsi_serdata {
  std::uint32_t size;
  std::uint8_t key_hash[16];
  Origin origin;

  std::uint8_t* cdr() { return reinterpret_cast<std::uint8_t*>(this + 1); }
  const std::uint8_t* cdr() const { return reinterpret_cast<const std::uint8_t*>(this + 1); }
};

/// With one reference, for dds_create_topic_sertype.
ddsi_sertype* new_bytes_sertype(const eciton_type& type);

/// What one sample of the type takes of the pool, and what one key does.
std::size_t sample_block_size(const eciton_type& type);
inline constexpr std::size_t kKeyBlockSize = sizeof(BytesSerdata);

}  // namespace eciton::bus::cyclonedds
