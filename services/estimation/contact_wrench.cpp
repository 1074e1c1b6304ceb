// The common disturbance and the running sum.
#include "services/estimation/contact_wrench.hpp"

#include <algorithm>

#include "core/robot/common_disturbance.hpp"

namespace eciton::estimation {

using robot::Vector3;
using robot::Wrench;

ChainWrench solve_contacts(std::span<const MemberWrench> members, std::span<MemberContact> contacts,
                           const robot::FreshnessConfig& config) {
  ChainWrench out;
  const std::size_t count = members.size();
  out.complete = count > 0;
  double weight = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const MemberWrench& m = members[k];
    out.complete = out.complete && m.known;
    contacts[k] = {};
    contacts[k].freshness = m.known ? robot::freshness(m.age_s, config) : 0;
    if (contacts[k].freshness >= 1) ++out.fresh;
    weight += contacts[k].freshness;
    const bool last = k + 1 == count;
    contacts[k].link_W = last ? m.port_to_next_W : Vector3(0.5 * (m.port_to_next_W + members[k + 1].port_to_last_W));
  }
  if (!out.complete || weight < 1e-9) return out;

  const robot::CommonDisturbance common(count, [&](std::size_t k) {
    return robot::ChainLoad{members[k].external_W, members[k].r_W, contacts[k].freshness};
  });
  out.mean_r_W = common.mean_r_W();
  out.common_W = {common.force_W(), common.moment_W()};
  Wrench sum;  // about mean_r_W
  for (std::size_t k = 0; k < count; ++k) {
    MemberContact& m = contacts[k];
    m.d_W = (members[k].external_W - common.share(members[k].r_W)) * m.freshness;
    sum += robot::shift(m.d_W, members[k].r_W - out.mean_r_W);
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
