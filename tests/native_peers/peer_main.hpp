// What a native peer does, whatever its vendor:
//   golden             prints the bytes of every topic's type for every seed: "topic seed hexadecimal"
//   write DOMAIN       writes every topic, seed after seed, until its standard input closes
//   read DOMAIN        ends well when every topic gave every seed's sample and nothing else
#pragma once

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/native_peers/pattern.hpp"

namespace eciton::native_peers {

struct TopicQos {
  bool reliable;
  bool transient_local;
  int depth;
};

/// One topic on a vendor's own API.
class Channel {
 public:
  virtual ~Channel() = default;
  virtual const char* topic() const = 0;
  virtual std::vector<std::uint8_t> bytes(std::uint64_t seed) = 0;
  virtual void open_writer() = 0;
  virtual void open_reader() = 0;
  virtual void write(std::uint64_t seed) = 0;
  /// Reads what there is; sets the bit of each seed whose sample came. False: a sample that is none of them.
  virtual bool read(std::uint64_t& seen) = 0;
};
using Channels = std::vector<std::unique_ptr<Channel>>;

inline bool input_closed() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char byte = 0;
  return poll(&input, 1, 0) > 0 && ::read(STDIN_FILENO, &byte, 1) <= 0;
}

inline int print_golden(const Channels& channels) {
  for (const auto& channel : channels) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      std::printf("%s %d ", channel->topic(), static_cast<int>(seed));
      for (const std::uint8_t byte : channel->bytes(seed)) std::printf("%02x", byte);
      std::printf("\n");
    }
  }
  return 0;
}

inline int write_all(const Channels& channels) {
  for (const auto& channel : channels) channel->open_writer();
  for (std::uint64_t round = 0; !input_closed(); ++round) {
    for (const auto& channel : channels) channel->write(round % kSeeds);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return 0;
}

inline int read_all(const Channels& channels) {
  for (const auto& channel : channels) channel->open_reader();
  std::vector<std::uint64_t> seen(channels.size(), 0);
  constexpr std::uint64_t kAll = (1u << kSeeds) - 1;
  std::size_t complete = 0;
  while (complete < channels.size() && !input_closed()) {
    complete = 0;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      if (!channels[k]->read(seen[k])) {
        std::printf("%s: a sample with other values than were written\n", channels[k]->topic());
        return 1;
      }
      if (seen[k] == kAll) ++complete;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  for (std::size_t k = 0; k < channels.size(); ++k) {
    if (seen[k] != kAll) std::printf("%s: seeds seen 0x%x\n", channels[k]->topic(), static_cast<unsigned>(seen[k]));
  }
  return complete == channels.size() ? 0 : 1;
}

/// `make(domain)` joins the domain (any for golden) and gives a channel for every topic.
template <class Make>
int peer_main(int count, char** arguments, Make&& make) {
  const std::string command = count > 1 ? arguments[1] : "";
  const std::uint32_t domain = count > 2 ? static_cast<std::uint32_t>(std::strtoul(arguments[2], nullptr, 10)) : 230;
  if (command == "golden") return print_golden(make(domain));
  if (command == "write" && count > 2) return write_all(make(domain));
  if (command == "read" && count > 2) return read_all(make(domain));
  std::fprintf(stderr, "usage: %s golden | write DOMAIN | read DOMAIN\n", arguments[0]);
  return 2;
}

}  // namespace eciton::native_peers
