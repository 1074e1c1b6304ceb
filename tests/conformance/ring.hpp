// What the conformance tests share: a ring of two participants, of one vendor or of two, and waiting that is
// bounded. Every plugin passes every test here.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include "core/bus/participant.hpp"
#include "idl/topics.hpp"

namespace eciton::bus::conformance {

/// Who writes and who reads.
struct Pair {
  std::string writer;
  std::string reader;
};

inline void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.writer << " to " << pair.reader; }

inline std::string name_of(const ::testing::TestParamInfo<Pair>& pair) {
  return pair.param.writer == pair.param.reader ? pair.param.writer : pair.param.writer + "_to_" + pair.param.reader;
}

inline const std::vector<Pair> all_pairs = {{"fastdds", "fastdds"},
                                            {"cyclonedds", "cyclonedds"},
                                            {"sim_network", "sim_network"},
                                            {"fastdds", "cyclonedds"},
                                            {"cyclonedds", "fastdds"}};

/// Of this process alone, as far as a number up to 100 goes.
inline std::uint32_t test_domain() { return 100 + static_cast<std::uint32_t>(::getpid()) % 100; }

/// Longer than a loaded machine keeps a vendor's threads from announcing themselves: when one side's lease alone
/// runs out, Fast DDS 2.9.1 stays deaf until the other side's does too (seen here at 1 s and a load of 30).
inline constexpr Duration long_lease = std::chrono::seconds(20);
/// Where a peer's death is waited for.
inline constexpr Duration short_lease = std::chrono::milliseconds(1500);

inline ParticipantConfig config_of(const std::string& vendor, std::uint32_t domain = test_domain(),
                                   Duration lease = long_lease) {
  static std::atomic<int> number = 0;
  ParticipantConfig config;
  config.vendor = vendor;
  config.domain = domain;
  config.name = "conformance_" + std::to_string(++number);
  config.lease = lease;
  return config;
}

/// Polls until the condition holds; false after a time no healthy machine needs.
template <class Condition>
[[nodiscard]] bool eventually(Condition&& condition) {
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(40);
       std::chrono::steady_clock::now() < end;) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

/// Both ends know each other: from here on even volatile samples arrive.
template <class AnyWriter, class AnyReader>
[[nodiscard]] bool matched(const AnyWriter& writer, const AnyReader& reader, std::uint32_t count = 1) {
  return eventually([&] { return writer.matched() == count && reader.matched() >= 1; });
}

/// Takes until `enough(samples)`; what came is in `samples` either way.
template <class T, class Enough>
[[nodiscard]] bool take_until(Reader<T>& reader, std::vector<T>& samples, Enough&& enough) {
  return eventually([&] {
    while (const auto sample = reader.take()) samples.push_back(sample->value);
    return enough(samples);
  });
}

/// Takes until `count` samples came.
template <class T>
std::vector<T> take_count(Reader<T>& reader, std::size_t count) {
  std::vector<T> samples;
  EXPECT_TRUE(take_until(reader, samples, [count](const auto& all) { return all.size() >= count; }))
      << reader.topic_name() << ": " << samples.size() << " of " << count << " samples came";
  return samples;
}

class Conformance : public ::testing::TestWithParam<Pair> {
 protected:
  Participant a{config_of(GetParam().writer)};
  Participant b{config_of(GetParam().reader)};
};

inline msg::LinkClaim claim(std::uint32_t module_id, std::uint32_t port, std::uint64_t number) {
  msg::LinkClaim sample;
  sample.module_id = module_id;
  sample.port = port;
  sample.sequence_number = number;
  return sample;
}

inline msg::ModuleState state_at(std::uint32_t module_id, std::int64_t stamp_ns) {
  msg::ModuleState sample;
  sample.module_id = module_id;
  sample.stamp_ns = stamp_ns;
  sample.p_WM_m = {1.5, -2.5, 0.1 * module_id};
  return sample;
}

inline msg::Event event_number(std::uint32_t module_id, std::int64_t number) {
  msg::Event sample;
  sample.module_id = module_id;
  sample.stamp_ns = number;
  sample.service = "docking";
  sample.detail.assign("number " + std::to_string(number));
  return sample;
}

}  // namespace eciton::bus::conformance
