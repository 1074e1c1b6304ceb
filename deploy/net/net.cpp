// The directory of a net holds its lock, its spec and its control socket. The spec is written before anything is
// made, so that whoever comes after a kill knows what to remove.
#include "deploy/net/net.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/realtime_thread.hpp"
#include "deploy/net/relay.hpp"
#include "deploy/net/requests.hpp"
#include "deploy/supervisor/runtime_directory.hpp"

namespace eciton::net {
namespace {

namespace fs = std::filesystem;
const fs::path nets_root = "/run/eciton-net";
constexpr const char* spec_name = "spec";
constexpr const char* socket_name = "control";
constexpr int relay_priority = 10;  // a radio does not wait for the computers it joins
constexpr Duration down_patience = std::chrono::seconds(6), start_patience = std::chrono::seconds(20),
                   poll_period = std::chrono::milliseconds(10);

std::vector<fs::path> namespaces_of(const NetSpec& spec) {
  std::vector<fs::path> files;
  for (std::uint32_t host = 0; host <= spec.modules; ++host) files.push_back(host_namespace(spec.name, host));
  return files;
}

void write_spec(const NetSpec& spec) {
  std::ofstream out(nets_root / spec.name / spec_name);
  out << spec.modules << " " << spec.seed << "\n";
  if (!out.flush()) throw BadInput{{"file " + (nets_root / spec.name / spec_name).string() + " cannot be written"}};
}

NetSpec read_spec(const std::string& name) {
  NetSpec spec{.name = name, .modules = 0};
  std::ifstream(nets_root / name / spec_name) >> spec.modules >> spec.seed;
  spec.modules = std::min(spec.modules, modules_max);
  return spec;
}

pid_t holder_of(const std::string& name) {
  for (const deploy::HeldDirectory& held : deploy::held_directories(nets_root)) {
    if (held.name == name) return held.holder;
  }
  return 0;
}

/// What the spec names; the caller sees to it that nobody carries frames any more.
void remove_hosts(const NetSpec& spec) {
  const std::vector<fs::path> files = namespaces_of(spec);
  end_processes_in(files);
  for (const fs::path& file : files) remove_namespace(file);
}

/// The namespaces of a net while it is up.
class Hosts {
 public:
  explicit Hosts(const NetSpec& spec) : spec_(spec) {
    for (; made_ <= spec.modules; ++made_) {
      const Status status = make_namespace(host_namespace(spec.name, made_));
      if (status) continue;
      remove();
      throw BadInput{status.error()};
    }
  }
  ~Hosts() { remove(); }
  Hosts(const Hosts&) = delete;
  Hosts& operator=(const Hosts&) = delete;

 private:
  void remove() {
    std::vector<fs::path> files = namespaces_of(spec_);
    files.resize(made_);
    end_processes_in(files);
    for (const fs::path& file : files) remove_namespace(file);
  }

  NetSpec spec_;
  std::uint32_t made_ = 0;
};

std::vector<std::string> host_names(std::uint32_t modules) {
  std::vector<std::string> names;
  for (std::uint32_t host = 0; host <= modules; ++host) names.push_back(host_name(host));
  return names;
}

/// Waits for the end of a process that is not ours to reap.
bool ends_within(int pidfd, Duration patience) {
  pollfd end{pidfd, POLLIN, 0};
  return ::poll(&end, 1, static_cast<int>(patience / 1ms)) > 0;
}

/// It is asked; one that does not even answer hangs, or is stopped, and is killed.
Status end_relay(const std::string& name, pid_t relay) {
  const auto pidfd = static_cast<int>(::syscall(SYS_pidfd_open, relay, 0));
  if (pidfd < 0) return ok();  // gone already
  const auto answer = ask(nets_root / name / socket_name, down_request);
  bool ended = answer && ends_within(pidfd, down_patience);
  if (!ended) {
    ::syscall(SYS_pidfd_send_signal, pidfd, SIGKILL, nullptr, 0);
    ended = ends_within(pidfd, down_patience);
  }
  ::close(pidfd);
  if (ended) return ok();
  return Error{"net " + name + " does not end, and its relay (process " + std::to_string(relay) +
               ") cannot be killed"};
}

/// An Error when the relay ends, or takes too long.
Result<deploy::ChildProcess> start_and_wait(const NetSpec& spec, const fs::path& programs, const fs::path& log) {
  auto relay = deploy::ChildProcess::start({.arguments = relay_call(spec, programs), .log_file = log});
  const Duration end = monotonic_now() + start_patience;
  while (relay && !wait_until_up(spec.name, poll_period)) {
    if (relay->take_end()) {
      const auto words = deploy::last_lines(log, 1);
      return Error{words.empty() ? "net " + spec.name + ": its relay ended at once" : words[0]};
    }
    if (monotonic_now() < end) continue;
    relay->signal(SIGTERM);
    return Error{"net " + spec.name + " is not up after " + std::to_string(start_patience / 1s) + " s"};
  }
  return relay;
}

std::string names_of(const std::vector<KnownNet>& nets) {
  std::string text;
  for (const KnownNet& net : nets) text += (text.empty() ? "" : ", ") + net.spec.name + (net.up ? "" : " (killed)");
  return text;
}

}  // namespace

std::vector<KnownNet> known_nets() {
  std::vector<KnownNet> nets;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(nets_root, none)) {
    const std::string name = entry.path().filename();
    if (!check_name(name)) continue;
    nets.push_back({.spec = read_spec(name), .up = deploy::is_held(entry.path()), .relay = holder_of(name)});
  }
  std::sort(nets.begin(), nets.end(), [](const auto& a, const auto& b) { return a.spec.name < b.spec.name; });
  return nets;
}

Result<KnownNet> find_net(const std::string& name) {
  const std::vector<KnownNet> nets = known_nets();
  if (nets.empty()) return Error{(name.empty() ? "no net" : "net " + name + " is not up; none") + " is up"};
  if (name.empty()) {
    if (nets.size() == 1) return nets[0];
    return Error{"--name is missing, for there are several nets: " + names_of(nets)};
  }
  const auto found = std::find_if(nets.begin(), nets.end(), [&](const auto& n) { return n.spec.name == name; });
  if (found == nets.end()) return Error{"net " + name + " is not up; there are " + names_of(nets)};
  return *found;
}

void run_net(const NetSpec& spec, runtime::StopFlag& stop, const std::function<void()>& on_up) {
  ok_or_throw(check_name(spec.name));
  ok_or_throw(check_rights());
  if (!deploy::is_held(nets_root / spec.name)) remove_hosts(read_spec(spec.name));
  const auto directory = value_or_throw(deploy::RuntimeDirectory::claim(spec.name, nets_root));
  write_spec(spec);
  const Hosts hosts(spec);
  std::vector<Tap> taps;
  for (std::uint32_t host = 0; host <= spec.modules; ++host) {
    taps.push_back(value_or_throw(Tap::open(spec.name, host, spec.modules)));
  }
  Air air(host_names(spec.modules), spec.seed);
  Relay relay(air, std::move(taps), value_or_throw(ControlServer::listen(directory.path() / socket_name)));
  if (const auto missing = runtime::make_realtime(relay_priority)) spdlog::warn("the radio is {}", *missing);
  on_up();
  relay.run(stop);
}

Status take_down(const std::string& name) {
  const fs::path directory = nets_root / name;
  if (deploy::is_held(directory)) {
    if (const Status ended = end_relay(name, holder_of(name)); !ended) return ended;
  }
  std::error_code none;
  if (!fs::exists(directory, none)) return ok();
  const NetSpec left = read_spec(name);
  const auto claimed = deploy::RuntimeDirectory::claim(name, nets_root);  // removes it in the end
  if (!claimed) return claimed.error();
  remove_hosts(left);
  return ok();
}

Result<std::string> ask_net(const std::string& name, const std::string& request) {
  const auto net = find_net(name);
  if (!net) return net.error();
  if (!net->up)
    return Error{"the relay of net " + net->spec.name + " was killed; 'eciton net down' removes what is left"};
  auto answer = ask(nets_root / net->spec.name / socket_name, request);
  if (answer && answer->starts_with(error_prefix)) return Error{answer->substr(std::string(error_prefix).size())};
  return answer;
}

Status set_links(const std::string& name, const std::string& from, const std::string& to,
                 const std::vector<std::string>& words) {
  const auto request = set_request(from, to, words);
  if (!request) return request.error();
  const auto answer = ask_net(name, *request);
  if (!answer) return answer.error();
  return ok();
}

std::vector<std::string> relay_call(const NetSpec& spec, const fs::path& programs) {
  return {programs / "eciton",       "net",         "up", std::to_string(spec.modules), "--name", spec.name, "--seed",
          std::to_string(spec.seed), "--foreground"};
}

Status wait_until_up(const std::string& name, Duration patience) {
  const Duration end = monotonic_now() + patience;
  while (true) {
    std::error_code none;
    if (fs::exists(nets_root / name / socket_name, none) && ask(nets_root / name / socket_name, show_request))
      return ok();
    if (monotonic_now() > end)
      return Error{"net " + name + " is not up after " + std::to_string(to_s(patience)) + " s"};
    std::this_thread::sleep_for(poll_period);
  }
}

Result<OwnedNet> OwnedNet::start(const NetSpec& spec, const fs::path& programs) {
  if (const Status named = check_name(spec.name); !named) return named.error();
  if (const Status rights = check_rights(); !rights) return rights.error();
  if (const pid_t holder = holder_of(spec.name); holder != 0)
    return Error{"net " + spec.name + " is up already, carried by process " + std::to_string(holder)};
  // Its words are kept in memory: no file is left whoever is killed.
  const int memory = ::memfd_create("eciton-net", MFD_CLOEXEC);
  if (memory < 0) return Error{"no log can be kept in memory for net " + spec.name};
  auto result = start_and_wait(spec, programs, "/proc/self/fd/" + std::to_string(memory));
  ::close(memory);
  if (!result) return result.error();
  return OwnedNet(spec, std::make_unique<deploy::ChildProcess>(std::move(result).value()));
}

OwnedNet::~OwnedNet() {
  if (!relay_) return;
  relay_->signal(SIGTERM);
  const Duration end = monotonic_now() + down_patience;
  while (!relay_->take_end() && monotonic_now() < end) std::this_thread::sleep_for(poll_period);
  relay_.reset();  // kills what still runs
  [[maybe_unused]] const Status removed = take_down(spec_.name);
}

}  // namespace eciton::net
