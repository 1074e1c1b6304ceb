// YAML into a tree that remembers where each value came from.
#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <filesystem>

#include "core/base/config_node.hpp"

namespace eciton {

ConfigTree::ConfigTree() : root_(std::make_unique<Node>()) { root_->kind = Node::Kind::map; }
ConfigTree::~ConfigTree() = default;
ConfigTree::ConfigTree(ConfigTree&&) noexcept = default;
ConfigTree& ConfigTree::operator=(ConfigTree&&) noexcept = default;
ConfigTree::ConfigTree(const ConfigTree& other) : root_(std::make_unique<Node>(*other.root_)) {}

namespace {

/// Where a text came from: a file, whose lines are told apart, or a setting of one line.
struct Origin {
  std::string name;
  bool has_lines;

  std::string at(const YAML::Mark& mark) const {
    return has_lines ? name + ":" + std::to_string(mark.line + 1) : name;
  }
};

constexpr int depth_max = 32;  // an alias may lead back to its own anchor

template <class TreeNode>
void add_entry(TreeNode& node, const YAML::Node& key, const YAML::Node& value, const Origin& origin,
               const std::string& path, int depth);

/// Throws BadInput. `path`: the keys that lead here.
template <class TreeNode>
TreeNode from_yaml(const YAML::Node& yaml, const Origin& origin, const std::string& path, int depth = 0) {
  TreeNode node;
  node.where = origin.at(yaml.Mark());
  if (depth > depth_max) {
    throw BadInput{{node.where + ": " + path + ": nested deeper than " + std::to_string(depth_max) +
                    " levels, or an alias inside its own anchor"}};
  }
  if (yaml.IsScalar()) {
    node.kind = TreeNode::Kind::scalar;
    node.scalar = yaml.Scalar();
  } else if (yaml.IsSequence()) {
    node.kind = TreeNode::Kind::list;
    for (const auto& element : yaml) {
      const std::string index = "[" + std::to_string(node.list.size()) + "]";
      node.list.push_back(from_yaml<TreeNode>(element, origin, path + index, depth + 1));
    }
  } else if (yaml.IsMap()) {
    node.kind = TreeNode::Kind::map;
    for (const auto& entry : yaml) add_entry(node, entry.first, entry.second, origin, path, depth);
  }
  return node;
}

template <class TreeNode>
void add_entry(TreeNode& node, const YAML::Node& key, const YAML::Node& value, const Origin& origin,
               const std::string& path, int depth) {
  const std::string where = origin.at(key.Mark());
  if (!key.IsScalar()) {
    throw BadInput{{where + ": " + (path.empty() ? "" : path + ": ") +
                    "a list or a map stands where a key should; expected 'key: value'"}};
  }
  const std::string full = path.empty() ? key.Scalar() : path + "." + key.Scalar();
  if (const TreeNode* first = node.find(key.Scalar())) {
    // Which of the two was meant nobody can tell, and the order of keys means nothing in YAML.
    throw BadInput{{where + ": key '" + full + "' is given twice" +
                    (origin.has_lines ? ", first at " + first->where : std::string()) + "; expected it once"}};
  }
  node.map.push_back({key.Scalar(), from_yaml<TreeNode>(value, origin, full, depth + 1)});
  // A value may begin on a later line than its key: the key is what a person looks for.
  if (node.map.back().node.kind != TreeNode::Kind::scalar) node.map.back().node.where = where;
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
    const std::vector<YAML::Node> documents = YAML::LoadAll(yaml);
    if (documents.size() > 1) {
      return Error{origin + ": it holds " + std::to_string(documents.size()) +
                   " YAML documents, parted by '---'; expected one"};
    }
    if (documents.empty() || documents[0].IsNull()) return ok();
    if (!documents[0].IsMap()) return Error{origin + ": expected keys and values at the top, as in 'key: value'"};
    merge(*root_, from_yaml<Node>(documents[0], {origin, true}, ""));
    return ok();
  } catch (const YAML::Exception& e) {
    return Error{origin + ":" + std::to_string(e.mark.line + 1) + ": not valid YAML: " + e.msg};
  } catch (const BadInput& bad) {
    return bad.error;
  }
}

Status ConfigTree::add_file(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none))
    return Error{"config file " + path + " cannot be read: it is a directory; expected a YAML file"};
  std::FILE* file = std::fopen(path.c_str(), "r");
  if (file == nullptr)
    return Error{"config file " + path + " cannot be read: it does not exist or may not be opened"};
  std::string text;
  std::array<char, 4096> block{};
  for (std::size_t got = 0; (got = std::fread(block.data(), 1, block.size(), file)) > 0;)
    text.append(block.data(), got);
  const bool broke_off = std::ferror(file) != 0;
  std::fclose(file);
  if (broke_off) return Error{"config file " + path + " cannot be read to its end"};
  return add_text(text, path);
}

Status ConfigTree::set(const std::string& assignment, const std::string& origin) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    return Error{origin + " " + assignment + ": expected key=value, as in control.law=local"};
  }
  std::string keys = assignment.substr(0, equals);
  const Origin setting{origin + " " + assignment, false};
  Node value;
  try {
    value = from_yaml<Node>(YAML::Load(assignment.substr(equals + 1)), setting, keys);
  } catch (const YAML::Exception& e) {
    return Error{setting.name + ": the value is not valid YAML: " + e.msg};
  } catch (const BadInput& bad) {
    return bad.error;
  }
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

}  // namespace eciton
