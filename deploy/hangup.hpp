// What the programs do when the terminal or the reader of their output goes away: a robot flies on, a demo ends
// as if asked to.
#pragma once

#include <csignal>

#include <initializer_list>
#include <utility>
#include <vector>

#include "core/runtime/stop_signal.hpp"

namespace eciton::deploy {

/// While it lives, these signals do nothing to the process.
class IgnoredSignals {
 public:
  explicit IgnoredSignals(std::initializer_list<int> signals);
  ~IgnoredSignals();
  IgnoredSignals(const IgnoredSignals&) = delete;
  IgnoredSignals& operator=(const IgnoredSignals&) = delete;

 private:
  std::vector<std::pair<int, struct sigaction>> before_;
};

/// While it lives, SIGHUP sets the flag, however often it comes: a closing terminal sends it more than once. Where
/// it is ignored already (nohup) it stays so. One per process.
class StopOnHangup {
 public:
  explicit StopOnHangup(runtime::StopFlag& flag);
  ~StopOnHangup();
  StopOnHangup(const StopOnHangup&) = delete;
  StopOnHangup& operator=(const StopOnHangup&) = delete;

 private:
  struct sigaction before_ {};
};

}  // namespace eciton::deploy
