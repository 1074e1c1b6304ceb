// What the generated headers say of each message and enumeration (idl/generator writes the
// specialisations): names, bounds, key, IDL text, and a visitor of the fields in wire order.
#pragma once

#include <concepts>
#include <cstddef>
#include <string_view>
#include <type_traits>

namespace eciton::bus {

template <class T>
struct TypeTraits;

template <class E>
struct EnumTraits;

/// A struct from the IDL; nested ones too.
template <class T>
concept Message = requires {
  { TypeTraits<T>::name } -> std::convertible_to<std::string_view>;
  { TypeTraits<T>::size_max } -> std::convertible_to<std::size_t>;
}
&&std::is_trivially_copyable_v<T>;

}  // namespace eciton::bus
