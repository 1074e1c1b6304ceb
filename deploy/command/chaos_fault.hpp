// What a chaos run does to a fleet's processes and to the radio between its hosts, and how it is undone.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "deploy/command/demo_fleet.hpp"

namespace eciton::deploy {

enum class FaultKind { kill, hang, partition, loss };
enum class FlightStage { separated, approach, assembled };

inline constexpr std::array fault_kinds{FaultKind::kill, FaultKind::hang, FaultKind::partition, FaultKind::loss};
inline constexpr std::array flight_stages{FlightStage::separated, FlightStage::approach, FlightStage::assembled};
/// Of a module, as its launch calls them.
inline constexpr std::array module_processes{"hardware", "estimation", "control", "docking", "joints", "radio"};

const char* name_of(FaultKind kind);
const char* name_of(FlightStage stage);
/// Of processes; the others are of a module's radio link.
constexpr bool strikes_a_process(FaultKind kind) { return kind == FaultKind::kill || kind == FaultKind::hang; }

/// One fault at one time of a flight.
struct ChaosCell {
  FaultKind kind{};
  FlightStage stage{};
  std::uint32_t module_id = 1;
  std::string process{};  // of `kill` and `hang`

  /// "kill m2/control, assembled"
  std::string text() const;
  /// How long the cause acts; a kill is over at once.
  Duration lasts() const;
};

class FaultInjector {
 public:
  FaultInjector(std::string net, const Launches& launches) : net_(std::move(net)), launches_(launches) {}

  /// An Error when there is nothing to strike.
  Status begin(const ChaosCell& cell);
  Status end(const ChaosCell& cell);
  /// Of the process that a cell strikes, now; 0 while it does not run.
  pid_t pid_of(const ChaosCell& cell) const;
  /// What the last begin struck.
  pid_t struck() const { return struck_; }

 private:
  Status set_link(std::uint32_t module_id, const std::string& word);

  std::string net_;
  const Launches& launches_;
  pid_t struck_ = 0;
};

}  // namespace eciton::deploy
