// Checks a source tree against the include rules of docs/architecture.md, the naming rule for files, and
// the rule that code given the time does not ask for it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace eciton::structure {

/// One line for each violation, "file:line: what, and what would be right"; empty: the tree is sound.
std::vector<std::string> violations(const std::filesystem::path& root);

/// How many files were looked at, so that a test can tell a sound tree from an empty one.
std::size_t source_count(const std::filesystem::path& root);

}  // namespace eciton::structure
