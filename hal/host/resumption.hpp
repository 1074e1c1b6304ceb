// A hardware host whose process died in flight comes back: before there is a ring, the rotors run again and the
// module holds its hover on the IMU, in a thread of its own.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "hal/devices.hpp"
#include "hal/host/safe_output.hpp"

namespace eciton::hal {

/// How the devices' board is reached, by the thread that flies.
struct BoardAccess {
  std::function<bool()> wait_sensors;  // true: new readings; bounded
  std::function<void()> act;           // sends what was written
};

class Resumption {
 public:
  /// Begins when `checkpoint` is of a flight that was on a moment ago (`runtime::resume_within`); nothing otherwise.
  /// The devices are configured, and nobody else's until `end`.
  static std::unique_ptr<Resumption> begin(const std::filesystem::path& checkpoint, const robot::Airframe& airframe,
                                           Devices& devices, BoardAccess board, TimePoint now);
  ~Resumption();

  /// What goes on flying.
  SafeOutput end();

 private:
  Resumption(SafeOutput output, Devices& devices, BoardAccess board);
  void fly();

  SafeOutput output_;
  Devices& devices_;
  BoardAccess board_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace eciton::hal
