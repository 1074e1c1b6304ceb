// How Fast DDS sees a sample of bytes: it copies them into its payload, and hands out pointers into it.
#include "core/bus/vendors/fastdds/bytes_type.hpp"

#include <cstring>

#include "core/bus/vendors/request.hpp"

namespace eciton::bus::fastdds {

using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

BytesType::BytesType(const eciton_type& type) : type_(type) {
  setName(type.name);
  type_.name = getName();
  m_typeSize = type.size_max;
  m_isGetKeyDefined = type.key_size > 0;
  // Type objects would describe a struct that the vendor does not know; peers match by name.
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool BytesType::serialize(void* data, SerializedPayload_t* payload) {
  const auto* bytes = static_cast<const Bytes*>(data);
  if (bytes->size > payload->max_size) return false;
  payload->encapsulation = bytes->cdr[1];
  std::memcpy(payload->data, bytes->cdr, bytes->size);
  payload->length = bytes->size;
  return true;
}

bool BytesType::deserialize(SerializedPayload_t* payload, void* data) {
  auto* bytes = static_cast<Bytes*>(data);
  bytes->cdr = payload->data;
  bytes->size = payload->length;
  return true;
}

std::function<std::uint32_t()> BytesType::getSerializedSizeProvider(void* data) {
  const auto* bytes = static_cast<const Bytes*>(data);
  return [bytes] { return bytes->size; };  // one pointer: fits the function object, no allocation
}

void* BytesType::createData() { return new Bytes; }

void BytesType::deleteData(void* data) { delete static_cast<Bytes*>(data); }

bool BytesType::getKey(void* data, InstanceHandle_t* handle, bool /*force_md5*/) {
  if (type_.key_size == 0) return false;
  const auto* bytes = static_cast<const Bytes*>(data);
  std::uint8_t hash[16];
  const bool good = vendors::well_formed(type_, bytes->cdr, bytes->size) &&
                    vendors::key_hash_of(type_, bytes->cdr, bytes->size, false, hash);
  // A sample whose key cannot be told would stay in the reader's history for ever and fill it. All such share one
  // instance of their own, and take drops them.
  if (!good) std::memset(hash, 0xff, sizeof hash);
  std::memcpy(handle->value, hash, sizeof hash);
  return true;
}

}  // namespace eciton::bus::fastdds
