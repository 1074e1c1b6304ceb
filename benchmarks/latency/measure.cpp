// Lanes open together; cells and teams of lanes take turns in short blocks, forward and backward. Ours and the native
// one that it is held against are a team: they run at once, sample by sample in turn, so that both have one weather.
#include "benchmarks/latency/measure.hpp"

#include <poll.h>

#include <algorithm>
#include <csignal>
#include <memory>

#include "core/base/wall_clock.hpp"

namespace eciton::bench {
namespace {

constexpr double quick_s = 45;  // of the 60 allowed; the rest is for starting, the last rounds and ending

class Run {
 public:
  Run(const LatencyOptions& options, const Plan& plan, const runtime::StopFlag& stop, const Progress& progress)
      : options_(options), plan_(plan), stop_(stop), progress_(progress), began_(monotonic_now()) {}

  Measured measure() {
    std::signal(SIGPIPE, SIG_IGN);  // of a peer that died: its silence tells
    for (const std::string& over : options_.over) {
      if (stop_.requested()) break;
      const Result<Venue> venue = Venue::open(over, options_);
      if (!venue) {
        note(over + ": " + venue.error().message);
        measured_.partial = true;
        continue;
      }
      place_ = venue->place();
      for (const std::string& qos : options_.qos) measure(over, qos);
    }
    measured_.interrupted = stop_.requested();
    measured_.partial = measured_.partial || measured_.interrupted;
    return std::move(measured_);
  }

 private:
  void measure(const std::string& over, const std::string& qos) {
    if (stop_.requested()) return;
    cells_.clear();
    for (const Cell& cell : plan_.cells) {
      if (cell.qos == qos && cell.over == over) cells_.push_back(cell);
    }
    open(qos);
    measure_rounds();
    finish();
  }

  double elapsed_s() const { return to_s(monotonic_now() - began_); }

  void open(const std::string& qos) {
    progress_(0, 1, 0, "starting peers");
    lanes_.clear();
    for (LaneSpec& spec : lanes_of(options_, place_, qos, measured_.notes)) {
      lanes_.push_back(std::make_unique<Lane>(std::move(spec)));
    }
    const Duration deadline = monotonic_now() + from_s(options_.patience_s);
    for (const auto& lane : lanes_) lane->start();
    for (const auto& lane : lanes_) lane->greet(deadline, stop_);
    match(deadline);
    for (const auto& lane : lanes_) {
      for (const std::uint32_t bytes : options_.bytes) {
        if (lane->good()) lane->warm_up({bytes, 50, options_.rates_Hz.front()}, deadline, stop_);
      }
    }
    streams_.clear();
    for (const Cell& cell : cells_) {
      for (const auto& lane : lanes_) streams_.push_back(stream(*lane, cell));
    }
    if (std::find(options_.baselines.begin(), options_.baselines.end(), "ddsperf") != options_.baselines.end())
      open_ddsperf();
  }

  void match(Duration deadline) {
    std::vector<Lane*> alone;
    for (const auto& lane : lanes_) alone.push_back(lane.get());
    for (;;) {
      std::erase_if(alone, [this](Lane* lane) { return lane->look_for_match(stop_); });
      if (alone.empty()) return;
      if (monotonic_now() > deadline) break;
      ::poll(nullptr, 0, 10);
    }
    for (Lane* lane : alone) lane->give_up("its two ends did not find each other within " + patience());
  }
  std::string patience() const { return std::to_string(static_cast<int>(options_.patience_s)) + " s"; }

  static Stream stream(const Lane& lane, const Cell& cell) {
    Stream made;
    made.lane = lane.spec().name;
    made.label = lane.spec().label;
    made.kind = lane.spec().kind;
    made.vendor = lane.spec().vendor;
    made.delivery = lane.spec().delivery;
    made.cell = cell;
    return made;
  }

  void open_ddsperf() {
    ddsperf_ = find_ddsperf();
    runs_.clear();
    if (ddsperf_.empty()) {
      note("missing: ddsperf is not in the path; it comes with cyclonedds-tools");
      measured_.missing = true;
      return;
    }
    for (const Cell& cell : cells_) {
      if (options_.quick && cell.bytes != 256) continue;
      for (const std::string& delivery : options_.deliveries) runs_.push_back({cell, delivery, {}});
    }
  }

  /// In a short run the time goes to what is gated; the others are met once in a while.
  bool takes_part(const Stream& stream, std::size_t round) const {
    if (!options_.quick || stream.lane == "udp" || !stream.vendor.empty()) return true;
    return stream.cell.bytes == 256 && round % 3 == 0;
  }

  void measure_rounds() {
    const std::size_t all = plan_.rounds;
    std::size_t round = 0;
    const double began_s = elapsed_s();
    for (; round < all && !over(round) && !stop_.requested() && any_good(); ++round) {
      const double per_round_s = round == 0 ? 0 : (elapsed_s() - began_s) / static_cast<double>(round);
      double left_s = per_round_s * static_cast<double>(all - round);
      if (options_.quick) left_s = std::min(left_s, quick_s - elapsed_s());
      for (std::size_t c = 0; c < cells_.size(); ++c) measure_cell(c, round, left_s);
      if (round % std::max<std::size_t>(all / 4, 1) == 1) measure_all_ddsperf();
    }
  }
  bool any_good() const {
    return std::any_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->good(); });
  }
  bool over(std::size_t round) const { return options_.quick && round % 2 == 0 && elapsed_s() > quick_s; }

  /// Lanes that follow each other and are compared: of one vendor at both ends, and one delivery.
  std::vector<std::vector<std::size_t>> teams() const {
    std::vector<std::vector<std::size_t>> all;
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      const LaneSpec& spec = lanes_[l]->spec();
      const bool joins = l > 0 && !spec.vendor.empty() && lanes_[l - 1]->spec().vendor == spec.vendor &&
                         lanes_[l - 1]->spec().delivery == spec.delivery;
      if (joins) {
        all.back().push_back(l);
      } else {
        all.push_back({l});
      }
    }
    return all;
  }

  void measure_cell(std::size_t c, std::size_t round, double left_s) {
    std::vector<std::vector<std::size_t>> turns = teams();
    if (round % 2 == 1) {
      std::reverse(turns.begin(), turns.end());
      for (auto& team : turns) std::reverse(team.begin(), team.end());
    }
    for (const auto& team : turns) {
      if (!takes_part(streams_[c * lanes_.size() + team.front()], round)) continue;
      const Stream& first = streams_[c * lanes_.size() + team.front()];
      progress_(round, plan_.rounds, left_s, first.label + ", " + std::to_string(first.cell.bytes) + " B");
      measure_team(c, team);
    }
  }

  void measure_team(std::size_t c, const std::vector<std::size_t>& team) {
    const Cell& cell = cells_[c];
    const auto count = static_cast<std::uint32_t>(std::max(1.0, options_.block_s * cell.rate_Hz));
    for (const std::size_t l : team) lanes_[l]->prepare({cell.bytes, count, cell.rate_Hz}, stop_);
    Duration start = monotonic_now() + std::chrono::milliseconds(2);
    for (const std::size_t l : team) {
      lanes_[l]->send_from(start);
      start += from_s(1 / cell.rate_Hz / static_cast<double>(team.size()));
    }
    for (const std::size_t l : team) {
      Stream& stream = streams_[c * lanes_.size() + l];
      ++stream.blocks_asked;
      if (const auto block = lanes_[l]->collect(stop_)) stream.add(*block, began_.count());
    }
  }

  void measure_all_ddsperf() {
    for (DdsperfRun& run : runs_) {
      if (stop_.requested() || ddsperf_.empty()) return;
      progress_(0, plan_.rounds, 0, "ddsperf, " + run.delivery);
      if (const Status done = measure_ddsperf(options_, place_, ddsperf_, run, stop_); !done && !stop_.requested()) {
        note("ddsperf, " + run.cell.over + ": " + done.error().message);
        measured_.partial = true;
        ddsperf_.clear();  // it will not do better the next time
      }
    }
  }

  void finish() {
    for (std::size_t k = 0; k < streams_.size(); ++k) {
      const Lane& lane = *lanes_[k % lanes_.size()];
      if (!lane.good() && lane.trouble() != interrupted) {
        streams_[k].trouble = lane.trouble();
        note(lane.spec().label + ": " + lane.trouble());
        measured_.partial = true;
      }
      measured_.streams.push_back(std::move(streams_[k]));
    }
    for (DdsperfRun& run : runs_) measured_.ddsperf.push_back(std::move(run));
    lanes_.clear();
  }

  void note(const std::string& text) {
    auto& notes = measured_.notes;
    if (std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
  }

  const LatencyOptions& options_;
  const Plan& plan_;
  const runtime::StopFlag& stop_;
  const Progress& progress_;
  Duration began_;
  Place place_;
  std::vector<Cell> cells_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::vector<Stream> streams_;  // cell by cell, in each as lanes_
  std::string ddsperf_;
  std::vector<DdsperfRun> runs_;
  Measured measured_;
};

}  // namespace

Measured measure_latency(const LatencyOptions& options, const Plan& plan, const runtime::StopFlag& stop,
                         const Progress& progress) {
  return Run(options, plan, stop, progress).measure();
}

}  // namespace eciton::bench
