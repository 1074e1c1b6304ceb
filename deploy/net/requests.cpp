// Words are checked on copies, which take the place of the settings when all of them are right.
#include "deploy/net/requests.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>

#include "deploy/net/hosts.hpp"

namespace eciton::net {
namespace {

using Json = nlohmann::json;
constexpr const char* everyone = "*";
constexpr const char* clear_word = "clear";
constexpr const char* partition_key = "partition";

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

Result<std::uint32_t> host_called(const Air& air, const std::string& name) {
  const auto index = air.index_of(name);
  if (!index) return Error{"no host '" + name + "'; there are " + joined(air.hosts())};
  return *index;
}

/// "m1+m2/m3": groups of hosts; "none": no partition.
Result<std::vector<std::vector<std::uint32_t>>> groups_from(const Air& air, const std::string& text) {
  std::vector<std::vector<std::uint32_t>> groups;
  if (text == "none") return groups;
  std::set<std::string> seen;
  for (const std::string& part : split(text, '/')) {
    groups.emplace_back();
    for (const std::string& name : split(part, '+')) {
      const Result<std::uint32_t> host = host_called(air, name);
      if (!host) return Error{"partition=" + text + ": " + host.error().message + "; expected as m1+m2/m3, or none"};
      if (!seen.insert(name).second) return Error{"partition=" + text + ": " + name + " is in it twice"};
      groups.back().push_back(*host);
    }
  }
  if (groups.empty()) return Error{"partition=" + text + ": expected groups of hosts, as m1+m2/m3, or none"};
  return groups;
}

/// Copies of all settings, to be changed by words.
struct Draft {
  std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, LinkSettings>> links;
  MediumSettings medium;
  std::vector<std::vector<std::uint32_t>> groups;
};

Error unknown_key(const std::string& word) {
  return Error{"no setting '" + word + "'; of a link there are " + joined(keys_of<LinkSettings>()) +
               "; of the medium " + joined(keys_of<MediumSettings>()) + ", " + partition_key +
               "; clear sets them back"};
}

Status change(const Air& air, const std::string& word, bool all_links, Draft& draft) {
  if (word == clear_word) {
    for (auto& link : draft.links) link.second = {};
    if (!all_links) return ok();
    draft.medium = {};
    draft.groups.clear();
    return ok();
  }
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) return Error{"'" + word + "': expected key=value, as delay=20ms, or clear"};
  const std::string key = word.substr(0, equals), value = word.substr(equals + 1);
  bool known = false, of_medium = key == partition_key;
  if (of_medium) {
    auto groups = groups_from(air, value);
    if (!groups) return groups.error();
    draft.groups = std::move(groups).value();
  } else if (const Status status = assign(draft.medium, key, value, of_medium); !status) {
    return status;
  }
  if (of_medium) {
    if (!all_links) return Error{key + " is of the medium that all share; it takes neither --from nor --to"};
    return ok();
  }
  LinkSettings probe;  // the word is checked even where there is no link
  if (const Status status = assign(probe, key, value, known); !status) return status;
  if (!known) return unknown_key(key);
  for (auto& link : draft.links) [[maybe_unused]] const Status checked = assign(link.second, key, value, known);
  return ok();
}

template <class Settings>
Json settings_json(Settings settings) {
  struct Writer {
    Json json = Json::object();
    void operator()(const char* key, Duration& value) { json[std::string(key) + "_s"] = to_s(value); }
    void operator()(const char* key, BitRate& value) { json[std::string(key) + "_bit_s"] = value.bit_s; }
    void operator()(const char* key, double& value) { json[key] = value; }
    void operator()(const char* key, bool& value) { json[key] = value; }
  } writer;
  settings.visit_fields(writer);
  return writer.json;
}

Json link_json(const Air& air, std::uint32_t from, std::uint32_t to) {
  const LinkCounters& c = air.counters(from, to);
  return {{"from", air.hosts()[from]},
          {"to", air.hosts()[to]},
          {"settings", settings_json(air.link(from, to))},
          {"changed", differences(air.link(from, to))},
          {"sent", c.sent},
          {"delivered", c.delivered},
          {"lost", c.lost},
          {"dropped", c.dropped},
          {"duplicated", c.duplicated},
          {"reordered", c.reordered},
          {"bytes", c.bytes}};
}

Json air_json(const Air& air) {
  const auto count = static_cast<std::uint32_t>(air.hosts().size());
  Json json{{"hosts", air.hosts()}, {"medium", settings_json(air.medium())}, {"links", Json::array()}};
  json["medium"]["changed"] = differences(air.medium());
  json["medium"]["partition"] = Json::array();
  for (const auto& group : air.groups()) {
    Json names = Json::array();
    for (const std::uint32_t host : group) names.push_back(air.hosts()[host]);
    json["medium"]["partition"].push_back(names);
  }
  for (std::uint32_t from = 0; from < count; ++from) {
    for (std::uint32_t to = 0; to < count; ++to) {
      if (from != to) json["links"].push_back(link_json(air, from, to));
    }
  }
  return json;
}

}  // namespace

Result<std::string> set_request(const std::string& from, const std::string& to,
                                const std::vector<std::string>& words) {
  std::string line = std::string("set ") + (from.empty() ? everyone : from) + " " + (to.empty() ? everyone : to);
  for (const std::string& word : words) line += " " + word;
  for (std::string word : {from, to}) {
    if (word.find_first_of(" \t\r\n*") != std::string::npos) return Error{"no host '" + word + "'"};
  }
  for (const std::string& word : words) {
    if (word.empty() || word.find_first_of(" \t\r\n") != std::string::npos)
      return Error{"'" + word + "': expected key=value, as delay=20ms, or clear"};
  }
  return line;
}

Status apply(Air& air, const std::string& from, const std::string& to, const std::vector<std::string>& words) {
  const auto count = static_cast<std::uint32_t>(air.hosts().size());
  std::array<std::optional<std::uint32_t>, 2> chosen;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string& name = k == 0 ? from : to;
    if (name == everyone) continue;
    const Result<std::uint32_t> host = host_called(air, name);
    if (!host) return host.error();
    chosen[k] = *host;
  }
  if (chosen[0] && chosen[0] == chosen[1]) return Error{"a host has no link to itself: " + from};
  if (words.empty()) return Error{"nothing to set; expected key=value, as delay=20ms, or clear"};
  Draft draft{.links = {}, .medium = air.medium(), .groups = air.groups()};
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = 0; b < count; ++b) {
      if (a == b || (chosen[0] && chosen[0] != a) || (chosen[1] && chosen[1] != b)) continue;
      draft.links.push_back({{a, b}, air.link(a, b)});
    }
  }
  for (const std::string& word : words) {
    if (const Status status = change(air, word, !chosen[0] && !chosen[1], draft); !status) return status;
  }
  for (const auto& [pair, settings] : draft.links) air.set_link(pair.first, pair.second, settings);
  air.set_medium(draft.medium);
  air.partition(draft.groups);
  return ok();
}

std::string answer(Air& air, const std::string& line, bool& stop) {
  std::istringstream in(line);
  std::string verb, from, to;
  in >> verb;
  if (verb == show_request) return air_json(air).dump();
  if (verb == down_request) {
    stop = true;
    return "ok";
  }
  if (verb != "set" || !(in >> from >> to)) return error_prefix + ("'" + line + "' is no request of a net");
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  const Status status = apply(air, from, to, words);
  return status ? "ok" : error_prefix + status.error().message;
}

}  // namespace eciton::net
