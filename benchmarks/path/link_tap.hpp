// Stands on the link between a simulated world and one module's hardware host, as a board's wires would be
// tapped: passes every message on untouched and notes when readings went out and commands came back.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/path/path_trace.hpp"
#include "core/runtime/stop_signal.hpp"
#include "hal/sim/packet_socket.hpp"

namespace eciton::bench {

struct TapConfig {
  std::string host_path;   // where the hardware host finds its board
  std::string world_path;  // where the world serves
  int realtime_priority = 0;
  std::size_t ticks_max = 0;  // remembered
};

class LinkTap {
 public:
  /// Called around each tick on the tap's thread: before readings go out, and after commands have gone on.
  using Hook = std::function<void()>;

  LinkTap(TapConfig config, Hook hook);
  ~LinkTap();

  /// Binds the host's path.
  Status open();
  /// Passes messages on until told to stop. An Error when it may not be what was asked for.
  void run(const runtime::StopFlag& stop);

  /// From another thread: ticks are remembered from now on, or no more.
  void record(bool on) { recording_ = on; }
  /// After run has returned.
  const std::vector<LinkTick>& ticks() const { return ticks_; }
  std::uint64_t passed() const { return passed_; }

 private:
  bool connect(const runtime::StopFlag& stop);
  void pass(int stop_fd);
  bool from_world();
  bool from_host();
  void close();

  TapConfig config_;
  Hook hook_;
  hal::sim::PacketSocket listener_;
  int world_ = -1, host_ = -1;
  std::atomic<bool> recording_{false};
  std::atomic<std::uint64_t> passed_{0};
  std::vector<LinkTick> ticks_;
  std::vector<std::uint64_t> tick_numbers_;
  alignas(8) std::array<unsigned char, hal::sim::message_size_max> buffer_{};
};

}  // namespace eciton::bench
