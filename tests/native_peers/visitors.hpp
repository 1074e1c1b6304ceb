// Fills a vendor's own sample with the pattern of a seed, and compares one with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "tests/native_peers/pattern.hpp"

namespace eciton::native_peers {

/// How a vendor's generator represents a string and a sequence; each peer specialises these before it includes the
/// generated functions.
template <class T>
struct Text;  // static void assign(T&, const std::string&); static std::string get(const T&)
template <class T>
struct Sequence;  // static void resize(T&, uint32_t); static uint32_t size(const T&); static Element& at(T&,
                  // uint32_t)

template <class T>
concept IsText = requires {
  Text<T>::is_text;
};
template <class T>
concept IsSequence = requires {
  Sequence<T>::is_sequence;
};
template <class T>
concept IsArray = !IsText<T> && (std::is_array_v<T> || requires { std::tuple_size<T>::value; });

/// Walks the fields of a sample beside the pattern. Derived: template <class T> void scalar(T& field, T value);
/// template <class T> void text(T& field, const std::string&); template <class T> void size(T& field, uint32_t).
template <class Derived>
class PatternWalk {
 public:
  PatternWalk(const char* topic, std::uint64_t seed) : pattern_(topic, seed) {}

  template <class T>
  void operator()(T& field, std::uint32_t limit) {
    if constexpr (IsText<T>) {
      std::string drawn(pattern_.length(limit), ' ');
      for (char& character : drawn) character = pattern_.character();
      self().text(field, drawn);
    } else if constexpr (IsSequence<T>) {
      const std::uint32_t drawn = pattern_.length(limit);
      self().size(field, drawn);
      for (std::uint32_t k = 0; k < drawn && k < Sequence<T>::size(field); ++k) (*this)(Sequence<T>::at(field, k), 0);
    } else if constexpr (IsArray<T>) {
      for (auto& element : field) (*this)(element, limit);
    } else if constexpr (std::is_enum_v<T>) {
      self().scalar(field, static_cast<T>(pattern_.below(limit)));
    } else if constexpr (std::is_same_v<T, bool>) {
      self().scalar(field, (pattern_.number() & 1) != 0);
    } else if constexpr (std::is_floating_point_v<T>) {
      self().scalar(field, pattern_.real());
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
      self().scalar(field, pattern_.stamp());
    } else if constexpr (std::is_integral_v<T>) {
      self().scalar(field, static_cast<T>(pattern_.number()));
    } else {
      visit_fields(*this, field);
    }
  }

 private:
  Derived& self() { return static_cast<Derived&>(*this); }
  Pattern pattern_;
};

class Fill : public PatternWalk<Fill> {
 public:
  using PatternWalk::PatternWalk;
  template <class T>
  void scalar(T& field, T value) {
    field = value;
  }
  template <class T>
  void text(T& field, const std::string& value) {
    Text<T>::assign(field, value);
  }
  template <class T>
  void size(T& field, std::uint32_t value) {
    Sequence<T>::resize(field, value);
  }
};

class Compare : public PatternWalk<Compare> {
 public:
  using PatternWalk::PatternWalk;
  bool equal() const { return equal_; }
  template <class T>
  void scalar(T& field, T value) {
    equal_ = equal_ && std::memcmp(&field, &value, sizeof field) == 0;
  }
  template <class T>
  void text(T& field, const std::string& value) {
    equal_ = equal_ && Text<T>::get(field) == value;
  }
  template <class T>
  void size(T& field, std::uint32_t value) {
    equal_ = equal_ && Sequence<T>::size(field) == value;
  }

 private:
  bool equal_ = true;
};

}  // namespace eciton::native_peers
