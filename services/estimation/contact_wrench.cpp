// The common disturbance and the running sum.
#include "services/estimation/contact_wrench.hpp"

#include <algorithm>

#include "core/robot/chain_disturbance.hpp"

namespace eciton::estimation {

using robot::Vector3;
using robot::Wrench;

namespace {

/// Where each member is; those never heard of, straight on from the next that was: centre, port, centre.
void place(std::span<const MemberWrench> members, std::span<MemberContact> contacts) {
  const std::size_t count = members.size();
  std::size_t first = count;  // that is known
  Vector3 half = Vector3::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    if (members[k].known) {
      first = std::min(first, k);
      contacts[k].r_W = members[k].r_W;
      half = members[k].port_to_next_W - members[k].r_W;
    } else if (first < count) {
      contacts[k].r_W = contacts[k - 1].r_W + 2 * half;
    }
  }
  if (first == count) return;
  half = members[first].port_to_last_W - members[first].r_W;
  for (std::size_t k = first; k-- > 0;) contacts[k].r_W = contacts[k + 1].r_W + 2 * half;
}

/// The docking point of member k and the next: midway between what both say, or as one says, or between them.
Vector3 link_point(std::span<const MemberWrench> members, std::span<const MemberContact> contacts, std::size_t k) {
  const MemberWrench &m = members[k], &next = members[k + 1];
  if (m.known && next.known) return 0.5 * (m.port_to_next_W + next.port_to_last_W);
  if (m.known) return m.port_to_next_W;
  if (next.known) return next.port_to_last_W;
  return 0.5 * (contacts[k].r_W + contacts[k + 1].r_W);
}

}  // namespace

ChainWrench solve_contacts(std::span<const MemberWrench> members, std::span<MemberContact> contacts,
                           const robot::FreshnessConfig& config) {
  ChainWrench out;
  const std::size_t count = members.size();
  std::fill(contacts.begin(), contacts.end(), MemberContact{});
  place(members, contacts);
  out.complete = count > 0;
  double weight = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const MemberWrench& m = members[k];
    out.complete = out.complete && m.known;
    contacts[k].freshness = m.known ? robot::freshness(m.age_s, config) : 0;
    if (contacts[k].freshness >= 1) ++out.fresh;
    weight += contacts[k].freshness;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const bool last = k + 1 == count;
    contacts[k].link_W = last ? members[k].port_to_next_W : link_point(members, contacts, k);
    contacts[k].link_freshness = last ? 0 : std::min(contacts[k].freshness, contacts[k + 1].freshness);
  }
  if (weight < 1e-9) return out;

  const robot::ChainDisturbance common(count, [&](std::size_t k) {
    return robot::ChainLoad{members[k].external_W, contacts[k].r_W, contacts[k].freshness};
  });
  out.mean_r_W = common.mean_r_W();
  out.common_W = {common.force_W(), common.moment_W()};
  Wrench sum;  // about mean_r_W
  for (std::size_t k = 0; k < count; ++k) {
    MemberContact& m = contacts[k];
    if (m.freshness > 0) m.d_W = (members[k].external_W - common.share(m.r_W)) * m.freshness;
    sum += robot::shift(m.d_W, m.r_W - out.mean_r_W);
    if (k + 1 < count) m.contact_W = -robot::shift(sum, out.mean_r_W - m.link_W);
  }
  return out;
}

ContactWrenches contact_wrenches(std::span<const MemberWrench> all, const robot::FreshnessConfig& config) {
  ContactWrenches out;
  out.count = std::min(all.size(), robot::members_max);
  static_cast<ChainWrench&>(out) =
      solve_contacts(all.first(out.count), std::span(out.members).first(out.count), config);
  return out;
}

}  // namespace eciton::estimation
