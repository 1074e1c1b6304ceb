// Processes of several modules for a measurement, each in its host of a net if there is one; gone with their owner.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/formation/formation.hpp"
#include "deploy/net/net.hpp"
#include "deploy/supervisor/runtime_directory.hpp"
#include "deploy/supervisor/supervisor.hpp"

namespace eciton::bench {

/// Module ids, and with them domains, that nothing else on this machine is likely to use.
inline constexpr std::uint32_t first_id = 61;
inline constexpr std::uint32_t swarm_domain = 99;

class Fleet {
 public:
  /// `net`: nothing for loopback. Throws BadInput when another measurement runs.
  Fleet(const FormationOptions& options, const net::OwnedNet* net);
  ~Fleet();

  /// Of the module's radio: its host's, or loopback.
  std::string radio_interface() const { return net_ != nullptr ? net::radio_interface : "lo"; }
  std::filesystem::path directory() const { return directory_.path(); }

  /// Writes the config of the module with this index (from 0 on); `assignments` beside what all have.
  std::filesystem::path write_config(std::uint32_t index, const std::string& vendor,
                                     const std::vector<std::string>& assignments);
  /// Starts a program as this module's; the first of `call` is its name.
  Status start(std::uint32_t index, std::vector<std::string> call);
  void stop_all();
  /// What ended by itself; empty: nothing did.
  std::string trouble();
  void add_descriptors(std::vector<pollfd>& descriptors) const { programs_->add_descriptors(descriptors); }

 private:
  const FormationOptions& options_;
  const net::OwnedNet* net_;
  deploy::RuntimeDirectory directory_;
  std::unique_ptr<deploy::Supervisor> programs_;
};

}  // namespace eciton::bench
