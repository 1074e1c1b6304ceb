// A Fast DDS participant on one network interface, and the topics and types that its endpoints share.
#pragma once

#include <atomic>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <string>

#include "core/base/result.hpp"
#include "core/bus/plugin.h"
#include "core/bus/vendors/reannouncer.hpp"

struct eciton_participant final : eprosima::fastdds::dds::DomainParticipantListener {
  static eciton::Result<eciton_participant*> create(const eciton_participant_config& config);
  ~eciton_participant() override;

  /// The topic, created and its type registered when first asked for.
  eciton::Result<eprosima::fastdds::dds::Topic*> topic(const char* name, const eciton_type& type);
  /// "participant "x" in domain 3", for messages.
  std::string label() const;
  bool owns(const eprosima::fastrtps::rtps::InstanceHandle_t& endpoint) const;

  eprosima::fastdds::dds::DomainParticipant* participant = nullptr;
  eprosima::fastdds::dds::Publisher* publisher = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber = nullptr;

 private:
  eciton_participant() : reannouncer_([this] { announce(); }) {}
  void on_participant_discovery(eprosima::fastdds::dds::DomainParticipant* self,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& found) override;
  void announce();

  // The same as `participant`, known from the first discovery on: that may come before create_participant returns.
  std::atomic<eprosima::fastdds::dds::DomainParticipant*> announced_{nullptr};
  eciton::bus::vendors::Reannouncer reannouncer_;
};
