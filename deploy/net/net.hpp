// A net: module hosts and one for the operator, joined by the radio. It is brought up and taken down as a whole; the
// process in which it lives holds a directory in /run/eciton-net, from which what is left is found when it was
// killed.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/runtime/stop_signal.hpp"
#include "deploy/net/hosts.hpp"
#include "deploy/supervisor/child_process.hpp"

namespace eciton::net {

struct NetSpec {
  std::string name = default_name;
  std::uint32_t modules = 2;
  std::uint64_t seed = 1;
};

/// A net that someone brought up, alive or killed.
struct KnownNet {
  NetSpec spec;
  bool up = false;  // else only its leftovers are there
  pid_t relay = 0;
};

/// All on this machine, by name.
std::vector<KnownNet> known_nets();
/// The one called so, or with an empty name the only one. The Error says which there are.
Result<KnownNet> find_net(const std::string& name);

/// Makes the net in this process, calls `on_up`, and carries frames until `stop` is set, or `take_down` asks for the
/// end; then removes all it made. Throws BadInput when it cannot be made; nothing is left then either.
void run_net(const NetSpec& spec, runtime::StopFlag& stop, const std::function<void()>& on_up);

/// Ends the net and removes what is left of it, also after its relay was killed.
Status take_down(const std::string& name);

/// Asks a running net; requests are made by deploy/net/requests.hpp. An answer that is an error is an Error.
Result<std::string> ask_net(const std::string& name, const std::string& request);
/// Changes settings live, all or none: set_links("eciton", "m1", "m2", {"delay=20ms", "loss=10%"}); an empty name
/// stands for every host.
Status set_links(const std::string& name, const std::string& from, const std::string& to,
                 const std::vector<std::string>& words);

/// The call of the `eciton` command in `programs` by which another process runs a net and ends it with its parent.
std::vector<std::string> relay_call(const NetSpec& spec, const std::filesystem::path& programs);
/// An Error when the net is not up in time.
Status wait_until_up(const std::string& name, Duration patience);

/// A net of this process's own, for a measurement: gone when this goes, and when the process dies.
class OwnedNet {
 public:
  /// Rights are checked first. What a killed one of this name left is removed; one that is up is an Error.
  static Result<OwnedNet> start(const NetSpec& spec, const std::filesystem::path& programs);
  OwnedNet(OwnedNet&&) noexcept = default;
  OwnedNet& operator=(OwnedNet&&) noexcept = default;
  ~OwnedNet();

  const NetSpec& spec() const { return spec_; }
  std::filesystem::path host(std::uint32_t index) const { return host_namespace(spec_.name, index); }
  Status set(const std::string& from, const std::string& to, const std::vector<std::string>& words) const {
    return set_links(spec_.name, from, to, words);
  }

 private:
  OwnedNet(NetSpec spec, std::unique_ptr<deploy::ChildProcess> relay)
      : spec_(std::move(spec)), relay_(std::move(relay)) {}

  NetSpec spec_;
  std::unique_ptr<deploy::ChildProcess> relay_;
};

}  // namespace eciton::net
