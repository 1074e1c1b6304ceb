// Who is connected to a served world: greeting, answers, departures.
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

#include "core/base/wall_clock.hpp"
#include "hal/sim/world_server.hpp"

namespace eciton::hal::sim {
namespace {

constexpr std::size_t strangers_max = 32;

using What = PacketSocket::Received::What;

}  // namespace

/// Waits up to `timeout` for something to come, then takes all there is.
void WorldServer::pump(Duration timeout) {
  std::array<pollfd, 1 + strangers_max + max_modules> entries{};
  nfds_t count = 0;
  entries[count++] = {.fd = listener_.fd(), .events = POLLIN, .revents = 0};
  for (const PacketSocket& stranger : strangers_)
    entries[count++] = {.fd = stranger.fd(), .events = POLLIN, .revents = 0};
  for (const Host& host : hosts_) {
    if (host.socket.is_open()) entries[count++] = {.fd = host.socket.fd(), .events = POLLIN, .revents = 0};
  }
  const timespec wait{.tv_sec = timeout / 1s, .tv_nsec = (timeout % 1s).count()};
  if (ppoll(entries.data(), count, &wait, nullptr) <= 0) return;
  // Departures before arrivals: a host that died and came back is no duplicate of itself.
  for (Host& host : hosts_) drain(host);
  accept_all();
}

void WorldServer::accept_all() {
  while (strangers_.size() < strangers_max) {
    PacketSocket socket(accept4(listener_.fd(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket.is_open()) break;
    strangers_.push_back(std::move(socket));
  }
  for (PacketSocket& stranger : strangers_) {
    const PacketSocket::Received received = stranger.receive();
    if (received.what == What::nothing) continue;
    if (received.what == What::message) greet(stranger, received);
    stranger.close();
  }
  std::erase_if(strangers_, [](const PacketSocket& stranger) { return !stranger.is_open(); });
}

/// Makes the stranger a module's host, or tells it why not.
void WorldServer::greet(PacketSocket& stranger, const PacketSocket::Received& received) {
  const auto hello = received.type == MessageType::hello ? stranger.as<Hello>(received) : std::nullopt;
  const std::string reason = hello ? objection(*hello) : "the first message must be a Hello";
  if (!reason.empty()) {
    if (!hello) ++stats_.bad_messages;
    Refused refused;
    refused.reason.assign(reason);
    stranger.send(refused);
    return;
  }
  Host& host =
      *std::find_if(hosts_.begin(), hosts_.end(), [&](const Host& h) { return h.module == hello->module_id; });
  Welcome welcome;
  welcome.pace = config_.pace;
  welcome.tick_ns = config_.tick.count();
  welcome.now = world_.now();
  if (!stranger.send(welcome)) return;
  host.socket = std::move(stranger);
  host.left.clear();
  host.fresh = false;
  host.answered_tick = tick_;  // it owes nothing for a tick it has not seen
  host.heard = monotonic_now();
}

/// Why this Hello cannot be accepted; empty when it can.
std::string WorldServer::objection(const Hello& hello) {
  if (hello.version != protocol_version) {
    return "it speaks version " + std::to_string(hello.version) + " of the world's protocol, this world " +
           std::to_string(protocol_version) + "; run the same build on both sides";
  }
  const auto host =
      std::find_if(hosts_.begin(), hosts_.end(), [&](const Host& h) { return h.module == hello.module_id; });
  if (host == hosts_.end()) {
    std::string there;
    for (const Host& h : hosts_) there += (there.empty() ? "" : ", ") + std::to_string(h.module);
    return "there is no module " + std::to_string(hello.module_id) + " in this world; it has " + there;
  }
  if (host->socket.is_open()) {
    return "module " + std::to_string(hello.module_id) + " already has a hardware host; two modules need two ids";
  }
  return {};
}

/// Takes all a host has sent; the newest answer stands.
void WorldServer::drain(Host& host) {
  while (host.socket.is_open()) {
    const PacketSocket::Received received = host.socket.receive();
    if (received.what == What::nothing) return;
    if (received.what == What::closed) return drop(host, "its host closed the connection");
    if (received.type == MessageType::bye) {
      const auto bye = host.socket.as<Bye>(received);
      return drop(host, bye ? std::string(bye->reason.view()) : "its host said goodbye");
    }
    const auto answer = received.type == MessageType::actuators ? host.socket.as<Actuators>(received) : std::nullopt;
    if (!answer || answer->tick > tick_) {
      ++stats_.bad_messages;
      return drop(host, "its host sent a message that this world does not know");
    }
    host.answer = *answer;
    host.answered_tick = answer->tick;
    host.fresh = true;
    host.alive = true;
    host.heard = monotonic_now();
  }
}

/// The module itself flies on with its last commands until the watchdog cuts it.
void WorldServer::drop(Host& host, std::string reason) {
  host.socket.close();
  host.left = std::move(reason);
}

}  // namespace eciton::hal::sim
