// The QoS of endpoints on Fast DDS; the native peer of the benchmarks has the same.
#pragma once

#include <cstdint>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "core/bus/plugin.h"

namespace eciton::bus::fastdds {

/// What a writer and a reader are told alike.
template <class EndpointQos>
void set_common_qos(EndpointQos& qos, const eciton_qos& asked, std::uint32_t instances_spare,
                    std::uint32_t samples_spare) {
  namespace fast = eprosima::fastdds::dds;
  qos.reliability().kind = asked.reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  // KEEP_LAST overwrites and so never waits for a slow reader; this bounds the rest, were there any.
  qos.reliability().max_blocking_time = eprosima::fastrtps::Duration_t(0, 1'000'000);
  qos.durability().kind =
      asked.transient_local ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = static_cast<std::int32_t>(asked.depth);
  const std::uint32_t instances = asked.instances_max + instances_spare;
  const std::uint32_t samples = asked.depth * instances + samples_spare;
  qos.resource_limits().max_instances = static_cast<std::int32_t>(instances);
  qos.resource_limits().max_samples_per_instance = static_cast<std::int32_t>(asked.depth);
  qos.resource_limits().max_samples = static_cast<std::int32_t>(samples);
  qos.resource_limits().allocated_samples = static_cast<std::int32_t>(samples < 64 ? samples : 64);
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_MEMORY_MODE;
  qos.data_sharing().off();
}

inline eprosima::fastdds::dds::DataWriterQos writer_qos(const eciton_qos& asked) {
  using eprosima::fastrtps::Duration_t;
  eprosima::fastdds::dds::DataWriterQos qos;
  set_common_qos(qos, asked, 0, 0);
  qos.publish_mode().kind = eprosima::fastdds::dds::SYNCHRONOUS_PUBLISH_MODE;
  // At the default of 3 s a late joiner, or one that lost the last sample, waits as long.
  qos.reliable_writer_qos().times.heartbeatPeriod = Duration_t(0, 20'000'000);
  qos.reliable_writer_qos().times.nackResponseDelay = Duration_t(0, 0);
  return qos;
}

// Samples lent at once. Each holds a payload of the history's pool, which therefore has as many to spare.
constexpr std::uint32_t kLoansMax = 32;
// A reliable reader refuses a sample when the gap before it does not fit the history: leave room for a gap that a
// burst of losses makes. Payloads are allocated only when used.
constexpr std::uint32_t kSamplesSpare = kLoansMax + 224;

inline eprosima::fastdds::dds::DataReaderQos reader_qos(const eciton_qos& asked) {
  eprosima::fastdds::dds::DataReaderQos qos;
  set_common_qos(qos, asked, 1, kSamplesSpare);
  qos.reliable_reader_qos().times.heartbeatResponseDelay = eprosima::fastrtps::Duration_t(0, 0);
  qos.reader_resource_limits().max_samples_per_read = static_cast<std::int32_t>(kLoansMax);
  qos.reader_resource_limits().sample_infos_allocation.initial = kLoansMax;
  return qos;
}

}  // namespace eciton::bus::fastdds
