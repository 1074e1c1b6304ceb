// What a chaos run does to a fleet's processes and to the radio between its hosts, and how it is undone.
#pragma once

#include <array>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "deploy/command/demo_fleet.hpp"

namespace eciton::deploy {

enum class FaultKind { kill, hang, partition, loss, address, full_disk };
enum class FlightStage { separated, approach, assembled };

inline constexpr std::array fault_kinds{FaultKind::kill, FaultKind::hang,    FaultKind::partition,
                                        FaultKind::loss, FaultKind::address, FaultKind::full_disk};
inline constexpr std::array flight_stages{FlightStage::separated, FlightStage::approach, FlightStage::assembled};
/// Of a module, as its launch calls them.
inline constexpr std::array module_processes{"hardware", "estimation", "control", "docking", "joints", "radio"};

const char* name_of(FaultKind kind);
const char* name_of(FlightStage stage);
/// Of processes; the others are of a module's radio link, or of the disk that all log to.
constexpr bool strikes_a_process(FaultKind kind) { return kind == FaultKind::kill || kind == FaultKind::hang; }

/// One fault at one time of a flight.
struct ChaosCell {
  FaultKind kind{};
  FlightStage stage{};
  std::uint32_t module_id = 1;
  std::string process{};  // of `kill` and `hang`

  /// Whose role is empty for a while: what is struck, and the radio of a host that moves. Empty: nobody's.
  std::string replaced() const { return kind == FaultKind::address ? "radio" : process; }

  /// "kill m2/control, assembled"
  std::string text() const;
  /// How long the cause acts; a kill is over at once.
  Duration lasts() const;
};

class FaultInjector {
 public:
  /// `disk`: where the processes' runtime directories are, small enough to be filled.
  FaultInjector(net::NetSpec net, std::filesystem::path disk, const Launches& launches)
      : net_(std::move(net)), disk_(std::move(disk)), launches_(launches) {}

  /// An Error when there is nothing to strike.
  Status begin(const ChaosCell& cell);
  Status end(const ChaosCell& cell);
  /// Of the process whose role a cell empties, now; 0 while it does not run.
  pid_t pid_of(const ChaosCell& cell) const;
  /// What the last begin struck.
  pid_t struck() const { return struck_; }

 private:
  Status set_link(std::uint32_t module_id, const std::string& word);
  Status move(std::uint32_t module_id);
  Status fill_disk();

  net::NetSpec net_;
  std::filesystem::path disk_;
  std::set<std::uint32_t> moved_;  // modules whose host has its second address
  const Launches& launches_;
  pid_t struck_ = 0;
};

}  // namespace eciton::deploy
