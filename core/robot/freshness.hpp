// How much a peer's last value still counts, by its age: fully while fresh, not at all when gone, linearly
// less between. Estimation and control fade silent peers by this one rule.
#pragma once

#include <algorithm>

namespace eciton::robot {

/// At 100 Hz sharing, loss of half the samples and 0.2 s of delay stay within `fresh_s`; a peer is called
/// silent after 0.3 s (docs/architecture.md, "When things fail").
struct FreshnessConfig {
  double fresh_s = 0.3;
  double gone_s = 1.0;
};

/// 1 up to fresh_s, 0 from gone_s; a negative age (never heard) is 0.
inline double freshness(double age_s, const FreshnessConfig& config) {
  if (!(age_s >= 0)) return 0;
  return std::clamp((config.gone_s - age_s) / (config.gone_s - config.fresh_s), 0.0, 1.0);
}

}  // namespace eciton::robot
