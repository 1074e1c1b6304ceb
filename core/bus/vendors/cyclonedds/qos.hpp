// The QoS of endpoints on Cyclone DDS; the native peer of the benchmarks has the same.
#pragma once

#include <cstdint>
#include <memory>

#include "core/bus/plugin.h"
#include "core/bus/vendors/cyclonedds/vendor.hpp"

namespace eciton::bus::cyclonedds {

using Qos = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)>;

inline Qos make_qos(const eciton_qos& asked) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  // KEEP_LAST overwrites and so never waits for a slow reader; 1 ms bounds the rest, were there any.
  dds_qset_reliability(qos.get(), asked.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(1));
  dds_qset_durability(qos.get(), asked.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  const auto depth = static_cast<std::int32_t>(asked.depth);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  if (asked.transient_local) {
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  dds_qset_writer_data_lifecycle(qos.get(), false);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &representation);
  return qos;
}

}  // namespace eciton::bus::cyclonedds
