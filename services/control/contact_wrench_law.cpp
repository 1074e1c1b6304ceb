// Both contact wrench laws.
#include "services/control/contact_wrench_law.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::control {
namespace {

using robot::Vector3;
using robot::Wrench;

Wrench wanted(std::span<const Wrench> desired_W, std::size_t link) {
  return link < desired_W.size() ? desired_W[link] : Wrench{};
}

}  // namespace

Wrench local_step(std::span<const ChainMember> members, std::size_t own, std::span<const Wrench> desired_W) {
  const ChainMember& me = members[own];
  Wrench step = me.d_W;
  if (own > 0) step -= robot::shift(wanted(desired_W, own - 1), members[own - 1].link_W - me.r_W);
  if (own + 1 < members.size()) step += robot::shift(wanted(desired_W, own), me.link_W - me.r_W);
  return step;
}

Wrench paper_step(std::span<const ChainMember> members, std::size_t own, std::span<const Wrench> desired_W) {
  // About one common point every link's equation reads s_i - s_{i+1} = delta_i.
  const std::size_t base = base_index(members.size());
  const Vector3 origin = members[base].r_W;
  const auto delta = [&](std::size_t i) {
    return robot::shift(wanted(desired_W, i) - members[i].contact_W, members[i].link_W - origin);
  };
  Wrench sum;
  for (std::size_t i = base; i < own; ++i) sum -= delta(i);
  for (std::size_t i = own; i < base; ++i) sum += delta(i);
  return robot::shift(sum, origin - members[own].r_W);
}

void ContactWrenchLaw::reset() {
  feed_forward_W_ = {};
  paper_wait_s_ = 0;
  clamped_ = false;
}

void ContactWrenchLaw::add(const Wrench& step) {
  const Wrench asked = feed_forward_W_ + step;
  feed_forward_W_ = {asked.force.cwiseMax(-config_.force_N_max).cwiseMin(config_.force_N_max),
                     asked.moment.cwiseMax(-config_.moment_Nm_max).cwiseMin(config_.moment_Nm_max)};
  clamped_ = asked.force != feed_forward_W_.force || asked.moment != feed_forward_W_.moment;
}

const Wrench& ContactWrenchLaw::fade(double dt_s) {
  feed_forward_W_ = feed_forward_W_ * std::exp(-dt_s / config_.fade_time_constant_s);
  return feed_forward_W_;
}

const Wrench& ContactWrenchLaw::update(std::span<const ChainMember> members, std::size_t own,
                                       std::span<const Wrench> desired_W, double dt_s) {
  const std::size_t n = members.size();
  if (n < 2 || own >= n || config_.law == ContactLaw::none) return fade(dt_s);
  double peers = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (i != own) peers += robot::freshness(members[i].age_s, config_.freshness) / static_cast<double>(n - 1);
  }
  if (config_.law == ContactLaw::local) {
    const double rate_1_s =
        std::min(config_.observer_gain_1_s / 3, config_.bending_rate_1_s / static_cast<double>(n));
    add(local_step(members, own, desired_W) * (config_.sign * rate_1_s * std::clamp(dt_s, 0.0, 0.1)));
  } else {
    paper_wait_s_ += dt_s;
    if (paper_wait_s_ >= config_.paper_period_s - 1e-9) {
      paper_wait_s_ = 0;
      // Contact wrenches towards a silent member are guesses: trusted by as much as it is fresh.
      const double gamma = config_.paper_gain / std::exp2(static_cast<double>(n) - 2);
      add(paper_step(members, own, desired_W) * (config_.sign * gamma * peers));
    }
  }
  feed_forward_W_ = feed_forward_W_ * std::exp(-(1 - peers) * dt_s / config_.fade_time_constant_s);
  return feed_forward_W_;
}

}  // namespace eciton::control
