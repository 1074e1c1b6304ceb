// One node of a ConfigTree: what was found, and where. Of the two files that make and read the tree.
#pragma once

#include <string>
#include <vector>

#include "core/base/config.hpp"

namespace eciton {

struct ConfigTree::Node {
  enum class Kind { none, scalar, list, map } kind = Kind::none;
  std::string scalar;
  std::string where;  // "file:line", or the setting
  std::vector<Node> list;
  struct Entry;
  std::vector<Entry> map;

  Node* find(const std::string& key);
};

struct ConfigTree::Node::Entry {
  std::string key;
  Node node;
};

inline ConfigTree::Node* ConfigTree::Node::find(const std::string& key) {
  for (Entry& entry : map) {
    if (entry.key == key) return &entry.node;
  }
  return nullptr;
}

}  // namespace eciton
