// Plain structs from YAML. A struct lists its fields once, in `template <class V> void visit_fields(V& v)`:
//   v("rate_Hz", rate_Hz, in_range(1, 1000));
// Missing keys keep their defaults. An unknown key, one given twice, a wrong type or a value out of range is an
// Error that names file, line, key, what was found and what would be right. Files may be layered and single keys set
// by text ("control.rate_Hz=200", as --set gives them).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/result.hpp"

namespace eciton {

struct Range {
  double min;
  double max;
};
constexpr Range in_range(double min, double max) { return {min, max}; }
struct OneOf {
  std::vector<std::string> values;
};
inline OneOf one_of(std::initializer_list<std::string> values) { return {values}; }

/// A parsed YAML tree; layers merge key by key, the later one wins.
class ConfigTree {
 public:
  ConfigTree();
  ~ConfigTree();
  ConfigTree(ConfigTree&&) noexcept;
  ConfigTree& operator=(ConfigTree&&) noexcept;
  ConfigTree(const ConfigTree&);

  Status add_file(const std::string& path);
  Status add_text(const std::string& yaml, const std::string& origin);
  /// "key.sub=value"; `origin` says where it came from, as in "--set".
  Status set(const std::string& assignment, const std::string& origin);
  std::string to_yaml() const;

  struct Node;  // config_node.hpp

 private:
  friend class ConfigReader;
  std::unique_ptr<Node> root_;
};

/// Visits a struct's fields and fills them from a tree, collecting the first error.
class ConfigReader {
 public:
  explicit ConfigReader(const ConfigTree& tree);
  ~ConfigReader();

  template <class T>
  void operator()(const char* key, T& value) {
    field(key, value, nullptr, nullptr);
  }
  template <class T>
  void operator()(const char* key, T& value, Range range) {
    field(key, value, &range, nullptr);
  }
  void operator()(const char* key, std::string& value, const OneOf& options) { field(key, value, nullptr, &options); }

  /// Call after the last field of the root: keys nobody asked for are errors.
  Status finish();

 private:
  template <class T>
  void field(const char* key, T& value, const Range* range, const OneOf* options) {
    if constexpr (requires { value.visit_fields(*this); }) {
      if (enter(key)) {
        value.visit_fields(*this);
        leave();
      }
    } else if constexpr (requires { typename T::mapped_type; }) {
      for (const std::string& name : map_keys(key)) read_map_entry(key, name, value[name]);
    } else if constexpr (requires { value.resize(1); } && !std::is_same_v<T, std::string>) {
      read_list(key, value);
    } else {
      read(key, value, range, options);
    }
  }
  template <class Vector>
  void read_list(const char* key, Vector& list) {
    const std::size_t count = list_size(key);
    if (count == npos) return;
    list.assign(count, {});
    for (std::size_t k = 0; k < count; ++k) {
      constexpr bool has_fields = requires { list[k].visit_fields(*this); };
      if (!enter_element(key, k, has_fields)) continue;
      if constexpr (has_fields) {
        list[k].visit_fields(*this);
      } else {
        read(nullptr, list[k], nullptr, nullptr);
      }
      leave();
    }
  }

  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
  bool enter(const char* key);
  bool enter_element(const char* key, std::size_t index, bool has_fields);
  void leave();
  std::size_t list_size(const char* key);
  std::vector<std::string> map_keys(const char* key);
  void read_map_entry(const char* key, const std::string& name, std::string& value);
  void read(const char* key, bool& value, const Range* range, const OneOf* options);
  void read(const char* key, int& value, const Range* range, const OneOf* options);
  void read(const char* key, std::uint32_t& value, const Range* range, const OneOf* options);
  void read(const char* key, std::uint64_t& value, const Range* range, const OneOf* options);
  void read(const char* key, double& value, const Range* range, const OneOf* options);
  void read(const char* key, std::string& value, const Range* range, const OneOf* options);
  void read(const char* key, std::array<double, 3>& value, const Range* range, const OneOf* options);

  struct State;
  std::unique_ptr<State> state_;
};

/// Fills `config` from the tree: the one call a program makes.
template <class Config>
Status read_config(const ConfigTree& tree, Config& config) {
  ConfigReader reader(tree);
  config.visit_fields(reader);
  return reader.finish();
}

}  // namespace eciton
