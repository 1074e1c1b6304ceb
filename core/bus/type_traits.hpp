// What the generated headers (idl/generator) state about each type of the wire contract: the codec, the
// bus and the tools are written against these traits and never name a message type.
#pragma once

#include <concepts>
#include <cstddef>
#include <string_view>
#include <type_traits>

namespace eciton::bus {

/// Of a generated struct: name, keyed, topic, size_max, key_size, idl, visit, visit_key.
template <class T>
struct TypeTraits;

/// Of a generated enum, whose values are 0..n-1: name, names.
template <class T>
struct EnumTraits;

/// A struct generated from idl/. Only those with `TypeTraits<T>::topic` travel by themselves.
template <class T>
concept Message = std::is_trivially_copyable_v<T> && requires {
  { TypeTraits<T>::name } -> std::convertible_to<std::string_view>;
  { TypeTraits<T>::size_max } -> std::convertible_to<std::size_t>;
  { TypeTraits<T>::topic } -> std::convertible_to<bool>;
};

}  // namespace eciton::bus
