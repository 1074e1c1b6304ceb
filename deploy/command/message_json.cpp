// JSON laid out for people.
#include "deploy/command/message_json.hpp"

#include <algorithm>
#include <cstdio>

namespace eciton::deploy {
namespace {

std::string plain(const Json& value) {
  if (value.is_number_float()) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value.get<double>());
    return text.data();
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}

bool is_plain_list(const Json& value) {
  return value.is_array() &&
         std::none_of(value.begin(), value.end(), [](const Json& element) { return element.is_structured(); });
}

std::string in_one_line(const Json& list) {
  std::string text;
  for (const Json& element : list) text += (text.empty() ? "" : ", ") + plain(element);
  return "[" + text + "]";
}

void print_fields(std::string& out, const Json& object, const std::string& indent, std::string first_indent) {
  for (const auto& [name, value] : object.items()) {
    out += first_indent + name + ":";
    first_indent = indent;
    if (is_plain_list(value)) {
      out += " " + in_one_line(value) + "\n";
    } else if (value.is_array()) {
      out += "\n";
      for (const Json& element : value) print_fields(out, element, indent + "    ", indent + "  - ");
    } else if (value.is_object()) {
      out += "\n";
      print_fields(out, value, indent + "  ", indent + "  ");
    } else {
      out += " " + plain(value) + "\n";
    }
  }
}

}  // namespace

std::string to_text(const Json& object) {
  std::string out;
  print_fields(out, object, "", "");
  return out;
}

std::string key_text(const Json& key) {
  std::string text;
  for (const auto& [name, value] : key.items()) text += (text.empty() ? "" : ", ") + name + " " + plain(value);
  return text;
}

}  // namespace eciton::deploy
