// The host's end of the socket to a world.
#include "hal/sim/socket_link.hpp"

#include <chrono>
#include <thread>

namespace eciton::hal::sim {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// The world's answer to our Hello.
Result<Welcome> shake_hands(PacketSocket& socket, std::uint32_t module, Duration timeout) {
  const std::string who = "module " + std::to_string(module);
  const Hello hello{.module_id = module};
  if (!socket.send(hello)) return Error{who + ": the world closed the socket before a word was said"};
  const auto deadline = SteadyClock::now() + timeout;
  while (true) {
    const PacketSocket::Received received = socket.receive();
    if (received.what == PacketSocket::Received::What::closed) return Error{who + ": the world closed the socket"};
    if (received.what == PacketSocket::Received::What::message) {
      if (received.type == MessageType::welcome) {
        if (const auto welcome = socket.as<Welcome>(received)) return *welcome;
      }
      if (received.type == MessageType::refused) {
        if (const auto refused = socket.as<Refused>(received)) {
          return Error{who + ": refused by the world: " + std::string(refused->reason.view())};
        }
      }
      return Error{who + ": the world answers in a way this build does not know; run the same build on both sides"};
    }
    const auto left = deadline - SteadyClock::now();
    if (left <= SteadyClock::duration::zero()) return Error{who + ": the world does not answer"};
    socket.wait(std::chrono::duration_cast<Duration>(left));
  }
}

}  // namespace

Result<std::unique_ptr<SocketLink>> SocketLink::connect(const std::string& path, std::uint32_t module,
                                                        Duration timeout) {
  const auto deadline = SteadyClock::now() + timeout;
  while (true) {
    Result<PacketSocket> socket = connect_to(path);
    const auto left = std::chrono::duration_cast<Duration>(deadline - SteadyClock::now());
    if (socket) {
      const Result<Welcome> welcome = shake_hands(*socket, module, left);
      if (!welcome) return welcome.error();
      return std::unique_ptr<SocketLink>(new SocketLink(std::move(socket).value(), *welcome));
    }
    if (left <= Duration::zero()) return socket.error();
    std::this_thread::sleep_for(std::min<Duration>(left, 20ms));  // the world may still be starting
  }
}

SocketLink::~SocketLink() {
  if (ended()) return;
  Bye bye;
  bye.reason.assign("the host ends");
  socket_.send(bye);
}

void SocketLink::end(std::string_view reason) noexcept {
  end_reason_.assign(reason);
  socket_.close();
}

/// Takes one message; false when there is none.
bool SocketLink::take_one() noexcept {
  const PacketSocket::Received received = socket_.receive();
  switch (received.what) {
    case PacketSocket::Received::What::nothing:
      return false;
    case PacketSocket::Received::What::closed:
      end("the world is gone without a word");
      return false;
    case PacketSocket::Received::What::message:
      break;
  }
  if (received.type == MessageType::sensors) {
    if (const auto sensors = socket_.as<Sensors>(received)) {
      tick_ = sensors->tick;
      board_.set_sensors(sensors->frame);
      return true;
    }
  }
  if (received.type == MessageType::bye) {
    if (const auto bye = socket_.as<Bye>(received)) {
      end(bye->reason.view());
      return false;
    }
  }
  end("the world sent what this build does not know");
  return false;
}

Io SocketLink::wait_sensors(Duration timeout) noexcept {
  if (ended()) return Io::error;
  if (!socket_.wait(timeout)) return Io::timeout;
  std::uint64_t taken = 0;
  while (!ended() && take_one()) ++taken;
  if (taken > 1) overtaken_ += taken - 1;
  if (taken > 0) return Io::ok;  // an end is reported by the next call
  return ended() ? Io::error : Io::timeout;
}

Io SocketLink::act() noexcept {
  if (ended()) return Io::error;
  Actuators message;
  message.tick = tick_;
  message.stamp = board_.sensors().stamp;
  message.frame = board_.actuators();
  message.frame.stamp = message.stamp;
  if (socket_.send(message)) return Io::ok;
  ++unsent_;
  return Io::error;
}

}  // namespace eciton::hal::sim
