// Writer and reader of bytes on Fast DDS, and the QoS they share. Both are their own listeners, for counting
// matched peers without a lock.
#pragma once

#include <atomic>
#include <cstdint>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>

#include "core/base/result.hpp"
#include "core/bus/vendors/fastdds/participant.hpp"
#include "core/bus/vendors/sequence_gaps.hpp"

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

}  // namespace eciton::bus::fastdds

struct eciton_writer final : eprosima::fastdds::dds::DataWriterListener {
  static eciton::Result<eciton_writer*> create(eciton_participant& participant, const char* topic,
                                               const eciton_type& type, const eciton_qos& qos);
  ~eciton_writer() override;

  bool write(const std::uint8_t* cdr, std::uint32_t size);
  std::uint32_t matched() const { return matched_.load(std::memory_order_relaxed); }

  void on_publication_matched(eprosima::fastdds::dds::DataWriter* writer,
                              const eprosima::fastdds::dds::PublicationMatchedStatus& status) override;

 private:
  eciton_writer(eciton_participant& participant, const eciton_type& type, const eciton_qos& qos)
      : participant_(participant), type_(type), keeps_nothing_(qos.reliable == 0 && qos.transient_local == 0) {}

  eciton_participant& participant_;
  eciton_type type_;
  bool keeps_nothing_;  // for whoever is not there yet
  std::atomic<std::uint32_t> matched_{0};
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
};

struct eciton_reader final : eprosima::fastdds::dds::DataReaderListener {
  static eciton::Result<eciton_reader*> create(eciton_participant& participant, const char* topic,
                                               const eciton_type& type, const eciton_qos& qos,
                                               eciton_delivery delivery);
  ~eciton_reader() override;

  std::uint32_t take(std::uint32_t count_max, eciton_sink sink, void* context);
  std::uint32_t matched() const { return matched_.load(std::memory_order_relaxed); }
  eciton_reader_losses losses() const;

  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;
  void on_subscription_matched(eprosima::fastdds::dds::DataReader* reader,
                               const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;
  void on_sample_lost(eprosima::fastdds::dds::DataReader* reader,
                      const eprosima::fastdds::dds::SampleLostStatus& status) override;
  void on_sample_rejected(eprosima::fastdds::dds::DataReader* reader,
                          const eprosima::fastrtps::SampleRejectedStatus& status) override;

 private:
  eciton_reader(eciton_participant& participant, const eciton_type& type, const eciton_qos& qos,
                eciton_delivery delivery)
      : participant_(participant),
        type_(type),
        reliable_(qos.reliable != 0),
        keeps_past_(qos.transient_local != 0),
        delivery_(delivery) {}
  std::uint32_t take_from(eprosima::fastdds::dds::DataReader& reader, std::uint32_t count_max, eciton_sink sink,
                          void* context);
  /// Takes up to `count_max` samples on loan and gives the good ones to the sink; 0 taken: nothing is left.
  std::uint32_t take_some(eprosima::fastdds::dds::DataReader& reader, std::uint32_t count_max, eciton_sink sink,
                          void* context, std::uint32_t& given);

  eciton_participant& participant_;
  eciton_type type_;
  bool reliable_;
  bool keeps_past_;
  eciton_delivery delivery_;
  std::atomic<std::uint32_t> matched_{0};
  eciton::bus::vendors::SequenceGaps gaps_;  // of who takes
  std::atomic<std::uint64_t> missing_{0};    // among the numbers of what was taken
  std::atomic<std::uint64_t> malformed_{0};
  std::atomic<std::uint32_t> lost_{0}, rejected_{0};  // as the vendor's own statuses have it
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
};
