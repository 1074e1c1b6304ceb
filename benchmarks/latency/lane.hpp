// A lane: one way to carry a payload there and back, between two processes that live through the whole run, so that
// blocks of many lanes can be interleaved. A lane that breaks says why and takes no more part.
#pragma once

#include <optional>
#include <string>

#include "benchmarks/latency/peers/block.hpp"
#include "benchmarks/latency/process.hpp"

namespace eciton::bench {

enum class Kind : std::uint8_t { ours, native, foreign };

struct LaneSpec {
  std::string name;   // "ours.cyclonedds.wake", a part of metric names
  std::string label;  // "ours on Cyclone DDS, wake"
  Kind kind = Kind::foreign;
  std::string vendor;    // of both ends; empty: mixed or none
  std::string delivery;  // wake or inline; empty: of the transport's choice
  ProgramSpec ping, echo;
};

struct BlockOrder {
  std::uint32_t bytes = 0;
  std::uint32_t count = 0;
  double rate_Hz = 0;
};

struct Block {
  BlockReport ping, echo;
};

class Lane {
 public:
  explicit Lane(LaneSpec spec) : spec_(std::move(spec)) {}

  /// The opening, in steps that all lanes take together. Each leaves the reason in trouble() if it fails.
  void start();
  void greet(Duration deadline, const runtime::StopFlag& stop);
  bool look_for_match(const runtime::StopFlag& stop);
  /// Blocks nobody counts, until one is answered as a whole: "matched" of one side does not mean that of the other.
  void warm_up(BlockOrder order, Duration deadline, const runtime::StopFlag& stop);
  void give_up(const std::string& why);

  /// A block, in three steps, so that lanes can be measured side by side, sample by sample in turn. Each does nothing
  /// once the lane is broken or the run interrupted: see trouble().
  void prepare(const BlockOrder& order, const runtime::StopFlag& stop);
  void send_from(Duration start);  // the first planned instant
  std::optional<Block> collect(const runtime::StopFlag& stop);
  /// All three.
  std::optional<Block> run(const BlockOrder& order, const runtime::StopFlag& stop);

  bool good() const { return trouble_.empty(); }
  const std::string& trouble() const { return trouble_; }
  const LaneSpec& spec() const { return spec_; }

 private:
  std::optional<std::string> ask(Process& of, const std::string& line, Duration patience,
                                 const runtime::StopFlag& stop);
  std::optional<std::string> heard(Process& of, Duration deadline, const runtime::StopFlag& stop);
  std::optional<BlockReport> report(Process& of, Duration deadline, const runtime::StopFlag& stop);

  LaneSpec spec_;
  std::optional<Process> ping_, echo_;
  std::string trouble_;
  std::uint32_t next_sequence_ = 1;
  BlockOrder order_;
  std::uint32_t base_ = 0;
  Duration latest_end_{};                             // of the samples under way
  Duration linger_ = std::chrono::milliseconds(500);  // for the last answers of a block; shorter once known
};

}  // namespace eciton::bench
