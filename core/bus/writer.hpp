// Writers: of a type, and of raw bytes.
#pragma once

#include <memory>

#include "core/bus/participant.hpp"

namespace eciton::bus {

template <Message T>
class Writer {
 public:
  Writer(Participant& participant, const Topic<T>& topic)
      : core_(std::make_unique<WriterCore>(participant, info(topic))) {}

  /// Serializes once and hands the bytes on. Real-time safe. False: refused by the vendor, and counted.
  bool write(const T& sample) noexcept {
    const std::size_t size = encode(sample, core_->buffer());
    return core_->write(core_->buffer().first(size));
  }
  /// Readers of other participants matched now.
  std::uint32_t matched() const { return core_->matched(); }
  std::uint64_t written() const { return core_->written(); }
  std::uint64_t refused() const { return core_->refused(); }

 private:
  std::unique_ptr<WriterCore> core_;
};

class RawWriter {
 public:
  RawWriter(Participant& participant, const TopicInfo& topic)
      : core_(std::make_unique<WriterCore>(participant, topic)) {}

  bool write(std::span<const std::uint8_t> cdr) noexcept { return core_->write(cdr); }
  std::uint32_t matched() const { return core_->matched(); }
  const TopicInfo& topic() const { return core_->topic(); }

 private:
  std::unique_ptr<WriterCore> core_;
};

}  // namespace eciton::bus
