// The one place that knows Fast CDR.
#include "core/bus/codec.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <new>

namespace eciton::bus {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

template <class T>
void serialize(Cdr& cdr, bool& good, const T& value) {
  if (!good) return;
  try {
    cdr.serialize(value);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    good = false;
  }
}

/// Looked at before Fast CDR does: it would throw, and an exception comes from the heap.
bool has_bytes(const Cdr& cdr, std::size_t size, std::size_t element_size, std::size_t count) {
  const std::size_t at = cdr.getSerializedDataLength();
  const std::size_t misaligned = (at - encapsulation_size) % element_size;
  const std::size_t begin = misaligned == 0 ? at : at + element_size - misaligned;
  return begin <= size && size - begin >= element_size * count;
}

template <class T>
void deserialize(Cdr& cdr, std::size_t size, bool& good, T& value) {
  good = good && has_bytes(cdr, size, sizeof(T), 1);
  if (good) cdr.deserialize(value);
}

}  // namespace

struct Encoder::State {
  State(std::span<std::uint8_t> bytes, Cdr::Endianness endianness)
      : buffer(reinterpret_cast<char*>(bytes.data()), bytes.size()), cdr(buffer, endianness, Cdr::DDS_CDR) {
    good = bytes.size() >= encapsulation_size;
    if (good) cdr.serialize_encapsulation();
  }
  FastBuffer buffer;
  Cdr cdr;
  bool good;
};

Encoder::Encoder(std::span<std::uint8_t> buffer, bool big_endian) {
  static_assert(sizeof(State) <= sizeof(storage_));
  new (storage_) State(buffer, big_endian ? Cdr::BIG_ENDIANNESS : Cdr::LITTLE_ENDIANNESS);
}
Encoder::~Encoder() { state().~State(); }

std::size_t Encoder::finish() {
  const std::size_t size = state().cdr.getSerializedDataLength();
  for (std::size_t pad = size; pad % 4 != 0; ++pad) put(std::uint8_t{0});
  return state().good ? state().cdr.getSerializedDataLength() : 0;
}

void Encoder::put(bool value) { serialize(state().cdr, state().good, value); }
void Encoder::put(std::uint8_t value) { serialize(state().cdr, state().good, value); }
void Encoder::put(std::int32_t value) { serialize(state().cdr, state().good, value); }
void Encoder::put(std::uint32_t value) { serialize(state().cdr, state().good, value); }
void Encoder::put(std::int64_t value) { serialize(state().cdr, state().good, value); }
void Encoder::put(std::uint64_t value) { serialize(state().cdr, state().good, value); }
void Encoder::put(double value) { serialize(state().cdr, state().good, value); }

void Encoder::put_array(const double* values, std::size_t count) {
  State& s = state();
  if (!s.good) return;
  try {
    s.cdr.serializeArray(values, count);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    s.good = false;
  }
}

void Encoder::put_string(const char* text, std::size_t size) {
  // Length and bytes by hand: Fast CDR's own overloads would look for the end, or allocate.
  put(static_cast<std::uint32_t>(size + 1));
  State& s = state();
  if (!s.good) return;
  try {
    s.cdr.serializeArray(text, size + 1);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    s.good = false;
  }
}

struct Decoder::State {
  explicit State(std::span<const std::uint8_t> bytes)
      : buffer(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())), bytes.size()),
        cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR) {}
  FastBuffer buffer;
  Cdr cdr;
};

Decoder::Decoder(std::span<const std::uint8_t> cdr) : cdr_(cdr) {
  static_assert(sizeof(State) <= sizeof(storage_));
  new (storage_) State(cdr);
  // Plain CDR only (0x0000 big-endian, 0x0001 little-endian): both vendors' representation of @final types.
  good_ = cdr.size() >= encapsulation_size && cdr[0] == 0 && cdr[1] <= 1;
  if (good_) state().cdr.read_encapsulation();
}
Decoder::~Decoder() { state().~State(); }

bool Decoder::finish() {
  const std::size_t used = state().cdr.getSerializedDataLength();
  return good_ && used <= cdr_.size() && cdr_.size() - used < 4;
}

void Decoder::get(bool& value) {
  // Looked at as a byte first: anything but 0 and 1 is malformed, and no exception has to say so.
  std::uint8_t byte = 0;
  get(byte);
  good_ = good_ && byte <= 1;
  value = byte == 1;
}
void Decoder::get(std::uint8_t& value) { deserialize(state().cdr, cdr_.size(), good_, value); }
void Decoder::get(std::int32_t& value) { deserialize(state().cdr, cdr_.size(), good_, value); }
void Decoder::get(std::uint32_t& value) { deserialize(state().cdr, cdr_.size(), good_, value); }
void Decoder::get(std::int64_t& value) { deserialize(state().cdr, cdr_.size(), good_, value); }
void Decoder::get(std::uint64_t& value) { deserialize(state().cdr, cdr_.size(), good_, value); }
void Decoder::get(double& value) {
  deserialize(state().cdr, cdr_.size(), good_, value);
  good_ = good_ && std::isfinite(value);
}

void Decoder::get_array(double* values, std::size_t count) {
  good_ = good_ && has_bytes(state().cdr, cdr_.size(), sizeof(double), count);
  if (!good_) return;
  state().cdr.deserializeArray(values, count);
  for (std::size_t k = 0; k < count && good_; ++k) good_ = std::isfinite(values[k]);
}

std::string_view Decoder::get_string(std::size_t bound) {
  std::uint32_t size = 0;
  get(size);
  const std::size_t at = state().cdr.getSerializedDataLength();
  good_ = good_ && size >= 1 && size <= bound + 1 && at + size <= cdr_.size() && cdr_[at + size - 1] == 0;
  if (!good_) return {};
  // The zero is read, not jumped over: Fast CDR aligns what follows by the size of what was read last.
  state().cdr.jump(size - 1);
  char zero = 0;
  state().cdr.deserialize(zero);
  const std::string_view text(reinterpret_cast<const char*>(cdr_.data()) + at, size - 1);
  good_ = text.find('\0') == std::string_view::npos;
  return good_ ? text : std::string_view{};
}

}  // namespace eciton::bus
