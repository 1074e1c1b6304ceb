// A reader of raw bytes: the queue of an Inbox, without decoding.
#include <algorithm>
#include <vector>

#include "core/bus/participant.hpp"

namespace eciton::bus {

class RawReader::Core final : public ReaderCore {
 public:
  Core(Participant& participant, const TopicInfo& topic)
      : ReaderCore(participant, topic),
        keep_last_one_(topic.qos != QosClass::event && topic.depth <= 1),
        slots_(capacity(topic)) {
    for (Slot& slot : slots_) slot.bytes.resize(topic.type.size_max);
  }

  void accept(std::span<const std::uint8_t> cdr) noexcept override {
    ++statistics_.received;
    KeyHash key{};
    if (!may_be_sample(topic_.type, cdr, &key)) {
      ++statistics_.dropped_malformed;
      return;
    }
    Slot& slot = slot_for(key);
    std::copy(cdr.begin(), cdr.end(), slot.bytes.begin());
    slot.size = static_cast<std::uint32_t>(cdr.size());
    slot.key = key;
    slot.origin = ReaderCore::origin();
  }

  bool has_sample() const noexcept override { return count_ > 0; }

  void give(Sink sink, void* context) {
    for (; count_ > 0; --count_) {
      const Slot& slot = slots_[first_];
      first_ = (first_ + 1) % slots_.size();
      ++statistics_.delivered;
      given_origin_ = slot.origin;
      sink(context, std::span(slot.bytes).first(slot.size));
    }
  }

  std::uint64_t given_origin() const { return given_origin_; }

 private:
  struct Slot {
    KeyHash key{};
    std::uint32_t size = 0;
    std::uint64_t origin = 0;
    std::vector<std::uint8_t> bytes;
  };

  static std::size_t capacity(const TopicInfo& topic) {
    const eciton_qos qos = plugin_qos(topic.qos, topic.type.key_size > 0);
    return std::max({qos.depth, topic.depth, qos.instances_max});
  }

  Slot& slot_for(const KeyHash& key) {
    for (std::size_t k = 0; k < count_ && keep_last_one_; ++k) {
      Slot& queued = slots_[(first_ + k) % slots_.size()];
      if (queued.key != key) continue;
      ++statistics_.replaced;
      return queued;
    }
    if (count_ == slots_.size()) {
      first_ = (first_ + 1) % slots_.size();
      --count_;
      ++statistics_.dropped_overflow;
    }
    return slots_[(first_ + count_++) % slots_.size()];
  }

  bool keep_last_one_;
  std::vector<Slot> slots_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::uint64_t given_origin_ = 0;
};

RawReader::RawReader(Participant& participant, const TopicInfo& topic)
    : core_(std::make_unique<Core>(participant, topic)) {}
RawReader::~RawReader() = default;
RawReader::RawReader(RawReader&&) noexcept = default;

std::uint64_t RawReader::origin() const { return core_->given_origin(); }
std::uint32_t RawReader::matched() const { return core_->matched(); }
const TopicInfo& RawReader::topic() const { return core_->topic(); }
const ReaderStatistics& RawReader::statistics() const { return core_->statistics(); }

void RawReader::take(Sink sink, void* context) noexcept {
  core_->fetch();
  core_->give(sink, context);
}

}  // namespace eciton::bus
