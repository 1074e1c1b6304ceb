// What a radio does to frames, as people write it: "delay=20ms", "loss=10%". A link's words are LinkQuality's, with
// bursts and a cut besides; the medium that all links share has a rate.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"

namespace eciton::net {

using bus::sim_network::LinkQuality;

/// Of one directed link between two hosts; everything counts per frame.
struct LinkSettings {
  LinkQuality quality;
  // Bursts of loss after Gilbert and Elliott: a link is in a burst or not, and with each frame it may change.
  double burst_start = 0;   // probability that a burst begins with this frame
  double burst_end = 0.25;  // that it ends: bursts last 1/burst_end frames in the mean
  double burst_loss = 1;    // in a burst, in place of `loss`
  bool cut = false;         // nothing arrives

  bool operator==(const LinkSettings&) const = default;
  template <class V>
  void visit_fields(V& v) {
    v("delay", quality.delay);
    v("jitter", quality.jitter);
    v("loss", quality.loss);
    v("duplication", quality.duplication);
    v("reordering", quality.reordering);
    v("hold", quality.hold);
    v("burst_start", burst_start);
    v("burst_end", burst_end);
    v("burst_loss", burst_loss);
    v("cut", cut);
  }
};

struct BitRate {
  double bit_s = 0;  // 0: unlimited
  bool operator==(const BitRate&) const = default;
};

/// Of the medium: one frame is on the air at a time, whoever sends it.
struct MediumSettings {
  BitRate rate;
  Duration backlog = std::chrono::milliseconds(100);  // a frame that would wait longer for the air is dropped

  bool operator==(const MediumSettings&) const = default;
  template <class V>
  void visit_fields(V& v) {
    v("rate", rate);
    v("backlog", backlog);
  }
};

/// "20ms", "10%", "on", "6Mbit/s": the shortest that reads back as the same value.
std::string to_text(Duration value);
std::string to_text(double probability);
std::string to_text(bool value);
std::string to_text(BitRate value);

// From text; the Error says what is wrong and what would be right.
Status from_text(const std::string& text, Duration& value);
Status from_text(const std::string& text, double& probability);
Status from_text(const std::string& text, bool& value);
Status from_text(const std::string& text, BitRate& value);

/// The keys of LinkSettings or MediumSettings.
template <class Settings>
std::vector<std::string> keys_of() {
  std::vector<std::string> keys;
  const auto collect = [&](const char* key, auto&) { keys.emplace_back(key); };
  Settings().visit_fields(collect);
  return keys;
}

/// Sets one field by its key; an unknown key is left to the caller, as `known` says.
template <class Settings>
Status assign(Settings& settings, const std::string& key, const std::string& value, bool& known) {
  Status status = ok();
  known = false;
  const auto look = [&](const char* field, auto& target) {
    if (key != field) return;
    known = true;
    status = from_text(value, target);
  };
  settings.visit_fields(look);
  if (!status) return Error{key + "=" + value + ": " + status.error().message};
  return status;
}

/// What differs from the defaults, as "delay=20ms loss=10%"; empty: nothing does.
template <class Settings>
std::string differences(Settings settings) {
  std::vector<std::string> defaults;
  const auto note = [&](const char*, auto& field) { defaults.push_back(to_text(field)); };
  Settings().visit_fields(note);
  std::string text;
  std::size_t k = 0;
  const auto compare = [&](const char* key, auto& field) {
    const std::string value = to_text(field);
    if (value != defaults[k++]) text += (text.empty() ? "" : " ") + std::string(key) + "=" + value;
  };
  settings.visit_fields(compare);
  return text;
}

}  // namespace eciton::net
