// Nets of our own, and a look into namespaces by a process that enters them and ends.
#include "benchmarks/latency/place.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "benchmarks/latency/plan.hpp"
#include "core/bus/vendors/network.hpp"

namespace eciton::bench {
namespace {

std::string namespace_file(const std::string& host) {
  return host.find('/') == std::string::npos ? "/run/netns/" + host : host;
}

std::filesystem::path own_directory() { return std::filesystem::read_symlink("/proc/self/exe").parent_path(); }

/// What is wrong with an interface as seen from a namespace; empty: nothing.
std::string seen_from(const std::string& namespace_path, const std::string& network_interface) {
  if (!namespace_path.empty()) {
    const int space = ::open(namespace_path.c_str(), O_RDONLY | O_CLOEXEC);
    if (space < 0) {
      return "there is no network namespace " + namespace_path +
             "; 'ip netns list' shows those that are, 'eciton net up' makes hosts";
    }
    if (::setns(space, CLONE_NEWNET) != 0) return "no right to enter " + namespace_path + " (it takes CAP_SYS_ADMIN)";
  }
  const auto address = bus::vendors::interface_address(network_interface);
  return address ? "" : address.error().message;
}

Status check_interface(const std::string& namespace_path, const std::string& network_interface) {
  std::array<int, 2> told{};
  if (::pipe2(told.data(), O_CLOEXEC) != 0) return Error{"no pipe can be made"};
  const pid_t probe = ::fork();
  if (probe == 0) {
    const std::string wrong = seen_from(namespace_path, network_interface);
    [[maybe_unused]] const auto written = ::write(told[1], wrong.data(), wrong.size());
    ::_exit(0);
  }
  ::close(told[1]);
  std::array<char, 1024> text;
  const ssize_t size = probe < 0 ? -1 : ::read(told[0], text.data(), text.size());
  ::close(told[0]);
  if (probe > 0) ::waitpid(probe, nullptr, 0);
  if (size < 0) return Error{"no process can be started"};
  return size == 0 ? ok() : Error{std::string(text.data(), static_cast<std::size_t>(size))};
}

}  // namespace

Result<Venue> Venue::open(const std::string& over, const LatencyOptions& options) {
  Venue venue;
  if (over == "loopback") {
    venue.place_.network_interface = options.network_interface;
    return venue;
  }
  venue.place_.network_interface =
      options.network_interface == "lo" ? net::radio_interface : options.network_interface;
  if (options.hosts.size() == 2) {
    venue.place_.ping_namespace = namespace_file(options.hosts[0]);
    venue.place_.echo_namespace = namespace_file(options.hosts[1]);
    return venue;
  }
  const net::NetSpec spec{.name = "bench-" + std::to_string(::getpid()), .modules = 2, .seed = options.seed};
  Result<net::OwnedNet> owned = net::OwnedNet::start(spec, own_directory());
  if (!owned) return owned.error();
  venue.net_.emplace(std::move(owned).value());
  venue.place_.ping_namespace = venue.net_->host(1);
  venue.place_.echo_namespace = venue.net_->host(2);
  if (over == "impaired") {
    if (const Status set = venue.net_->set("", "", options.impairment); !set) {
      return Error{"--impairment: " + set.error().message};
    }
  }
  return venue;
}

Status check_venue(const std::string& over, const LatencyOptions& options) {
  if (over == "loopback") return check_interface("", options.network_interface);
  if (options.hosts.empty()) return net::check_rights();
  for (const std::string& host : options.hosts) {
    const std::string network_interface =
        options.network_interface == "lo" ? net::radio_interface : options.network_interface;
    if (const Status seen = check_interface(namespace_file(host), network_interface); !seen) {
      return Error{"--hosts: " + host + ": " + seen.error().message};
    }
  }
  return ok();
}

}  // namespace eciton::bench
