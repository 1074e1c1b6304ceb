// eciton-bench-participant --dds VENDOR --domain D: a participant as the vendor's own API makes it by default, with
// the endpoints that a module's radio has on the swarm ring, and types of the vendor's own generator. It writes
// nothing.
#include <poll.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/formation/native_participant.hpp"
#include "core/base/result.hpp"
#include "core/runtime/stop_signal.hpp"
#include "deploy/program.hpp"
#include "idl/topics.hpp"

namespace {

using namespace eciton;

int run(int argc, char** argv) {
  CLI::App app("A participant with a vendor's defaults, for measuring.");
  std::string vendor;
  std::uint32_t domain = 0;
  app.add_option("--dds", vendor)->required();
  app.add_option("--domain", domain)->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& e) {
    throw BadInput{{e.what()}};
  }
  std::vector<std::string> names;
  topics::for_each([&](const auto& topic) {
    if (topic.scope == bus::Scope::swarm) names.emplace_back(topic.name);
  });
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  std::unique_ptr<bench::NativeParticipant> participant;
  if (vendor == "cyclonedds") participant = bench::make_cyclonedds_participant(domain, names);
  if (vendor == "fastdds") participant = bench::make_fastdds_participant(domain, names);
  if (!participant) throw BadInput{{"no vendor '" + vendor + "'; expected cyclonedds or fastdds"}};
  pollfd wait{stop.file_descriptor(), POLLIN, 0};
  while (!stop.requested()) ::poll(&wait, 1, -1);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("eciton-bench-participant", [&] { return run(argc, argv); });
}
