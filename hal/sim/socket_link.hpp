// A module's board at the end of a socket to the world process: what the hardware host uses, as it would
// a board behind a UART.
#pragma once

#include <memory>
#include <string>

#include "hal/sim/board.hpp"
#include "hal/sim/packet_socket.hpp"

namespace eciton::hal::sim {

class SocketLink {
 public:
  /// Tries until the world answers or `timeout` has passed. An Error says what stood in the way: no world,
  /// or the world's own reason for refusing this module.
  static Result<std::unique_ptr<SocketLink>> connect(const std::string& path, std::uint32_t module,
                                                     Duration timeout = 5s);
  /// Says goodbye to the world.
  ~SocketLink();

  Board& board() { return board_; }
  Pace pace() const { return welcome_.pace; }
  Duration tick_period() const { return Duration(welcome_.tick_ns); }
  /// The tick whose sensors are on the board; 0 before the first.
  std::uint64_t tick() const { return tick_; }

  /// Waits for sensors newer than those on the board and puts the newest there. Io::timeout when none came,
  /// Io::error when the world is gone: `ended` then says why. Never allocates.
  Io wait_sensors(Duration timeout) noexcept;
  /// Sends the board's commands as the answer to its tick. Real-time safe.
  Io act() noexcept;

  bool ended() const { return !socket_.is_open(); }
  std::string_view end_reason() const { return end_reason_.view(); }
  /// Ticks whose sensors were overtaken by newer ones before they were read.
  std::uint64_t overtaken() const { return overtaken_; }
  /// Commands that the world's buffer did not take.
  std::uint64_t unsent() const { return unsent_; }

 private:
  SocketLink(PacketSocket socket, const Welcome& welcome) : socket_(std::move(socket)), welcome_(welcome) {}
  bool take_one() noexcept;
  void end(std::string_view reason) noexcept;

  PacketSocket socket_;
  Welcome welcome_;
  Board board_;
  std::uint64_t tick_ = 0;
  std::uint64_t overtaken_ = 0;
  std::uint64_t unsent_ = 0;
  BoundedString<200> end_reason_;
};

}  // namespace eciton::hal::sim
