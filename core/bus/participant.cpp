// The participant, and what all readers and writers share.
#include "core/bus/participant.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/bus/inline_reader.hpp"
#include "core/bus/plugin_loader.hpp"

namespace eciton::bus {

eciton_qos plugin_qos(QosClass qos, bool keyed) {
  constexpr std::uint32_t instances_max = 64;  // 16 modules with four ports each
  const std::uint32_t instances = keyed ? instances_max : 1;
  switch (qos) {
    case QosClass::sensor:
      return {0, 0, 1, instances};
    case QosClass::command:
      return {1, 0, 1, instances};
    case QosClass::state:
      return {1, 1, 1, instances};
    case QosClass::event:
      return {1, 1, 64, instances};
  }
  return {};
}

Participant::Participant(const ParticipantConfig& config, Waker* shared_waker)
    : config_(config),
      plugin_(value_or_throw(load_plugin(config.vendor))),
      own_waker_(shared_waker == nullptr ? std::make_unique<Waker>() : nullptr),
      waker_(shared_waker == nullptr ? own_waker_.get() : shared_waker) {
  std::vector<const char*> peers;
  for (const std::string& peer : config_.peers) peers.push_back(peer.c_str());
  const eciton_participant_config plugin_config{
      .domain = config_.domain,
      .name = config_.name.c_str(),
      .network_interface = config_.network_interface.c_str(),
      .peers = peers.data(),
      .peer_count = static_cast<std::uint32_t>(peers.size()),
      .lease_ms =
          static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(config_.lease).count())};
  std::array<char, 512> error{};
  handle_ = plugin_->participant_create(&plugin_config, error.data(), error.size());
  if (handle_ == nullptr) {
    throw BadInput{{config_.vendor + ", domain " + std::to_string(config_.domain) + " on interface " +
                    config_.network_interface + ": " + error.data()}};
  }
}

Participant::~Participant() { plugin_->participant_destroy(handle_); }

std::uint64_t Participant::dropped() const {
  std::uint64_t sum = dropped_by_gone_readers_;
  const auto add = [&sum](const ReaderStatistics& count) { sum += count.dropped() + count.dropped_by_vendor(); };
  for (const ReaderCore* reader : readers_) add(reader->statistics());
  for (const InlineReaderCore* reader : inline_readers_) add(reader->statistics());
  return sum;
}

void Participant::set_all_wake(bool wake) {
  readers_wake_ = wake;
  for (ReaderCore* reader : readers_) reader->set_wakes(wake);
}

RawWriter Participant::create_raw_writer(const TopicInfo& topic) { return {*this, topic}; }
RawReader Participant::create_raw_reader(const TopicInfo& topic) { return {*this, topic}; }
InlineRawReader Participant::create_inline_raw_reader(const TopicInfo& topic, RawReader::Sink sink, void* context) {
  return {*this, topic, sink, context};
}

void set_losses(ReaderStatistics& statistics, const eciton_plugin& plugin, eciton_reader* reader) noexcept {
  eciton_reader_losses losses{};
  plugin.reader_losses(reader, &losses);
  statistics.vendor_lost = losses.lost;
  statistics.vendor_rejected = losses.rejected;
  statistics.vendor_replaced = losses.replaced;
}

bool may_be_sample(const eciton_type& type, std::span<const std::uint8_t> cdr, KeyHash* key) noexcept {
  KeyHash hash{};
  const bool good =
      cdr.size() >= encapsulation_size && cdr.size() <= type.size_max &&
      (type.key_size == 0 || type.key_hash(cdr.data(), static_cast<std::uint32_t>(cdr.size()), 0, hash.data()) != 0);
  if (key != nullptr) *key = hash;
  return good;
}

namespace {

std::string failed(const char* what, const std::string& topic, const char* error) {
  return std::string(what) + " of topic " + topic + ": " + error;
}

}  // namespace

ReaderCore::ReaderCore(Participant& participant, const TopicInfo& topic)
    : participant_(participant), topic_(topic), name_(topic.name), wakes_(participant.readers_wake_) {
  topic_.name = name_;
  eciton_qos qos = plugin_qos(topic.qos, topic.type.key_size > 0);
  qos.depth = std::max(qos.depth, topic.depth);
  const auto signal = [](void* context) {
    auto* reader = static_cast<ReaderCore*>(context);
    // Sequentially consistent with set_wakes and the fetch that follows it: either we see that it wakes, or that
    // fetch sees the sample.
    reader->fresh_.store(true);
    if (reader->wakes_.load()) reader->participant_.waker_->signal();
  };
  const eciton_delivery delivery{.signal = signal, .sample = nullptr, .context = this};
  std::array<char, 512> error{};
  handle_ = participant_.plugin_->reader_create(participant_.handle_, name_.c_str(), &topic_.type, &qos, delivery,
                                                error.data(), error.size());
  if (handle_ == nullptr) throw BadInput{{failed("reader", name_, error.data())}};
  participant_.readers_.push_back(this);
}

ReaderCore::~ReaderCore() {
  const ReaderStatistics& last = statistics();
  participant_.plugin_->reader_destroy(handle_);
  participant_.dropped_by_gone_readers_ += last.dropped() + last.dropped_by_vendor();
  std::erase(participant_.readers_, this);
}

void ReaderCore::fetch() noexcept {
  // Cleared before the look: a sample that comes meanwhile sets it again.
  if (!fresh_.load() || !fresh_.exchange(false)) return;
  constexpr std::uint32_t batch = 32;
  constexpr int batches_max = 8;
  const auto sink = [](void* context, const std::uint8_t* cdr, std::uint32_t size) {
    static_cast<ReaderCore*>(context)->accept({cdr, size});
  };
  for (int k = 0; k < batches_max; ++k) {
    if (participant_.plugin_->reader_take(handle_, batch, sink, this) < batch) return;
  }
  fresh_.store(true, std::memory_order_release);  // there may be more: go on at the next take
}

const ReaderStatistics& ReaderCore::statistics() const {
  set_losses(statistics_, *participant_.plugin_, handle_);
  return statistics_;
}

std::uint64_t ReaderCore::origin() const noexcept {
  return from_own_ ? own_origin : participant_.plugin_->reader_origin(handle_);
}

std::uint32_t ReaderCore::matched() const { return participant_.plugin_->reader_matched(handle_); }

WriterCore::WriterCore(Participant& participant, const TopicInfo& topic)
    : participant_(participant), topic_(topic), name_(topic.name), buffer_(topic.type.size_max) {
  topic_.name = name_;
  const eciton_qos qos = plugin_qos(topic.qos, topic.type.key_size > 0);
  std::array<char, 512> error{};
  handle_ = participant_.plugin_->writer_create(participant_.handle_, name_.c_str(), &topic_.type, &qos, error.data(),
                                                error.size());
  if (handle_ == nullptr) throw BadInput{{failed("writer", name_, error.data())}};
}

WriterCore::~WriterCore() { participant_.plugin_->writer_destroy(handle_); }

bool WriterCore::write(std::span<const std::uint8_t> cdr) noexcept {
  const bool accepted = !cdr.empty() && participant_.plugin_->writer_write(
                                            handle_, cdr.data(), static_cast<std::uint32_t>(cdr.size())) != 0;
  ++(accepted ? written_ : refused_);
  if (cdr.empty()) return false;
  // Composed services share a participant: no network hop between them.
  for (ReaderCore* reader : participant_.readers_) {
    if (reader->name_ != name_) continue;
    reader->from_own_ = true;
    reader->accept(cdr);
    reader->from_own_ = false;
    if (reader->wakes_.load()) participant_.waker_->signal();
  }
  for (InlineReaderCore* reader : participant_.inline_readers_) {
    if (reader->topic_name() == name_) reader->deliver(cdr);
  }
  return accepted;
}

std::uint32_t WriterCore::matched() const { return participant_.plugin_->writer_matched(handle_); }

}  // namespace eciton::bus
