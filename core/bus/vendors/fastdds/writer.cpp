// Writes bytes with Fast DDS, synchronously: the calling thread sends, so that no second thread adds jitter.
#include "core/bus/vendors/fastdds/bytes_type.hpp"
#include "core/bus/vendors/fastdds/endpoints.hpp"
#include "core/bus/vendors/fastdds/qos.hpp"
#include "core/bus/vendors/request.hpp"

namespace fast = eprosima::fastdds::dds;
using eciton::Error;
using eciton::Result;

Result<eciton_writer*> eciton_writer::create(eciton_participant& participant, const char* topic,
                                             const eciton_type& type, const eciton_qos& qos) {
  if (const eciton::Status checked = eciton::bus::vendors::check_endpoint(topic, type, qos); !checked) {
    return checked.error();
  }
  const Result<fast::Topic*> on = participant.topic(topic, type);
  if (!on) return on.error();
  std::unique_ptr<eciton_writer> created(new eciton_writer(participant, type, qos));
  created->writer_ = participant.publisher->create_datawriter(*on, eciton::bus::fastdds::writer_qos(qos),
                                                              created.get(), fast::StatusMask::publication_matched());
  if (created->writer_ == nullptr) {
    return Error{participant.label() + ": Fast DDS cannot create a writer of topic \"" + topic + "\""};
  }
  return created.release();
}

eciton_writer::~eciton_writer() {
  if (writer_ != nullptr) participant_.publisher->delete_datawriter(writer_);
}

bool eciton_writer::write(const std::uint8_t* cdr, std::uint32_t size) {
  eciton::bus::fastdds::Bytes bytes{cdr, size};
  std::uint8_t hash[16];
  if (!eciton::bus::vendors::well_formed(type_, cdr, size)) return false;
  if (!eciton::bus::vendors::key_hash_of(type_, cdr, size, false, hash)) return false;
  if (keeps_nothing_ && matched() == 0) return true;
  return writer_->write(&bytes);
}

void eciton_writer::on_publication_matched(fast::DataWriter*, const fast::PublicationMatchedStatus& status) {
  if (participant_.owns(status.last_subscription_handle)) return;
  matched_.fetch_add(static_cast<std::uint32_t>(status.current_count_change), std::memory_order_relaxed);
}
