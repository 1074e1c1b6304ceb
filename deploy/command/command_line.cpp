// CLI11 parses; this turns its errors into messages that say which words would be right.
#include "deploy/command/command_line.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "core/base/result.hpp"
#include "deploy/program.hpp"

namespace eciton::deploy {
namespace {

/// Changes of one letter that turn `a` into `b` (Levenshtein).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::vector<std::string> subcommands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_lnames().empty()) names.push_back("--" + option->get_lnames().front());
  }
  return names;
}

/// The subcommand the words led to, and its full name.
const CLI::App& chosen(const CLI::App& app, std::string& name) {
  const CLI::App* deepest = &app;
  name = app.get_name();
  while (!deepest->get_subcommands().empty()) {
    deepest = deepest->get_subcommands().front();
    name += " " + deepest->get_name();
  }
  return *deepest;
}

std::string missing_subcommand(const CLI::App& app) {
  return "a command is missing; there are " + joined(subcommands_of(app));
}

/// For a word nobody asked for.
std::string unexpected(const CLI::App& app, const std::string& word) {
  if (word.starts_with("-")) {
    const std::string option = word.substr(0, word.find('='));
    return "no option '" + option + "'" + did_you_mean(option, options_of(app)) + "; there are " +
           joined(options_of(app));
  }
  const std::vector<std::string> subcommands = subcommands_of(app);
  if (!subcommands.empty()) {
    return "no command '" + word + "'" + did_you_mean(word, subcommands) + "; there are " + joined(subcommands);
  }
  return "'" + word + "' is one word too many";
}

std::string message_for(const CLI::App& app, const CLI::ParseError& error) {
  std::string name;
  const CLI::App& at = chosen(app, name);
  const std::vector<std::string> extras = app.remaining(true);
  std::string what = error.what();
  // CLI11 asks for a subcommand before it looks at the word that is none.
  const bool extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const bool no_subcommand =
      dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && !subcommands_of(at).empty();
  if ((extra || no_subcommand) && !extras.empty()) {
    what = unexpected(at, extras.front());
  } else if (no_subcommand) {
    what = missing_subcommand(at);
  }
  return name + ": " + what + ". Try '" + name + " --help'.";
}

}  // namespace

std::vector<std::string> nearest(const std::string& word, const std::vector<std::string>& words) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const std::string& candidate : words) {
    const bool begins = !word.empty() && candidate.starts_with(word);
    const std::size_t distance = begins ? 0 : edit_distance(word, candidate);
    const bool alike = distance <= std::max<std::size_t>(2, word.size() / 3) && 2 * distance <= word.size();
    if (begins || alike) ranked.emplace_back(distance, candidate);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> best;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, ranked.size()); ++k) best.push_back(ranked[k].second);
  return best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& candidate : nearest(word, words)) text += (text.empty() ? "" : " or ") + candidate;
  return text.empty() ? "" : " (did you mean " + text + "?)";
}

void on_chosen(CLI::App& subcommand, Run& run, Run body) {
  subcommand.callback([&run, body = std::move(body)] { run = body; });
}

int run_command_line(int argc, const char* const* argv, const std::vector<AddVerb>& verbs) {
  Run run;
  CLI::App app("Middleware for robots that link their bodies in flight.", "eciton");
  app.set_version_flag("--version", "eciton " ECITON_VERSION);
  for (const AddVerb add : verbs) add(app, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // help or version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s\n", message_for(app, error).c_str());
    return 2;
  }
  std::string name;
  const CLI::App& at = chosen(app, name);
  if (!run) {
    std::fprintf(stderr, "%s: %s. Try '%s --help'.\n", name.c_str(), missing_subcommand(at).c_str(), name.c_str());
    return 2;
  }
  return run_program(name, run);
}

}  // namespace eciton::deploy
