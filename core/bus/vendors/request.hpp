// What every plugin does with the arguments of the C ABI before its vendor sees them: checks them, and puts
// error messages where the caller asked for them.
#pragma once

#include <cstdint>
#include <exception>
#include <string>

#include "core/base/result.hpp"
#include "core/bus/plugin.h"

namespace eciton::bus::vendors {

/// Encapsulation header: representation identifier (big-endian, 2 bytes), options (2 bytes).
inline constexpr std::uint32_t kHeaderSize = 4;
/// Domains above this have ports beyond 65535.
inline constexpr std::uint32_t kDomainMax = 232;

Status check_participant(const eciton_participant_config& config);
Status check_endpoint(const char* topic, const eciton_type& type, const eciton_qos& qos);

/// Whether these bytes can be a sample of the type. Both byte orders of XCDR1 pass, nothing else does: what is
/// dropped here is a stray or hostile packet under a known topic name.
inline bool well_formed(const eciton_type& type, const std::uint8_t* cdr, std::uint32_t size) {
  return size >= kHeaderSize && size <= type.size_max && cdr[0] == 0 && cdr[1] <= 1;
}

/// The key hash of a sample (zero without a key). False: malformed.
bool key_hash_of(const eciton_type& type, const std::uint8_t* cdr, std::uint32_t size, bool key_only,
                 std::uint8_t hash[16]);

void write_error(char* error, std::uint32_t error_size, const std::string& message);

/// Runs a creating function; what it throws or returns as an error becomes a message and NULL.
template <class Created, class Create>
Created* created_or_null(char* error, std::uint32_t error_size, Create&& create) {
  try {
    Result<Created*> result = create();
    if (result) return *result;
    write_error(error, error_size, result.error().message);
  } catch (const std::exception& thrown) {
    write_error(error, error_size, thrown.what());
  }
  return nullptr;
}

}  // namespace eciton::bus::vendors
