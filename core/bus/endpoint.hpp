// What readers and writers of every type share: the plugin's handle, delivery inside the participant,
// and the type-erased description of a topic.
#pragma once

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "core/bus/codec.hpp"
#include "core/bus/inbox.hpp"
#include "core/bus/plugin.h"
#include "core/bus/topic.hpp"

namespace eciton::bus {

class Participant;

/// A topic without its C++ type.
struct TopicInfo {
  std::string_view name;
  QosClass qos;
  Scope scope;
  Duration deadline;
  Duration lifespan;
  eciton_type type;
  std::uint32_t depth = 0;  // samples of each key that a reader of bytes keeps; 0: as the class says
};

template <Message T>
TopicInfo info(const Topic<T>& topic) {
  using Traits = TypeTraits<T>;
  // The generator's names are literals, so they end with a zero.
  return {topic.name,
          topic.qos,
          topic.scope,
          topic.deadline,
          topic.lifespan,
          {.name = Traits::name.data(),
           .size_max = Traits::size_max,
           .key_size = Traits::key_size,
           .key_hash = &key_hash_of_bytes<T>},
          0};
}

/// The one mapping from QoS class to what a plugin is asked for.
eciton_qos plugin_qos(QosClass qos, bool keyed);

/// The vendor's part of a reader's statistics. Real-time safe.
void set_losses(ReaderStatistics& statistics, const eciton_plugin& plugin, eciton_reader* reader) noexcept;
/// What can be told of raw bytes: they are not too many, and have the type's key.
bool may_be_sample(const eciton_type& type, std::span<const std::uint8_t> cdr, KeyHash* key = nullptr) noexcept;

class ReaderCore {
 public:
  ReaderCore(Participant& participant, const TopicInfo& topic);
  virtual ~ReaderCore();
  ReaderCore(const ReaderCore&) = delete;
  ReaderCore& operator=(const ReaderCore&) = delete;

  /// Puts one sample's bytes into the queue; called on the participant's thread.
  virtual void accept(std::span<const std::uint8_t> cdr) noexcept = 0;

  /// Moves what the vendor holds into the queue.
  void fetch() noexcept;

  /// Whether a sample is queued, and the newest stamp that ever came in: what a triggered service waits for.
  virtual bool has_sample() const noexcept = 0;
  TimePoint newest_stamp() const noexcept { return newest_stamp_; }
  /// How many samples were queued that may trigger a step.
  std::uint64_t news() const noexcept { return news_; }

  /// Stands for this participant's own writers, as an origin.
  static constexpr std::uint64_t own_origin = ~std::uint64_t{0};

  /// Whether samples that come from now on signal the participant's waker; look for those already there by fetch().
  void set_wakes(bool wakes) noexcept { wakes_.store(wakes); }

  const TopicInfo& topic() const { return topic_; }
  std::uint32_t matched() const;
  const ReaderStatistics& statistics() const;
  Participant& participant() { return participant_; }

 protected:
  friend class WriterCore;
  /// Within accept: which participant the sample comes from; 0: not known.
  std::uint64_t origin() const noexcept;

  Participant& participant_;
  TopicInfo topic_;
  mutable ReaderStatistics statistics_;  // the vendor's part is fetched when asked for
  std::uint64_t news_ = 0;
  TimePoint newest_stamp_{-std::chrono::hours(24 * 365 * 100)};  // "never", far from overflow

 private:
  std::string name_;
  eciton_reader* handle_ = nullptr;
  bool from_own_ = false;  // what is being accepted
  std::atomic<bool> fresh_{true};
  std::atomic<bool> wakes_;
};

class WriterCore {
 public:
  WriterCore(Participant& participant, const TopicInfo& topic);
  ~WriterCore();
  WriterCore(const WriterCore&) = delete;
  WriterCore& operator=(const WriterCore&) = delete;

  /// To the vendor, and to the participant's own readers of the topic. False: the vendor refused it.
  bool write(std::span<const std::uint8_t> cdr) noexcept;
  std::span<std::uint8_t> buffer() { return buffer_; }
  std::uint32_t matched() const;
  std::uint64_t written() const { return written_; }
  std::uint64_t refused() const { return refused_; }
  const TopicInfo& topic() const { return topic_; }

 private:
  Participant& participant_;
  TopicInfo topic_;
  std::string name_;
  std::vector<std::uint8_t> buffer_;
  eciton_writer* handle_ = nullptr;
  std::uint64_t written_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace eciton::bus
