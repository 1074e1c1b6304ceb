// Readers: of a type, and of raw bytes. Taking never blocks and never allocates.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include "core/bus/participant.hpp"

namespace eciton::bus {

template <Message T>
struct Sample {
  T value;
  Duration age;              // now less the stamp, corrected by what is known of the sender's clock
  std::uint64_t origin = 0;  // which participant wrote it, where the reader tells origins; 0: not known
  const T* operator->() const { return &value; }
  const T& operator*() const { return value; }
};

template <Message T>
class Reader {
 public:
  Reader(Participant& participant, const Topic<T>& topic) : core_(std::make_unique<Core>(participant, info(topic))) {}

  /// The next sample, oldest first; samples over the topic's lifespan are dropped and counted.
  std::optional<Sample<T>> take() noexcept {
    core_->fetch();
    while (const T* value = core_->inbox.pop()) {
      const Duration age = core_->age_of(*value);
      const Duration lifespan = core_->topic().lifespan;
      if (lifespan > Duration::zero() && age > lifespan) {
        core_->count_expired();
        continue;
      }
      core_->count_delivered();
      return Sample<T>{*value, age, core_->inbox.origin()};
    }
    return std::nullopt;
  }

  /// The newest of what is queued, whatever its key; for topics with one writer.
  std::optional<Sample<T>> take_newest() noexcept {
    std::optional<Sample<T>> newest;
    while (auto sample = take()) newest = sample;
    return newest;
  }

  /// Samples of other modules are delivered as ever, but are no news: they trigger no step and do not put off
  /// overdue(). For topics whose peers' samples the radio puts on the ring.
  void news_only_of(std::uint32_t module_id) requires requires(T sample) { sample.module_id; }
  { core_->news_of = module_id; }

  /// From here on its samples say which participant wrote them: a number that all writers of one share;
  /// ReaderCore::own_origin for this one's own.
  void tell_origins() { core_->tells_origins = true; }

  /// Whether the newest sample that came is older than the topic's deadline, or none came yet.
  bool overdue() const { return core_->participant().now() - core_->newest_stamp() > core_->topic().deadline; }

  /// For a schedule: step when this reader has a sample.
  ReaderCore& trigger() { return *core_; }

  /// Writers of other participants matched now.
  std::uint32_t matched() const { return core_->matched(); }
  const ReaderStatistics& statistics() const { return core_->statistics(); }
  std::string_view topic_name() const { return core_->topic().name; }

 private:
  struct Core final : ReaderCore {
    Core(Participant& participant, const TopicInfo& topic)
        : ReaderCore(participant, topic),
          inbox(topic.qos == QosClass::event ? plugin_qos(topic.qos, true).depth : 1,
                TypeTraits<T>::keyed ? plugin_qos(topic.qos, true).instances_max : plugin_qos(topic.qos, false).depth,
                topic.qos == QosClass::sensor) {}
    void accept(std::span<const std::uint8_t> cdr) noexcept override {
      const T* value = inbox.push(cdr, statistics_, tells_origins ? origin() : 0);
      if (value == nullptr || !is_news(*value)) return;
      ++news_;
      newest_stamp_ = std::max(newest_stamp_, from_ns(value->stamp_ns));
    }
    bool has_sample() const noexcept override { return !inbox.empty(); }
    bool is_news(const T& value) const {
      if constexpr (requires { value.module_id; }) return !news_of || value.module_id == *news_of;
      return true;
    }
    Duration age_of(const T& value) const {
      Duration offset{};
      if constexpr (requires { value.module_id; }) {
        // A command's key is whom it is for, not who sent it.
        if (topic_.qos != QosClass::command) offset = participant_.clock_offset(value.module_id).value_or(Duration{});
      }
      return participant_.now() - (from_ns(value.stamp_ns) - offset);
    }
    void count_expired() { ++statistics_.dropped_expired; }
    void count_delivered() { ++statistics_.delivered; }
    Inbox<T> inbox;
    std::optional<std::uint32_t> news_of;
    bool tells_origins = false;
  };
  std::unique_ptr<Core> core_;
};

/// Samples as bytes; the newest of each key at the most, as the vendor keeps them.
class RawReader {
 public:
  using Sink = void (*)(void* context, std::span<const std::uint8_t> cdr);
  RawReader(Participant& participant, const TopicInfo& topic);
  ~RawReader();
  RawReader(RawReader&&) noexcept;

  /// Gives every sample that is there to `sink`; the bytes are valid during the call.
  void take(Sink sink, void* context) noexcept;
  /// Within the sink: as a Sample has it.
  std::uint64_t origin() const;
  std::uint32_t matched() const;
  const TopicInfo& topic() const;
  const ReaderStatistics& statistics() const;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace eciton::bus
