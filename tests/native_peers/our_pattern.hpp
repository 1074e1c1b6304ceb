// The framework's own samples with the pattern of a seed, through the generated traits.
#pragma once

#include <array>
#include <string>
#include <type_traits>
#include <vector>

#include "core/bus/codec.hpp"
#include "core/bus/topic.hpp"
#include "tests/native_peers/pattern.hpp"

namespace eciton::native_peers {

class OurFill {
 public:
  OurFill(std::string_view topic, std::uint64_t seed) : pattern_(topic, seed) {}

  template <class T>
  void operator()(const char*, T& field) {
    draw(field);
  }

 private:
  template <class T>
  void draw(T& field) {
    if constexpr (std::is_enum_v<T>) {
      field = static_cast<T>(pattern_.below(static_cast<std::uint32_t>(bus::EnumTraits<T>::names.size())));
    } else if constexpr (std::is_same_v<T, bool>) {
      field = (pattern_.number() & 1) != 0;
    } else if constexpr (std::is_same_v<T, double>) {
      field = pattern_.real();
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
      field = pattern_.stamp();
    } else if constexpr (std::is_integral_v<T>) {
      field = static_cast<T>(pattern_.number());
    } else {
      bus::TypeTraits<T>::visit(*this, field);
    }
  }
  template <class T, std::size_t N>
  void draw(std::array<T, N>& field) {
    for (T& element : field) draw(element);
  }
  template <class T, std::size_t Bound>
  void draw(BoundedVector<T, Bound>& field) {
    field.resize(pattern_.length(Bound));
    for (T& element : field) draw(element);
  }
  template <std::size_t Bound>
  void draw(BoundedString<Bound>& field) {
    std::string text(pattern_.length(Bound), ' ');
    for (char& character : text) character = pattern_.character();
    field.assign(text);
  }

  Pattern pattern_;
};

template <class T>
T our_sample(const bus::Topic<T>& topic, std::uint64_t seed) {
  T sample{};
  OurFill fill(topic.name, seed);
  bus::TypeTraits<T>::visit(fill, sample);
  return sample;
}

template <class T>
std::vector<std::uint8_t> our_bytes(const T& sample) {
  std::vector<std::uint8_t> bytes(bus::TypeTraits<T>::size_max);
  bytes.resize(bus::encode(sample, bytes));
  return bytes;
}

}  // namespace eciton::native_peers
