// What can be asked of a running radio, as one line of text, and the answer: its settings changed live, or shown.
#pragma once

#include <string>
#include <vector>

#include "deploy/net/air.hpp"

namespace eciton::net {

/// "set FROM TO key=value…"; empty names: all hosts. Words with spaces or line ends are refused.
Result<std::string> set_request(const std::string& from, const std::string& to,
                                const std::vector<std::string>& words);
inline constexpr const char* show_request = "show";
inline constexpr const char* down_request = "down";

/// Answers begin with this when something was wrong.
inline constexpr const char* error_prefix = "error: ";

/// Changes all that the words say on the links chosen, or nothing: "key=value", or "clear" for the defaults. rate,
/// backlog and partition are the medium's, and take no link.
Status apply(Air& air, const std::string& from, const std::string& to, const std::vector<std::string>& words);

/// The answer to one line; `stop` is set when it asks for the end. `show` is JSON: hosts, medium, links.
std::string answer(Air& air, const std::string& line, bool& stop);

}  // namespace eciton::net
