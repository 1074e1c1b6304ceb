// Which link claims that come over the air are let in. A claim is the word of one module about its own port, so it
// comes from that module's radio, which its beacons tell, and names ports that exist. What does not is counted.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.hpp"

namespace eciton::radio {

/// A claim as the guard looks at it.
struct GuardedClaim {
  std::uint32_t module = 0;
  std::uint32_t port = 0;
  bool linked = false;  // it names a peer, else the two below are void
  std::uint32_t peer = 0;
  std::uint32_t peer_port = 0;
  bool latched = false;
  std::uint64_t incarnation = 0;
  std::uint64_t sequence_number = 0;
};

enum class ClaimFault : std::uint8_t {
  malformed,       // not the bytes of a claim, or its fields contradict each other
  foreign_writer,  // not written by the radio of the module it speaks for
  unknown_module,  // of a module whose beacon was never heard
  no_such_port,    // its own, or its peer's
  count
};
constexpr std::size_t claim_fault_count = static_cast<std::size_t>(ClaimFault::count);

struct ClaimGuardConfig {
  std::uint32_t own_id = 0;
  std::uint32_t ports = 2;  // of each module: the fleet's airframe
};

/// Real-time safe; one thread. Origins are those of core/bus: one number for all writers of a participant, 0 where it
/// is not known, which contradicts nothing.
class ClaimGuard {
 public:
  static constexpr std::uint32_t id_max = 90;  // of a module

  explicit ClaimGuard(const ClaimGuardConfig& config) : config_(config) {}

  /// A module's radio is who sends its beacons. Another takes its place only with a later incarnation, as after a
  /// restart: one that keeps sending under a module's id does not become its radio by that.
  void hear_beacon(std::uint32_t module, std::uint64_t incarnation, std::uint64_t origin) noexcept;
  bool knows(std::uint32_t module) const noexcept { return module < radios_.size() && radios_[module].heard; }

  /// Nothing is wrong with it: ClaimFault::count. Counts nothing.
  ClaimFault judge(const GuardedClaim& claim, std::uint64_t origin) const noexcept;

  void refuse(ClaimFault fault) noexcept { ++refused_[static_cast<std::size_t>(fault)]; }
  std::uint64_t refused(ClaimFault fault) const noexcept { return refused_[static_cast<std::size_t>(fault)]; }
  std::uint64_t refused() const noexcept;

 private:
  struct Radio {
    bool heard = false;
    std::uint64_t incarnation = 0;
    std::uint64_t origin = 0;
  };

  ClaimGuardConfig config_;
  std::array<Radio, id_max + 1> radios_{};  // by module id
  std::array<std::uint64_t, claim_fault_count> refused_{};
};

}  // namespace eciton::radio
