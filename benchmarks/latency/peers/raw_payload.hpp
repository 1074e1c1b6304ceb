// The payload as it lies in memory, for transports that carry bytes: the same length as the CDR of the others.
#pragma once

#include <array>
#include <cstring>
#include <span>

#include "benchmarks/latency/peers/transport.hpp"

namespace eciton::bench {

/// The bytes to send; send() of one thread at a time.
class RawPayload {
 public:
  RawPayload() {
    std::array<double, payload_sizes.back() / sizeof(double) - 2> values;
    fill(values);
    std::memcpy(bytes_.data() + head, values.data(), sizeof values);
  }
  void resize(std::uint32_t size) { size_ = size; }
  std::span<const std::byte> with(const Mark& mark) noexcept {
    std::memcpy(bytes_.data() + 4, &mark.sequence, sizeof mark.sequence);
    std::memcpy(bytes_.data() + 8, &mark.stamp_ns, sizeof mark.stamp_ns);
    return {bytes_.data(), size_};
  }

  static constexpr std::size_t head = 16;  // module id, sequence, stamp

 private:
  std::size_t size_ = payload_sizes.front();
  std::array<std::byte, payload_sizes.back()> bytes_{};
};

/// Copies the sample out as every receiver does, and hands it on; what is no payload is left.
inline void give(std::span<const std::byte> bytes, Sink& sink) noexcept {
  alignas(8) std::array<std::byte, payload_sizes.back()> sample;
  if (bytes.size() < payload_sizes.front() || bytes.size() > sample.size()) return;
  std::memcpy(sample.data(), bytes.data(), bytes.size());
  Mark mark;
  double last = 0;
  std::memcpy(&mark.sequence, sample.data() + 4, sizeof mark.sequence);
  std::memcpy(&mark.stamp_ns, sample.data() + 8, sizeof mark.stamp_ns);
  std::memcpy(&last, sample.data() + bytes.size() - sizeof last, sizeof last);
  const auto values = static_cast<double>((bytes.size() - RawPayload::head) / sizeof(double));
  sink.arrived(mark, last == values - 0.5);
}

}  // namespace eciton::bench
