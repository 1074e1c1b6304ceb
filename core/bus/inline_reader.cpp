// Inline readers: what is counted may be counted by two threads at once, hence the atomics.
#include "core/bus/inline_reader.hpp"

#include <algorithm>
#include <array>

namespace eciton::bus {

InlineReaderCore::InlineReaderCore(Participant& participant, const TopicInfo& topic, Accept accept, void* context)
    : participant_(participant), name_(topic.name), type_(topic.type), accept_(accept), context_(context) {
  const eciton_qos qos = plugin_qos(topic.qos, topic.type.key_size > 0);
  const eciton_delivery delivery{.signal = nullptr,
                                 .sample =
                                     [](void* self, const std::uint8_t* cdr, std::uint32_t size) {
                                       static_cast<InlineReaderCore*>(self)->deliver({cdr, size});
                                     },
                                 .context = this};
  // Listed as long as calls may come: one that writes goes through the list.
  participant_.inline_readers_.push_back(this);
  std::array<char, 512> error{};
  handle_ = participant_.plugin_->reader_create(participant_.handle_, name_.c_str(), &type_, &qos, delivery,
                                                error.data(), error.size());
  if (handle_ != nullptr) return;
  std::erase(participant_.inline_readers_, this);
  throw BadInput{{"inline reader of topic " + name_ + ": " + error.data()}};
}

InlineReaderCore::~InlineReaderCore() {
  const ReaderStatistics last = statistics();
  participant_.plugin_->reader_destroy(handle_);
  std::erase(participant_.inline_readers_, this);
  participant_.dropped_by_gone_readers_ += last.dropped() + last.dropped_by_vendor();
}

void InlineReaderCore::deliver(std::span<const std::uint8_t> cdr) noexcept {
  (accept_(context_, cdr) ? delivered_ : malformed_).fetch_add(1, std::memory_order_relaxed);
}

std::uint32_t InlineReaderCore::matched() const { return participant_.plugin_->reader_matched(handle_); }

ReaderStatistics InlineReaderCore::statistics() const {
  ReaderStatistics count;
  count.delivered = delivered_.load(std::memory_order_relaxed);
  count.dropped_malformed = malformed_.load(std::memory_order_relaxed);
  count.received = count.delivered + count.dropped_malformed;
  set_losses(count, *participant_.plugin_, handle_);
  return count;
}

InlineRawReader::InlineRawReader(Participant& participant, const TopicInfo& topic, Sink sink, void* context)
    : target_(std::make_unique<Target>(Target{sink, context, topic.type})),
      core_(std::make_unique<InlineReaderCore>(participant, topic, &check_and_call, target_.get())) {}

bool InlineRawReader::check_and_call(void* context, std::span<const std::uint8_t> cdr) {
  const auto& target = *static_cast<const Target*>(context);
  if (!may_be_sample(target.type, cdr)) return false;
  target.sink(target.context, cdr);
  return true;
}

}  // namespace eciton::bus
