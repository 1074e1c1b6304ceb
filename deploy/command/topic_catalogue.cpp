// Built once from idl/topics.hpp.
#include "deploy/command/topic_catalogue.hpp"

#include <algorithm>

#include "core/base/result.hpp"
#include "deploy/command/command_line.hpp"
#include "idl/topics.hpp"

namespace eciton::deploy {
namespace {

struct FieldNames {
  template <class T>
  void operator()(const char* name, const T&) {
    names.emplace_back(name);
  }
  std::vector<std::string> names;
};

template <bus::Message T>
std::optional<Decoded> decode_as(std::span<const std::uint8_t> cdr) {
  T sample;
  if (!bus::decode(cdr, sample)) return std::nullopt;
  return Decoded{to_json(sample), key_to_json(sample), sample.stamp_ns};
}

template <bus::Message T>
TopicEntry entry_of(const bus::Topic<T>& topic) {
  FieldNames keys;
  [[maybe_unused]] const T sample{};
  if constexpr (bus::TypeTraits<T>::keyed) bus::TypeTraits<T>::visit_key(keys, sample);
  return {bus::info(topic), bus::TypeTraits<T>::idl, keys.names, &decode_as<T>};
}

}  // namespace

const std::vector<TopicEntry>& topic_catalogue() {
  static const std::vector<TopicEntry> catalogue = [] {
    std::vector<TopicEntry> entries;
    topics::for_each([&](const auto& topic) { entries.push_back(entry_of(topic)); });
    return entries;
  }();
  return catalogue;
}

const TopicEntry& find_topic(const std::string& name) {
  const auto& catalogue = topic_catalogue();
  const auto found =
      std::find_if(catalogue.begin(), catalogue.end(), [&](const TopicEntry& e) { return e.info.name == name; });
  if (found != catalogue.end()) return *found;
  std::vector<std::string> names;
  std::string all;
  for (const TopicEntry& entry : catalogue) {
    names.emplace_back(entry.info.name);
    all += (all.empty() ? "" : ", ") + names.back();
  }
  throw BadInput{{"no topic '" + name + "'" + did_you_mean(name, names) + "; there are " + all}};
}

}  // namespace eciton::deploy
