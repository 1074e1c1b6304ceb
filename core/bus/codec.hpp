// A message to and from XCDR1 bytes. Fast CDR does the encoding (codec.cpp); the fields
// come from the generated visitor. Nothing here allocates on a well-formed sample.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/base/bounded.hpp"
#include "core/bus/key_hash.hpp"
#include "core/bus/type_traits.hpp"

namespace eciton::bus {

inline constexpr std::size_t encapsulation_size = 4;

/// Writes fields one after another, little-endian.
class Encoder {
 public:
  explicit Encoder(std::span<std::uint8_t> buffer, bool big_endian = false);
  Encoder(const Encoder&) = delete;
  ~Encoder();

  /// Bytes written, encapsulation header included, padded to a multiple of four; 0 if they did not fit.
  std::size_t finish();

  template <class T>
  void operator()(const char*, const T& value) {
    put_field(value);
  }

 private:
  template <class T>
  void put_field(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      put(static_cast<std::uint32_t>(value));
    } else if constexpr (Message<T>) {
      TypeTraits<T>::visit(*this, value);
    } else {
      put(value);
    }
  }
  template <class T, std::size_t N>
  void put_field(const std::array<T, N>& value) {
    if constexpr (std::is_same_v<T, double>) {
      put_array(value.data(), N);
    } else {
      for (const T& element : value) put_field(element);
    }
  }
  template <class T, std::size_t N>
  void put_field(const BoundedVector<T, N>& value) {
    put(static_cast<std::uint32_t>(value.size()));
    for (const T& element : value) put_field(element);
  }
  template <std::size_t N>
  void put_field(const BoundedString<N>& value) {
    put_string(value.c_str(), value.size());
  }

  void put(bool value);
  void put(std::uint8_t value);
  void put(std::int32_t value);
  void put(std::uint32_t value);
  void put(std::int64_t value);
  void put(std::uint64_t value);
  void put(double value);
  void put_array(const double* values, std::size_t count);
  void put_string(const char* text, std::size_t size);

  struct State;
  State& state() { return *reinterpret_cast<State*>(storage_); }
  alignas(8) unsigned char storage_[256];
};

/// Reads fields one after another; a value outside its type's bounds makes the whole sample malformed.
class Decoder {
 public:
  explicit Decoder(std::span<const std::uint8_t> cdr);
  Decoder(const Decoder&) = delete;
  ~Decoder();

  /// Whether every field was well-formed and nothing but padding is left.
  bool finish();
  bool good() const { return good_; }

  template <class T>
  void operator()(const char*, T& value) {
    if (good_) get_field(value);
  }

 private:
  template <class T>
  void get_field(T& value) {
    if constexpr (std::is_enum_v<T>) {
      std::uint32_t number = 0;
      get(number);
      good_ = good_ && number < EnumTraits<T>::names.size();
      if (good_) value = static_cast<T>(number);
    } else if constexpr (Message<T>) {
      TypeTraits<T>::visit(*this, value);
    } else {
      get(value);
    }
  }
  template <class T, std::size_t N>
  void get_field(std::array<T, N>& value) {
    if constexpr (std::is_same_v<T, double>) {
      get_array(value.data(), N);
    } else {
      for (T& element : value) {
        if (good_) get_field(element);
      }
    }
  }
  template <class T, std::size_t N>
  void get_field(BoundedVector<T, N>& value) {
    std::uint32_t size = 0;
    get(size);
    good_ = good_ && value.resize(size);
    if (!good_) return;
    for (T& element : value) {
      if (good_) get_field(element);
    }
  }
  template <std::size_t N>
  void get_field(BoundedString<N>& value) {
    value.assign(get_string(N));
  }

  void get(bool& value);
  void get(std::uint8_t& value);
  void get(std::int32_t& value);
  void get(std::uint32_t& value);
  void get(std::int64_t& value);
  void get(std::uint64_t& value);
  void get(double& value);
  void get_array(double* values, std::size_t count);
  std::string_view get_string(std::size_t bound);

  struct State;
  State& state() { return *reinterpret_cast<State*>(storage_); }
  bool good_ = true;
  std::span<const std::uint8_t> cdr_;
  alignas(8) unsigned char storage_[256];
};

/// Serializes into `buffer` (at least size_max bytes); returns the size, 0 if it did not fit.
template <Message T>
std::size_t encode(const T& sample, std::span<std::uint8_t> buffer) {
  Encoder encoder(buffer);
  TypeTraits<T>::visit(encoder, sample);
  return encoder.finish();
}

/// Returns false, leaving `sample` unspecified, when the bytes are not a well-formed T: wrong size or
/// representation, a bound exceeded, an unknown enumerator, a number that is not finite.
template <Message T>
[[nodiscard]] bool decode(std::span<const std::uint8_t> cdr, T& sample) {
  Decoder decoder(cdr);
  TypeTraits<T>::visit(decoder, sample);
  return decoder.finish();
}

}  // namespace eciton::bus
