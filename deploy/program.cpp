// Options, errors and exit statuses that all programs share.
#include "deploy/program.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "core/base/result.hpp"

namespace eciton::deploy {

int run_program(const std::string& name, const std::function<int()>& body) {
  try {
    return body();
  } catch (const BadInput& bad) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), bad.error.message.c_str());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), e.what());
    return 1;
  }
}

ProgramOptions parse_options(int argc, char** argv, const std::string& purpose, const ProgramTakes& takes) {
  ProgramOptions options;
  CLI::App app(purpose);
  app.add_option("--config", options.config_files, "YAML file; later ones override earlier ones")
      ->required()
      ->allow_extra_args(false);
  app.add_option("--set", options.assignments, "key=value, over the files")->allow_extra_args(false);
  app.add_option("--log", options.log_level, "trace, debug, info, warn, error or off");
  if (takes.faults)
    app.add_option("--faults", options.faults, "directory for what was known and done before each fault");
  if (takes.names) app.add_option("names", options.names, "services to run")->required();
  if (takes.checkpoints) {
    app.add_option("--checkpoints", options.checkpoints, "directory where services that died left their state")
        ->check(CLI::ExistingDirectory);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    std::exit(app.exit(help));
  } catch (const CLI::ParseError& e) {
    throw BadInput{{e.what()}};
  }
  return options;
}

}  // namespace eciton::deploy
