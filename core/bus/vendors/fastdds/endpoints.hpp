// Writer and reader of bytes on Fast DDS. Both are their own listeners, for counting matched peers without a lock.
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
  std::uint64_t origin() const { return origin_; }

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
  std::uint64_t origin_ = 0;                 // of the sample being given
  std::atomic<std::uint64_t> missing_{0};    // among the numbers of what was taken
  std::atomic<std::uint64_t> malformed_{0};
  std::atomic<std::uint32_t> lost_{0}, rejected_{0};  // as the vendor's own statuses have it
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
};
