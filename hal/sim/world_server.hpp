// Serves a world to hardware hosts over a Unix socket, tick by tick: in lockstep with them, or on the wall
// clock. One thread, the one that calls run; only `stop` may come from another.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/sim/packet_socket.hpp"
#include "hal/sim/world.hpp"

namespace eciton::hal::sim {

struct ServerConfig {
  std::string path;                         // of the socket; must not exist yet
  std::vector<std::uint32_t> modules = {};  // that have a host; empty: all of the world
  Pace pace = Pace::lockstep;
  Duration tick = 2ms;
  Duration stall_timeout = 10s;  // lockstep: for one tick's answers
  Duration join_timeout = 60s;   // lockstep: for all hosts to connect
  Duration watchdog = 50ms;      // wall: a host silent for so long has its module cut (World::cut)
};

struct ServerStats {
  std::uint64_t ticks = 0;
  std::uint64_t missed_ticks = 0;    // wall: ticks that had passed when the server woke
  std::uint64_t late_answers = 0;    // wall: a tick ended without the answer to its sensors
  std::uint64_t unsent_sensors = 0;  // the host's buffer was full
  std::uint64_t bad_messages = 0;    // each also costs its sender the connection
  std::uint64_t cuts = 0;            // modules cut by the watchdog
};

class WorldServer {
 public:
  using Observer = std::function<void(const World&, TimePoint)>;

  /// The world must outlive the server. Nothing is opened yet.
  WorldServer(World& world, ServerConfig config);
  /// Says goodbye to all hosts and removes the socket file.
  ~WorldServer();

  /// Called after each tick, in run's thread. May change nothing.
  void set_observer(Observer observer) { observer_ = std::move(observer); }

  /// Binds the socket. An Error when the path is taken, too long or out of reach, or a module is not there.
  Status open();
  /// Runs until the world's time is `until` or `stop` is called. Lockstep: an Error names the modules that
  /// never came, did not answer in time or left. Both: an Error when the physics broke down.
  /// May be called again to go on.
  Status run(TimePoint until);
  void stop() noexcept { stopping_ = true; }

  /// Ends all connections with this reason and removes the socket file.
  void close(std::string_view reason);

  /// For run's thread, its observer included, or after run has returned.
  const ServerStats& stats() const { return stats_; }
  std::size_t hosts_connected() const;

 private:
  struct Host {
    std::uint32_t module = 0;
    PacketSocket socket;
    std::uint64_t answered_tick = 0;
    Actuators answer;
    bool fresh = false;  // `answer` has not been handed to the world yet
    bool alive = false;  // has a host whose watchdog has not run out
    Duration heard{};    // monotonic time of its last word
    std::string left;    // why its host is gone, if it is
  };

  Status run_lockstep(TimePoint until);
  Status run_wall(TimePoint until);
  Status wait_for_hosts();
  Status wait_for_answers();
  std::string absent(bool (*missing)(const Host&, std::uint64_t tick)) const;
  void hand_over_answers();
  void step(Duration duration);
  void send_sensors();
  void watch();

  void pump(Duration timeout);
  void accept_all();
  void greet(PacketSocket& stranger, const PacketSocket::Received& received);
  std::string objection(const Hello& hello);
  void drain(Host& host);
  void drop(Host& host, std::string reason);

  World& world_;
  ServerConfig config_;
  Observer observer_;
  PacketSocket listener_;
  std::vector<PacketSocket> strangers_;  // connected, have not said Hello yet
  std::vector<Host> hosts_;
  std::uint64_t tick_ = 0;
  bool sent_ = false;  // the sensors of tick_ are out
  ServerStats stats_;
  std::atomic<bool> stopping_{false};
};

}  // namespace eciton::hal::sim
