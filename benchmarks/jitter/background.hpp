// What else the machine does while wake-ups are measured: nothing, everything, or DDS traffic; and how much of it
// the hypervisor took away.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"

namespace eciton::deploy {
class Supervisor;
}

namespace eciton::bench {

struct JitterOptions;

/// Programs that run as long as it lives.
class Background {
 public:
  /// An Error when there is no such condition, or a program it needs cannot be started.
  static eciton::Result<std::unique_ptr<Background>> start(const std::string& condition,
                                                           const JitterOptions& options);
  /// Whether what `condition` needs is there.
  static Status check(const std::string& condition, const JitterOptions& options);
  ~Background();

  /// What has ended by itself, though it should not have; empty: nothing.
  std::string trouble();

 private:
  Background() = default;
  std::string log_directory_;
  std::unique_ptr<deploy::Supervisor> programs_;
};

/// Time the hypervisor gave to others while something here wanted to run, over all processors, since boot: "steal" of
/// the first line of /proc/stat. Nothing: that line is not there.
std::optional<Duration> parse_stolen(std::string_view proc_stat, long ticks_per_s);
std::optional<Duration> stolen();

}  // namespace eciton::bench
