// A supervisor whose children are never restarted: a measurement does not go on with a member that died.
#include "benchmarks/formation/fleet.hpp"

#include <fstream>

#include "core/base/config.hpp"

namespace eciton::bench {

Fleet::Fleet(const FormationOptions& options, const net::OwnedNet* net)
    : options_(options),
      net_(net),
      directory_(value_or_throw(deploy::RuntimeDirectory::claim("bench"))),
      programs_(std::make_unique<deploy::Supervisor>(
          deploy::SupervisorConfig{.log_directory = directory_.path(), .stop_patience = std::chrono::seconds(3)})) {}

Fleet::~Fleet() { stop_all(); }

void Fleet::stop_all() { programs_->stop_all(); }

std::filesystem::path Fleet::write_config(std::uint32_t index, const std::string& vendor,
                                          const std::vector<std::string>& assignments) {
  ConfigTree tree;
  const std::string id = std::to_string(first_id + index);
  std::vector<std::string> all{"id=" + id,
                               "clock=wall",
                               "layout=composed",
                               "dds=" + vendor,
                               "realtime_priority=" + std::to_string(options_.realtime_priority),
                               "swarm_ring.domain=" + std::to_string(swarm_domain),
                               "swarm_ring.interface=" + radio_interface()};
  all.insert(all.end(), assignments.begin(), assignments.end());
  all.insert(all.end(), options_.assignments.begin(), options_.assignments.end());
  for (const std::string& assignment : all) ok_or_throw(tree.set(assignment, "--set"));
  const std::filesystem::path file = directory() / ("m" + id + ".yaml");
  std::ofstream out(file);
  out << tree.to_yaml();
  if (!out.flush()) throw BadInput{{"config " + file.string() + " cannot be written"}};
  return file;
}

Status Fleet::start(std::uint32_t index, std::vector<std::string> call) {
  call[0] = options_.programs / call[0];
  deploy::ChildSpec spec{.name = "m" + std::to_string(first_id + index), .arguments = std::move(call)};
  spec.environment = {{"ECITON_DDS", ""}};
  if (net_ != nullptr) spec.network_namespace = net_->host(index + 1);
  return programs_->start(spec);
}

std::string Fleet::trouble() {
  std::string text;
  programs_->check([&](const deploy::ChildReport& report) {
    text += (text.empty() ? "" : "; ") + report.name + " ended with " +
            (report.last_end ? report.last_end->text() : "nothing") +
            (report.last_words.empty() ? "" : ": " + report.last_words);
  });
  return text;
}

}  // namespace eciton::bench
