// From a tree of values into structs, with a word for every value that does not fit.
#include "core/base/config.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/base/config_node.hpp"

namespace eciton {

namespace {

constexpr const char* text_due = "a text ('' for an empty one)";

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += text.empty() ? "" : ", ";
    text += word.empty() ? "''" : word;
  }
  return text;
}

/// What stands at a node, for a person.
std::string found(const ConfigTree::Node& node) {
  switch (node.kind) {
    case ConfigTree::Node::Kind::none:
      return "no value";
    case ConfigTree::Node::Kind::scalar:
      return "'" + node.scalar + "'";
    case ConfigTree::Node::Kind::list:
      return "a list";
    case ConfigTree::Node::Kind::map:
      return "keys and values";
  }
  return {};
}

}  // namespace

struct ConfigReader::State {
  struct Level {
    ConfigTree::Node* node;
    std::string path;
    std::vector<std::string> known;
  };
  ConfigTree tree;
  std::vector<Level> levels;
  std::string error;

  Level& level() { return levels.back(); }
  std::string path_of(const char* key) {
    const std::string& path = level().path;
    return key == nullptr ? path : path.empty() ? key : path + "." + key;
  }
  void fail(const ConfigTree::Node& node, const std::string& path, const std::string& expected) {
    if (!error.empty()) return;
    error = node.where + ": " + path + ": found " + found(node) + ", expected " + expected;
  }
  /// What stands under a key (the element itself for nullptr); nullptr when absent.
  ConfigTree::Node* node(const char* key) {
    if (key == nullptr) return level().node;
    level().known.emplace_back(key);
    return level().node->find(key);
  }
  /// nullptr when absent or no scalar.
  ConfigTree::Node* scalar(const char* key, const char* expected) {
    ConfigTree::Node* there = node(key);
    if (there == nullptr || there->kind == ConfigTree::Node::Kind::scalar) return there;
    fail(*there, path_of(key), expected);
    return nullptr;
  }
  void check_unknown() {
    for (const auto& [key, node] : level().node->map) {
      if (std::find(level().known.begin(), level().known.end(), key) != level().known.end()) continue;
      if (error.empty()) {
        error = node.where + ": unknown key '" + path_of(key.c_str()) + "'; known here: " + joined(level().known);
      }
    }
  }
};

ConfigReader::ConfigReader(const ConfigTree& tree) : state_(new State{tree, {}, {}}) {
  state_->levels.push_back({state_->tree.root_.get(), "", {}});
}
ConfigReader::~ConfigReader() = default;

Status ConfigReader::finish() {
  state_->check_unknown();
  if (!state_->error.empty()) return Error{state_->error};
  return ok();
}

bool ConfigReader::enter(const char* key) {
  State& s = *state_;
  s.level().known.emplace_back(key);
  ConfigTree::Node* node = s.level().node->find(key);
  static ConfigTree::Node empty = [] {
    ConfigTree::Node n;
    n.kind = ConfigTree::Node::Kind::map;
    return n;
  }();
  if (node != nullptr && node->kind != ConfigTree::Node::Kind::map) {
    s.fail(*node, s.path_of(key), "keys and values below it");
    return false;
  }
  s.levels.push_back({node != nullptr ? node : &empty, s.path_of(key), {}});
  return true;
}

bool ConfigReader::enter_element(const char* key, std::size_t index, bool has_fields) {
  State& s = *state_;
  ConfigTree::Node& element = s.level().node->find(key)->list[index];
  const std::string path = s.path_of(key) + "[" + std::to_string(index) + "]";
  if (has_fields && element.kind != ConfigTree::Node::Kind::map) {
    s.fail(element, path, "keys and values, as in {key: value}");
    return false;
  }
  s.levels.push_back({&element, path, {}});
  return true;
}

void ConfigReader::leave() {
  state_->check_unknown();
  state_->levels.pop_back();
}

std::size_t ConfigReader::list_size(const char* key) {
  State& s = *state_;
  s.level().known.emplace_back(key);
  ConfigTree::Node* node = s.level().node->find(key);
  if (node == nullptr) return npos;
  if (node->kind != ConfigTree::Node::Kind::list) {
    s.fail(*node, s.path_of(key), "a list, as in [a, b]");
    return npos;
  }
  return node->list.size();
}

std::vector<std::string> ConfigReader::map_keys(const char* key) {
  State& s = *state_;
  s.level().known.emplace_back(key);
  ConfigTree::Node* node = s.level().node->find(key);
  std::vector<std::string> keys;
  if (node == nullptr) return keys;
  if (node->kind != ConfigTree::Node::Kind::map) s.fail(*node, s.path_of(key), "keys and values below it");
  for (const auto& entry : node->map) keys.push_back(entry.key);
  return keys;
}

void ConfigReader::read_map_entry(const char* key, const std::string& name, std::string& value) {
  const ConfigTree::Node& node = *state_->level().node->find(key)->find(name);
  if (node.kind == ConfigTree::Node::Kind::scalar) {
    value = node.scalar;
  } else {
    state_->fail(node, state_->path_of(key) + "." + name, text_due);
  }
}

namespace {

template <class Number>
bool parse_number(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string range_text(const char* what, const Range* range) {
  if (range == nullptr) return what;
  char text[96];
  std::snprintf(text, sizeof text, "%s from %g to %g", what, range->min, range->max);
  return text;
}

template <class State, class Number>
void read_number(State& state, const char* key, Number& value, const Range* range, const char* what) {
  const std::string expected = range_text(what, range);
  auto* node = state.scalar(key, expected.c_str());
  if (node == nullptr) return;
  Number number{};
  const bool parsed = parse_number(node->scalar, number) && std::isfinite(static_cast<double>(number));
  const double as_double = static_cast<double>(number);
  if (!parsed || (range != nullptr && (as_double < range->min || as_double > range->max))) {
    state.fail(*node, state.path_of(key), expected);
    return;
  }
  value = number;
}

}  // namespace

void ConfigReader::read(const char* key, bool& value, const Range*, const OneOf*) {
  auto* node = state_->scalar(key, "true or false");
  if (node == nullptr) return;
  const std::string& text = node->scalar;
  if (text == "true" || text == "on" || text == "yes") {
    value = true;
  } else if (text == "false" || text == "off" || text == "no") {
    value = false;
  } else {
    state_->fail(*node, state_->path_of(key), "true or false");
  }
}
void ConfigReader::read(const char* key, int& value, const Range* range, const OneOf*) {
  read_number(*state_, key, value, range, "a whole number");
}
void ConfigReader::read(const char* key, std::uint32_t& value, const Range* range, const OneOf*) {
  read_number(*state_, key, value, range, "a whole number");
}
void ConfigReader::read(const char* key, std::uint64_t& value, const Range* range, const OneOf*) {
  read_number(*state_, key, value, range, "a whole number");
}
void ConfigReader::read(const char* key, double& value, const Range* range, const OneOf*) {
  read_number(*state_, key, value, range, "a number");
}
void ConfigReader::read(const char* key, std::string& value, const Range*, const OneOf* options) {
  const std::string expected = options != nullptr ? "one of " + joined(options->values) : text_due;
  const auto allowed = [&](const std::string& text) {
    return options == nullptr ||
           std::find(options->values.begin(), options->values.end(), text) != options->values.end();
  };
  // "key=" means the empty text where that is one of the field's words; elsewhere it is an oversight.
  const bool empty_means_something = options != nullptr && allowed("");
  auto* node = state_->node(key);
  if (node == nullptr) return;
  if (node->kind == ConfigTree::Node::Kind::none && empty_means_something) {
    value.clear();
  } else if (node->kind == ConfigTree::Node::Kind::scalar && allowed(node->scalar)) {
    value = node->scalar;
  } else {
    state_->fail(*node, state_->path_of(key), expected);
  }
}
void ConfigReader::read(const char* key, std::array<double, 3>& value, const Range*, const OneOf*) {
  ConfigTree::Node* node = state_->node(key);
  if (node == nullptr) return;
  if (node->kind != ConfigTree::Node::Kind::list || node->list.size() != 3) {
    state_->fail(*node, state_->path_of(key), "three numbers, as in [0, 0, 1.5]");
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (!parse_number(node->list[k].scalar, value[k]) || !std::isfinite(value[k])) {
      state_->fail(node->list[k], state_->path_of(key) + "[" + std::to_string(k) + "]", "a number");
    }
  }
}

}  // namespace eciton
