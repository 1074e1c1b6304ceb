// Link claims from the air: let in, held until their module's beacon is heard, or refused, counted and told of.
#include <algorithm>
#include <cstdio>

#include "services/radio/radio_service.hpp"

namespace eciton::radio {
namespace {

constexpr Duration unknown_patience = std::chrono::seconds(6);  // idle beacons come every 2 s, and two may be lost
constexpr Duration tell_every = std::chrono::seconds(10);       // of each kind

GuardedClaim guarded(const msg::LinkClaim& m) {
  return {.module = m.module_id,
          .port = m.port,
          .linked = !m.withdrawn,
          .peer = m.peer_id,
          .peer_port = m.peer_port,
          .latched = m.latch == msg::LatchStatus::latched,
          .incarnation = m.incarnation,
          .sequence_number = m.sequence_number};
}

constexpr const char* fault_texts[claim_fault_count] = {"malformed", "not written by that module's radio",
                                                        "no beacon of that module is heard",
                                                        "it names a port that does not exist"};

}  // namespace

void RadioService::take_claim(bus::RawWriter& to_ring, std::span<const std::uint8_t> cdr,
                              std::uint64_t origin) noexcept {
  if (origin == bus::ReaderCore::own_origin) return;  // our own, on its way out
  msg::LinkClaim message;
  if (!bus::decode(cdr, message)) return refuse_claim(ClaimFault::malformed, 0);
  const GuardedClaim claim = guarded(message);
  const ClaimFault fault = claim_guard_.judge(claim, origin);
  if (fault == ClaimFault::count) {
    to_ring.write(cdr);
  } else if (fault == ClaimFault::unknown_module) {
    hold_claim(claim, cdr, origin);
  } else {
    refuse_claim(fault, claim.module);
  }
}

void RadioService::hold_claim(const GuardedClaim& claim, std::span<const std::uint8_t> cdr,
                              std::uint64_t origin) noexcept {
  HeldClaim* place = std::find_if(held_claims_.begin(), held_claims_.end(), [&](const HeldClaim& held) {
    return held.claim.module == claim.module && held.claim.port == claim.port;
  });
  if (place == held_claims_.end()) {
    place = std::find_if(held_claims_.begin(), held_claims_.end(), [](const HeldClaim& h) { return h.size == 0; });
    if (place == held_claims_.end()) return refuse_claim(ClaimFault::unknown_module, claim.module);
    *place = {};
    place->since = now_;
  }
  if (place->overdue) refuse_claim(ClaimFault::unknown_module, claim.module);
  place->claim = claim;
  place->origin = origin;
  place->size = cdr.size();
  std::copy(cdr.begin(), cdr.end(), place->bytes.begin());
}

void RadioService::look_at_held_claims() noexcept {
  for (HeldClaim& held : held_claims_) {
    if (held.size == 0) continue;
    if (claim_guard_.knows(held.claim.module)) {
      const ClaimFault fault = claim_guard_.judge(held.claim, held.origin);
      if (fault == ClaimFault::count) {
        claims_to_ring_->write(std::span(held.bytes).first(held.size));
      } else {
        refuse_claim(fault, held.claim.module);
      }
      held = {};
    } else if (!held.overdue && std::chrono::abs(now_ - held.since) > unknown_patience) {
      held.overdue = true;  // from here on each further one counts at once
      refuse_claim(ClaimFault::unknown_module, held.claim.module);
    }
  }
}

void RadioService::refuse_claim(ClaimFault fault, std::uint32_t module) noexcept {
  claim_guard_.refuse(fault);
  const auto kind = static_cast<std::size_t>(fault);
  if (claims_told_at_[kind] && std::chrono::abs(now_ - *claims_told_at_[kind]) < tell_every) return;
  claims_told_at_[kind] = now_;
  char text[128];
  std::snprintf(text, sizeof text, "link claim of module %u refused: %s; %llu such so far", module, fault_texts[kind],
                static_cast<unsigned long long>(claim_guard_.refused(fault)));
  msg::Fault out{.module_id = config_.module_id, .stamp_ns = to_ns(now_), .severity = msg::Severity::warning};
  out.service = "radio";
  out.device = "link claims";
  out.text = text;
  fault_.write(out);
}

void RadioService::add_refused_claims(msg::RadioState& state) const noexcept {
  // Of some bytes the bus itself says that they are no claim.
  const bus::ReaderStatistics& count = claims_from_swarm_->statistics();
  state.claims_malformed =
      claim_guard_.refused(ClaimFault::malformed) + count.dropped_malformed + count.vendor_rejected;
  state.claims_foreign = claim_guard_.refused(ClaimFault::foreign_writer);
  state.claims_unknown = claim_guard_.refused(ClaimFault::unknown_module);
  state.claims_no_port = claim_guard_.refused(ClaimFault::no_such_port);
}

}  // namespace eciton::radio
