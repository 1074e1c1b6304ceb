// YAML into a tree that remembers where each value came from, and from there into structs.
#include "core/base/config.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>

namespace eciton {

struct ConfigTree::Node {
  enum class Kind { none, scalar, list, map } kind = Kind::none;
  std::string scalar;
  std::string where;  // "file:line"
  std::vector<Node> list;
  struct Entry;
  std::vector<Entry> map;

  Node* find(const std::string& key);
};

struct ConfigTree::Node::Entry {
  std::string key;
  Node node;
};

ConfigTree::Node* ConfigTree::Node::find(const std::string& key) {
  for (Entry& entry : map) {
    if (entry.key == key) return &entry.node;
  }
  return nullptr;
}

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

ConfigTree::ConfigTree() : root_(std::make_unique<Node>()) { root_->kind = Node::Kind::map; }
ConfigTree::~ConfigTree() = default;
ConfigTree::ConfigTree(ConfigTree&&) noexcept = default;
ConfigTree& ConfigTree::operator=(ConfigTree&&) noexcept = default;
ConfigTree::ConfigTree(const ConfigTree& other) : root_(std::make_unique<Node>(*other.root_)) {}

namespace {

template <class TreeNode>
TreeNode from_yaml(const YAML::Node& yaml, const std::string& origin) {
  TreeNode node;
  node.where = origin + ":" + std::to_string(yaml.Mark().line + 1);
  if (yaml.IsScalar()) {
    node.kind = TreeNode::Kind::scalar;
    node.scalar = yaml.Scalar();
  } else if (yaml.IsSequence()) {
    node.kind = TreeNode::Kind::list;
    for (const auto& element : yaml) node.list.push_back(from_yaml<TreeNode>(element, origin));
  } else if (yaml.IsMap()) {
    node.kind = TreeNode::Kind::map;
    for (const auto& entry : yaml) {
      node.map.push_back({entry.first.Scalar(), from_yaml<TreeNode>(entry.second, origin)});
    }
  }
  return node;
}

template <class TreeNode>
void merge(TreeNode& into, TreeNode&& layer) {
  if (into.kind != TreeNode::Kind::map || layer.kind != TreeNode::Kind::map) {
    into = std::move(layer);
    return;
  }
  for (auto& [key, node] : layer.map) {
    if (TreeNode* existing = into.find(key)) {
      merge(*existing, std::move(node));
    } else {
      into.map.push_back({key, std::move(node)});
    }
  }
}

template <class TreeNode>
void emit(YAML::Emitter& out, const TreeNode& node) {
  switch (node.kind) {
    case TreeNode::Kind::none:
      out << YAML::Null;
      break;
    case TreeNode::Kind::scalar:
      out << node.scalar;
      break;
    case TreeNode::Kind::list:
      out << YAML::Flow << YAML::BeginSeq;
      for (const auto& element : node.list) emit(out, element);
      out << YAML::EndSeq;
      break;
    case TreeNode::Kind::map:
      out << YAML::BeginMap;
      for (const auto& [key, value] : node.map) {
        out << YAML::Key << key << YAML::Value;
        emit(out, value);
      }
      out << YAML::EndMap;
      break;
  }
}

}  // namespace

Status ConfigTree::add_text(const std::string& yaml, const std::string& origin) {
  try {
    const YAML::Node parsed = YAML::Load(yaml);
    if (parsed.IsNull()) return ok();
    if (!parsed.IsMap()) return Error{origin + ": expected keys and values at the top, as in 'key: value'"};
    merge(*root_, from_yaml<Node>(parsed, origin));
    return ok();
  } catch (const YAML::Exception& e) {
    return Error{origin + ":" + std::to_string(e.mark.line + 1) + ": not valid YAML: " + e.msg};
  }
}

Status ConfigTree::add_file(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "r");
  if (file == nullptr)
    return Error{"config file " + path + " cannot be read: it does not exist or may not be opened"};
  std::string text;
  std::array<char, 4096> block{};
  for (std::size_t got = 0; (got = std::fread(block.data(), 1, block.size(), file)) > 0;)
    text.append(block.data(), got);
  std::fclose(file);
  return add_text(text, path);
}

Status ConfigTree::set(const std::string& assignment, const std::string& origin) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    return Error{origin + " " + assignment + ": expected key=value, as in control.law=local"};
  }
  Node value;
  try {
    value = from_yaml<Node>(YAML::Load(assignment.substr(equals + 1)), origin);
  } catch (const YAML::Exception& e) {
    return Error{origin + " " + assignment + ": the value is not valid YAML: " + e.msg};
  }
  value.where = origin + " " + assignment;
  std::string keys = assignment.substr(0, equals);
  while (true) {
    const auto dot = keys.rfind('.');
    Node parent;
    parent.kind = Node::Kind::map;
    parent.where = value.where;
    parent.map.push_back({dot == std::string::npos ? keys : keys.substr(dot + 1), std::move(value)});
    value = std::move(parent);
    if (dot == std::string::npos) break;
    keys.resize(dot);
  }
  merge(*root_, std::move(value));
  return ok();
}

std::string ConfigTree::to_yaml() const {
  YAML::Emitter out;
  emit(out, *root_);
  return std::string(out.c_str()) + "\n";
}

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
    error = node.where + ": " + path + ": found '" + node.scalar + "', expected " + expected;
  }
  /// The scalar under a key (of the element itself for nullptr); nullptr when absent or wrong.
  ConfigTree::Node* scalar(const char* key, const char* expected) {
    ConfigTree::Node* node = level().node;
    if (key != nullptr) {
      level().known.emplace_back(key);
      node = node->find(key);
    }
    if (node == nullptr) return nullptr;
    if (node->kind != ConfigTree::Node::Kind::scalar) {
      fail(*node, path_of(key), expected);
      return nullptr;
    }
    return node;
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

bool ConfigReader::enter_element(const char* key, std::size_t index) {
  State& s = *state_;
  ConfigTree::Node* list = s.level().node->find(key);
  s.levels.push_back({&list->list[index], s.path_of(key) + "[" + std::to_string(index) + "]", {}});
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
  value = state_->level().node->find(key)->find(name)->scalar;
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
  const std::string expected = options != nullptr ? "one of " + joined(options->values) : "a text";
  auto* node = state_->scalar(key, expected.c_str());
  if (node == nullptr) return;
  if (options != nullptr &&
      std::find(options->values.begin(), options->values.end(), node->scalar) == options->values.end()) {
    state_->fail(*node, state_->path_of(key), expected);
    return;
  }
  value = node->scalar;
}
void ConfigReader::read(const char* key, std::array<double, 3>& value, const Range*, const OneOf*) {
  ConfigTree::Node* node = state_->level().node;
  if (key != nullptr) {
    state_->level().known.emplace_back(key);
    node = node->find(key);
  }
  if (node == nullptr) return;
  if (node->kind != ConfigTree::Node::Kind::list || node->list.size() != 3) {
    state_->fail(*node, state_->path_of(key), "three numbers, as in [0, 0, 1.5]");
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (!parse_number(node->list[k].scalar, value[k])) {
      state_->fail(node->list[k], state_->path_of(key), "a number");
    }
  }
}

}  // namespace eciton
