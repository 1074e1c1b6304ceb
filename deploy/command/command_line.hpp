// How the `eciton` command reads its words: each verb adds its options and says what to run; whatever is
// wrong is one line that names the word and what would be right, with exit status 2.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace eciton::deploy {

/// What the words chose: set by a verb's CLI callback, run after all of them are understood. Returns the
/// exit status; throws BadInput for what only running can tell.
using Run = std::function<int()>;

/// Adds one verb: `void add_topic(CLI::App& app, Run& run)`.
using AddVerb = void (*)(CLI::App& app, Run& run);

/// Parses and runs. Help and version go to standard output with status 0.
int run_command_line(int argc, const char* const* argv, const std::vector<AddVerb>& verbs);

/// Makes `run` the thing to do when this subcommand is chosen.
void on_chosen(CLI::App& subcommand, Run& run, Run body);

/// Those of `words` most like `word`, the likeliest first; at most three, none when nothing is like it.
std::vector<std::string> nearest(const std::string& word, const std::vector<std::string>& words);

/// " (did you mean imu or clock?)", or nothing.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& words);

}  // namespace eciton::deploy
