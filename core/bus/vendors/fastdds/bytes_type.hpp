// A Fast DDS type whose samples are bytes that the framework serialized: nothing is converted, only the
// key hash is asked for.
#pragma once

#include <cstdint>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include "core/bus/plugin.h"

namespace eciton::bus::fastdds {

/// One sample, borrowed: from the caller of write, or from the vendor's payload while it is on loan.
struct Bytes {
  const std::uint8_t* cdr = nullptr;
  std::uint32_t size = 0;
};

class BytesType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit BytesType(const eciton_type& type);

  const eciton_type& type() const { return type_; }

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;
  bool is_bounded() const override { return true; }

 private:
  eciton_type type_;  // its name points into the base class's copy
};

}  // namespace eciton::bus::fastdds
