// `eciton topic list | echo | hz | delay | bw`: what is on a ring, and how it arrives.
#pragma once

#include "deploy/command/command_line.hpp"
#include "deploy/command/ring_options.hpp"

namespace eciton::deploy {

void add_topic(CLI::App& app, Run& run);

/// What the subcommands understand; not each uses all of it.
struct TopicOptions {
  RingOptions ring;
  std::string topic;
  std::uint64_t count = 0;  // samples; 0: no end
  double seconds = 0;       // 0: no end
  double window_s = 1;
  bool json_lines = false;
  bool contract_only = false;
  std::string json_file;
};

int list_topics(const TopicOptions& options);
int echo_topic(const TopicOptions& options);
int measure_rate(const TopicOptions& options);
int measure_delay(const TopicOptions& options);
int measure_bandwidth(const TopicOptions& options);

}  // namespace eciton::deploy
