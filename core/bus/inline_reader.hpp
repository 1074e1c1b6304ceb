// Readers that call back in the vendor's own thread as soon as a sample is there, for tools and benchmarks: no queue,
// no wake-up, no age. Services never use them: theirs is Reader, whose samples wait for the step.
#pragma once

#include <atomic>
#include <memory>

#include "core/bus/participant.hpp"

namespace eciton::bus {

/// What inline readers of every type share. The calls come from the vendor's thread, for samples of the participant's
/// own writers from the writing one: these two may come at the same time. None comes after destruction, which must
/// not be asked for in a call. Whoever writes in a call uses a writer that no other thread uses, and meanwhile no
/// other endpoint of the participant is made or destroyed; where another inline reader of the process answers, Fast
/// DDS calls it within the call.
class InlineReaderCore {
 public:
  /// Whether the bytes were a sample of the type. Real-time safe if what it calls is.
  using Accept = bool (*)(void* context, std::span<const std::uint8_t> cdr);

  InlineReaderCore(Participant& participant, const TopicInfo& topic, Accept accept, void* context);
  ~InlineReaderCore();
  InlineReaderCore(const InlineReaderCore&) = delete;
  InlineReaderCore& operator=(const InlineReaderCore&) = delete;

  void deliver(std::span<const std::uint8_t> cdr) noexcept;

  const std::string& topic_name() const { return name_; }
  std::uint32_t matched() const;
  ReaderStatistics statistics() const;

 private:
  Participant& participant_;
  std::string name_;
  eciton_type type_;
  Accept accept_;
  void* context_;
  std::atomic<std::uint64_t> delivered_{0}, malformed_{0};
  eciton_reader* handle_ = nullptr;
};

template <Message T>
class InlineReader {
 public:
  using Callback = void (*)(void* context, const T& sample);

  InlineReader(Participant& participant, const Topic<T>& topic, Callback callback, void* context)
      : target_(std::make_unique<Target>(Target{callback, context})),
        core_(std::make_unique<InlineReaderCore>(participant, info(topic), &decode_and_call, target_.get())) {}

  std::uint32_t matched() const { return core_->matched(); }
  ReaderStatistics statistics() const { return core_->statistics(); }

 private:
  struct Target {
    Callback callback;
    void* context;
  };
  static bool decode_and_call(void* context, std::span<const std::uint8_t> cdr) {
    T sample;  // on the stack of whichever thread it is
    if (!decode(cdr, sample)) return false;
    const auto& target = *static_cast<const Target*>(context);
    target.callback(target.context, sample);
    return true;
  }

  std::unique_ptr<Target> target_;
  std::unique_ptr<InlineReaderCore> core_;  // last: the first to go
};

/// The same with the bytes as they came.
class InlineRawReader {
 public:
  using Sink = RawReader::Sink;

  InlineRawReader(Participant& participant, const TopicInfo& topic, Sink sink, void* context);

  std::uint32_t matched() const { return core_->matched(); }
  ReaderStatistics statistics() const { return core_->statistics(); }

 private:
  struct Target {
    Sink sink;
    void* context;
    eciton_type type;
  };
  static bool check_and_call(void* context, std::span<const std::uint8_t> cdr);

  std::unique_ptr<Target> target_;
  std::unique_ptr<InlineReaderCore> core_;
};

}  // namespace eciton::bus
