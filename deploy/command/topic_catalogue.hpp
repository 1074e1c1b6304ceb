// Every topic of Eciton with its type erased: what tools that treat all topics alike need.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bus/endpoint.hpp"
#include "deploy/command/message_json.hpp"

namespace eciton::deploy {

/// One sample, decoded.
struct Decoded {
  Json message;
  Json key;
  std::int64_t stamp_ns;
};

struct TopicEntry {
  bus::TopicInfo info;
  std::string_view idl;           // of the type, self-contained
  std::vector<std::string> keys;  // names of the key fields
  /// Nothing: malformed.
  std::optional<Decoded> (*decode)(std::span<const std::uint8_t> cdr);
};

/// In the order of idl/topics.hpp.
const std::vector<TopicEntry>& topic_catalogue();

/// Throws BadInput that names the topics there are.
const TopicEntry& find_topic(const std::string& name);

}  // namespace eciton::deploy
