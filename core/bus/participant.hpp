// A process's place on one ring: makes the writers and readers of topics, over whichever vendor's plugin
// the config names. One thread uses a participant and its endpoints; vendors' threads only wake it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/bus/endpoint.hpp"
#include "core/bus/topic.hpp"
#include "core/bus/waker.hpp"

namespace eciton::bus {

template <Message T>
class Writer;
template <Message T>
class Reader;
class RawWriter;
class RawReader;
template <Message T>
class InlineReader;
class InlineRawReader;
class InlineReaderCore;

struct ParticipantConfig {
  std::string vendor = "cyclonedds";  // or fastdds, sim_network
  std::uint32_t domain = 0;
  std::string name = "eciton";
  std::string network_interface = "lo";
  std::vector<std::string> peers{};  // none: multicast
  Duration lease = std::chrono::seconds(3);
};

class Participant {
 public:
  /// Loads the vendor's plugin and joins the domain; throws BadInput naming what is wrong. One thread that waits
  /// for several participants gives the first one's waker to the others (it must outlive them).
  explicit Participant(const ParticipantConfig& config, Waker* shared_waker = nullptr);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Endpoints are made before a service is active (they allocate, and throw BadInput).
  template <Message T>
  Writer<T> create_writer(const Topic<T>& topic) {
    return Writer<T>(*this, topic);
  }
  template <Message T>
  Reader<T> create_reader(const Topic<T>& topic) {
    return Reader<T>(*this, topic);
  }
  /// Endpoints that carry a topic's bytes untouched, for the radio and for tools.
  RawWriter create_raw_writer(const TopicInfo& topic);
  RawReader create_raw_reader(const TopicInfo& topic);
  /// Readers that call `callback(context, sample)` at once, in the vendor's thread: for tools and benchmarks, which
  /// include core/bus/inline_reader.hpp. Services never use them.
  template <Message T>
  InlineReader<T> create_inline_reader(const Topic<T>& topic, void (*callback)(void* context, const T& sample),
                                       void* context) {
    return InlineReader<T>(*this, topic, callback, context);
  }
  InlineRawReader create_inline_raw_reader(const TopicInfo& topic,
                                           void (*sink)(void* context, std::span<const std::uint8_t> cdr),
                                           void* context);

  /// The time ages are reckoned from; the executor sets it before each step.
  void set_now(TimePoint now) { now_ = now; }
  TimePoint now() const { return now_; }

  /// How far a module's clock is ahead of ours; its stamps' ages are corrected by it. Ids over 127: ignored.
  void set_clock_offset(std::uint32_t module_id, Duration offset) {
    if (module_id < clock_offset_.size()) clock_offset_[module_id] = offset;
  }
  /// Nothing: not known yet.
  std::optional<Duration> clock_offset(std::uint32_t module_id) const {
    return module_id < clock_offset_.size() ? clock_offset_[module_id] : std::nullopt;
  }

  /// Signalled when a reader of this participant may have samples, unless it was told not to wake.
  Waker& waker() { return *waker_; }
  /// Whether its readers, those to come included, signal the waker; ReaderCore::set_wakes says it of one. An
  /// executor is woken only by what it waits for. At first they do.
  void set_all_wake(bool wake);
  const ParticipantConfig& config() const { return config_; }
  const char* vendor_version() const { return plugin_->version; }
  /// Over all its readers, those gone included, what the vendor lost or rejected as well.
  std::uint64_t dropped() const;

 private:
  friend class WriterCore;
  friend class ReaderCore;
  friend class InlineReaderCore;

  ParticipantConfig config_;
  const eciton_plugin* plugin_;
  eciton_participant* handle_ = nullptr;
  std::unique_ptr<Waker> own_waker_;
  Waker* waker_;
  bool readers_wake_ = true;
  TimePoint now_{};
  std::array<std::optional<Duration>, 128> clock_offset_{};
  std::vector<ReaderCore*> readers_;
  std::vector<InlineReaderCore*> inline_readers_;
  std::uint64_t dropped_by_gone_readers_ = 0;
};

}  // namespace eciton::bus

#include "core/bus/reader.hpp"
#include "core/bus/writer.hpp"
