// Any message as JSON, through its generated visitor: numbers, names of enumerators, arrays, nested
// messages. For tools; it allocates.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "core/base/bounded.hpp"
#include "core/bus/type_traits.hpp"

namespace eciton::deploy {

using Json = nlohmann::ordered_json;

template <bus::Message T>
Json to_json(const T& message);

class JsonVisitor {
 public:
  template <class T>
  void operator()(const char* name, const T& value) {
    object[name] = json_of(value);
  }
  Json object = Json::object();

 private:
  template <class T>
  static Json json_of(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      constexpr auto& names = bus::EnumTraits<T>::names;
      const auto index = static_cast<std::size_t>(value);
      return index < names.size() ? Json(std::string(names[index])) : Json(static_cast<std::uint32_t>(value));
    } else if constexpr (bus::Message<T>) {
      return to_json(value);
    } else {
      return value;
    }
  }
  template <std::size_t Bound>
  static Json json_of(const BoundedString<Bound>& text) {
    return std::string(text.view());
  }
  template <class T, std::size_t N>
  static Json json_of(const std::array<T, N>& values) {
    return list_of(values);
  }
  template <class T, std::size_t Bound>
  static Json json_of(const BoundedVector<T, Bound>& values) {
    return list_of(values);
  }
  template <class List>
  static Json list_of(const List& values) {
    Json list = Json::array();
    for (const auto& value : values) list.push_back(json_of(value));
    return list;
  }
};

template <bus::Message T>
Json to_json(const T& message) {
  JsonVisitor visitor;
  bus::TypeTraits<T>::visit(visitor, message);
  return visitor.object;
}

/// The key fields alone; an empty object without a key.
template <bus::Message T>
Json key_to_json(const T& message) {
  JsonVisitor visitor;
  if constexpr (bus::TypeTraits<T>::keyed) bus::TypeTraits<T>::visit_key(visitor, message);
  return visitor.object;
}

/// YAML-like, for people: one field a line, lists of plain values in one line, numbers to six digits.
std::string to_text(const Json& object);

/// "module_id 1, port 0", for people; empty without a key.
std::string key_text(const Json& key);

}  // namespace eciton::deploy
