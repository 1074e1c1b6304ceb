// Checks of the arguments that reach a plugin through the C ABI.
#include "core/bus/vendors/request.hpp"

#include <algorithm>
#include <cstring>

namespace eciton::bus::vendors {

Status check_participant(const eciton_participant_config& config) {
  if (config.domain > kDomainMax) {
    return Error{"domain " + std::to_string(config.domain) + " does not exist: 0 to " + std::to_string(kDomainMax)};
  }
  if (config.name == nullptr || config.network_interface == nullptr || *config.network_interface == '\0') {
    return Error{"domain " + std::to_string(config.domain) + ": a participant needs a name and a network interface"};
  }
  if (config.lease_ms < 100) {
    return Error{"participant \"" + std::string(config.name) + "\": lease of " + std::to_string(config.lease_ms) +
                 " ms is too short: at least 100 ms, since announcements come every third of it"};
  }
  return ok();
}

Status check_endpoint(const char* topic, const eciton_type& type, const eciton_qos& qos) {
  if (topic == nullptr || *topic == '\0' || type.name == nullptr || *type.name == '\0') {
    return Error{"an endpoint needs a topic name and a type name"};
  }
  const std::string where = "topic \"" + std::string(topic) + "\", type " + type.name + ": ";
  if (type.size_max < kHeaderSize || type.size_max % 4 != 0) {
    return Error{where + "size_max " + std::to_string(type.size_max) + " is no multiple of 4 from 4 on"};
  }
  if (type.key_size > 16) return Error{where + "a key of " + std::to_string(type.key_size) + " bytes: at most 16"};
  if (type.key_size > 0 && type.key_hash == nullptr) return Error{where + "has a key but no key_hash"};
  if (qos.depth == 0 || qos.instances_max == 0) return Error{where + "depth and instances_max must be 1 or more"};
  return ok();
}

bool key_hash_of(const eciton_type& type, const std::uint8_t* cdr, std::uint32_t size, bool key_only,
                 std::uint8_t hash[16]) {
  std::memset(hash, 0, 16);
  if (size < kHeaderSize) return false;
  return type.key_size == 0 || type.key_hash(cdr, size, key_only ? 1 : 0, hash) != 0;
}

void write_error(char* error, std::uint32_t error_size, const std::string& message) {
  if (error == nullptr || error_size == 0) return;
  const std::size_t length = std::min<std::size_t>(message.size(), error_size - 1);
  std::memcpy(error, message.data(), length);
  error[length] = '\0';
}

}  // namespace eciton::bus::vendors
