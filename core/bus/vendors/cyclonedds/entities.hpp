// Participant, writer and reader of bytes on Cyclone DDS.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/base/result.hpp"
#include "core/bus/plugin.h"
#include "core/bus/vendors/cyclonedds/bytes_pool.hpp"
#include "core/bus/vendors/cyclonedds/domain.hpp"
#include "core/bus/vendors/cyclonedds/vendor.hpp"
#include "core/bus/vendors/instance_set.hpp"
#include "core/bus/vendors/reannouncer.hpp"
#include "core/bus/vendors/sequence_gaps.hpp"

namespace eciton::bus::cyclonedds {

/// An entity that is deleted with its owner.
class Entity {
 public:
  Entity() = default;
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  ~Entity() { reset(0); }
  void reset(dds_entity_t handle) {
    if (handle_ > 0) dds_delete(handle_);
    handle_ = handle;
  }
  dds_entity_t get() const { return handle_; }
  bool good() const { return handle_ > 0; }

 private:
  dds_entity_t handle_ = 0;
};

/// Pool memory held for one endpoint.
class Reservation {
 public:
  Reservation() = default;
  Reservation(const Reservation&) = delete;
  Reservation& operator=(const Reservation&) = delete;
  ~Reservation();
  bool acquire(const eciton_type& type, const eciton_qos& qos);

 private:
  std::size_t sample_size_ = 0;
  std::size_t samples_ = 0;
  std::size_t keys_ = 0;
};

}  // namespace eciton::bus::cyclonedds

struct eciton_participant {
  static eciton::Result<eciton_participant*> create(const eciton_participant_config& config);
  std::string label() const;

  eciton::bus::cyclonedds::SharedDomain domain;  // outlives the participant
  std::string name;
  std::uint32_t domain_id;
  eciton::bus::cyclonedds::Entity participant;

 private:
  eciton_participant(eciton::bus::cyclonedds::SharedDomain&& in, const eciton_participant_config& config);
  static void on_discovery(dds_entity_t reader, void* self);
  void announce();

  std::uint8_t announcement_ = 0;
  eciton::bus::vendors::Reannouncer reannouncer_;
  eciton::bus::cyclonedds::Entity discovery_;  // reader of the vendor's list of participants; first to go
};

struct eciton_writer {
  static eciton::Result<eciton_writer*> create(eciton_participant& participant, const char* topic,
                                               const eciton_type& type, const eciton_qos& qos);
  bool write(const std::uint8_t* cdr, std::uint32_t size);
  std::uint32_t matched() const { return matched_.load(std::memory_order_relaxed); }

 private:
  eciton_writer(const eciton_type& type, const eciton_qos& qos)
      : type_(type), keeps_nothing_(qos.reliable == 0 && qos.transient_local == 0), keys_(qos.instances_max) {}
  static void on_matched(dds_entity_t writer, const dds_publication_matched_status_t status, void* self);

  eciton_type type_;
  bool keeps_nothing_;  // for whoever is not there yet
  std::atomic<std::uint32_t> matched_{0};
  eciton::bus::cyclonedds::InheritingMutex keys_mutex_;
  eciton::bus::vendors::InstanceSet keys_;
  eciton::bus::cyclonedds::Reservation memory_;
  eciton::bus::cyclonedds::Entity topic_;
  eciton::bus::cyclonedds::Entity writer_;  // last: deleted first, and with it the last call of on_matched
};

struct eciton_reader {
  static eciton::Result<eciton_reader*> create(eciton_participant& participant, const char* topic,
                                               const eciton_type& type, const eciton_qos& qos,
                                               eciton_delivery delivery);
  std::uint32_t take(std::uint32_t count_max, eciton_sink sink, void* context);
  std::uint32_t matched() const;
  eciton_reader_losses losses() const;
  std::uint64_t origin() const { return origin_; }

 private:
  eciton_reader(const eciton_type& type, const eciton_qos& qos, eciton_delivery delivery)
      : type_(type),
        reliable_(qos.reliable != 0),
        keeps_past_(qos.transient_local != 0),
        keys_(qos.instances_max),
        delivery_(delivery) {}
  std::uint32_t take_from(dds_entity_t reader, std::uint32_t count_max, eciton_sink sink, void* context);
  static void on_data_available(dds_entity_t reader, void* self);
  static bool admit(const void* sample, void* self);

  eciton_type type_;
  bool reliable_;
  bool keeps_past_;
  eciton::bus::vendors::InstanceSet keys_;   // used under the lock of the vendor's history,
  eciton::bus::vendors::SequenceGaps gaps_;  // as is this
  std::atomic<std::uint64_t> missing_{0}, rejected_{0}, admitted_{0}, replaced_{0};
  std::uint64_t given_ = 0;   // of who takes, as is this: ...
  std::uint64_t origin_ = 0;  // ... of the sample being given
  eciton_delivery delivery_;
  eciton::bus::cyclonedds::Reservation memory_;
  eciton::bus::cyclonedds::Entity topic_;
  eciton::bus::cyclonedds::Entity reader_;  // last: deleted first, and with it the last call of the two above
};
