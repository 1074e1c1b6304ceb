// A second, independent writer of XCDR1 (OMG DDS-XTypes 1.3, clause 7.4; CORBA CDR's alignment), as plain as can
// be: what the codec's bytes are held against. And random contents for any message of the wire contract.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/bounded.hpp"
#include "core/bus/type_traits.hpp"

namespace eciton::bus::testing {

/// Visits the fields of a message: each primitive is aligned to its size, counted from behind the header.
class ReferenceCdr {
 public:
  explicit ReferenceCdr(bool big_endian)
      : big_endian_(big_endian), bytes{0, std::uint8_t(big_endian ? 0 : 1), 0, 0} {}

  template <class T>
  void operator()(const char*, const T& value) {
    put(value);
  }
  /// As it is sent: padded to a multiple of four.
  std::vector<std::uint8_t> padded() const {
    auto all = bytes;
    all.resize((all.size() + 3) / 4 * 4);
    return all;
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      put(static_cast<std::uint32_t>(value));
    } else if constexpr (Message<T>) {
      TypeTraits<T>::visit(*this, value);
    } else {
      while ((bytes.size() - 4) % sizeof(T) != 0) bytes.push_back(0);
      std::uint8_t raw[sizeof(T)];
      std::memcpy(raw, &value, sizeof(T));
      for (std::size_t k = 0; k < sizeof(T); ++k) bytes.push_back(raw[big_endian_ ? sizeof(T) - 1 - k : k]);
    }
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& values) {
    for (const T& value : values) put(value);
  }
  template <class T, std::size_t N>
  void put(const BoundedVector<T, N>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    for (const T& value : values) put(value);
  }
  template <std::size_t N>
  void put(const BoundedString<N>& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    for (const char c : text.view()) bytes.push_back(static_cast<std::uint8_t>(c));
    bytes.push_back(0);
  }

  static_assert(std::endian::native == std::endian::little);
  bool big_endian_;

 public:
  std::vector<std::uint8_t> bytes;
};

/// Gives every field a random value: any length within its bound, any finite number.
class RandomFields {
 public:
  explicit RandomFields(std::mt19937_64& random) : random_(random) {}

  template <class T>
  void operator()(const char*, T& value) {
    fill(value);
  }

 private:
  template <class T>
  void fill(T& value) {
    if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(random_() % EnumTraits<T>::names.size());
    } else if constexpr (Message<T>) {
      TypeTraits<T>::visit(*this, value);
    } else if constexpr (std::is_same_v<T, bool>) {
      value = random_() % 2 == 1;
    } else if constexpr (std::is_same_v<T, double>) {
      do value = std::bit_cast<double>(random_());
      while (!std::isfinite(value));
    } else {
      value = static_cast<T>(random_());
    }
  }
  template <class T, std::size_t N>
  void fill(std::array<T, N>& values) {
    for (T& value : values) fill(value);
  }
  template <class T, std::size_t N>
  void fill(BoundedVector<T, N>& values) {
    values.resize(random_() % (N + 1));
    for (T& value : values) fill(value);
  }
  template <std::size_t N>
  void fill(BoundedString<N>& text) {
    std::string characters(random_() % (N + 1), ' ');
    for (char& c : characters) c = static_cast<char>(1 + random_() % 255);
    text.assign(characters);
  }

  std::mt19937_64& random_;
};

/// Makes the `chosen`-th number of a message not finite; `count` says how many there are.
class PoisonedNumber {
 public:
  PoisonedNumber(int chosen, double poison) : chosen_(chosen), poison_(poison) {}

  template <class T>
  void operator()(const char*, T& value) {
    visit(value);
  }
  int count = 0;

 private:
  template <class T>
  void visit(T& value) {
    if constexpr (std::is_same_v<T, double>) {
      if (count++ == chosen_) value = poison_;
    } else if constexpr (Message<T>) {
      TypeTraits<T>::visit(*this, value);
    }
  }
  template <class T, std::size_t N>
  void visit(std::array<T, N>& values) {
    for (T& value : values) visit(value);
  }
  template <class T, std::size_t N>
  void visit(BoundedVector<T, N>& values) {
    for (T& value : values) visit(value);
  }
  template <std::size_t N>
  void visit(BoundedString<N>&) {}

  int chosen_;
  double poison_;
};

template <Message T>
T random_sample(std::mt19937_64& random) {
  T sample;
  RandomFields fields(random);
  TypeTraits<T>::visit(fields, sample);
  return sample;
}

template <Message T>
ReferenceCdr reference_cdr(const T& sample, bool big_endian = false) {
  ReferenceCdr cdr(big_endian);
  TypeTraits<T>::visit(cdr, sample);
  return cdr;
}

}  // namespace eciton::bus::testing
