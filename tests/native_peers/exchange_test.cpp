// Every topic's type over the wire, both ways, between our participants on each plugin and programs made by each
// vendor's own generator from the IDL alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/bus/participant.hpp"
#include "idl/topics.hpp"
#include "tests/native_peers/child_process.hpp"
#include "tests/native_peers/our_pattern.hpp"

namespace eciton::native_peers {
namespace {

constexpr std::uint64_t kAll = (1u << kSeeds) - 1;
constexpr auto kLimit = std::chrono::seconds(25);

std::uint32_t domain_of_this_run() { return 100 + static_cast<std::uint32_t>(getpid()) % 100; }

/// One topic of ours, whatever its type.
class OurChannel {
 public:
  virtual ~OurChannel() = default;
  virtual bool write(std::uint64_t seed) = 0;
  virtual bool read(std::uint64_t& seen) = 0;
  virtual std::string_view topic() const = 0;
};

template <class T>
class OurWriter final : public OurChannel {
 public:
  OurWriter(bus::Participant& participant, const bus::Topic<T>& topic)
      : topic_(topic), writer_(participant.create_writer(topic)) {}
  bool write(std::uint64_t seed) override { return writer_.write(our_sample(topic_, seed)); }
  bool read(std::uint64_t&) override { return true; }
  std::string_view topic() const override { return topic_.name; }

 private:
  const bus::Topic<T>& topic_;
  bus::Writer<T> writer_;
};

template <class T>
class OurReader final : public OurChannel {
 public:
  OurReader(bus::Participant& participant, const bus::Topic<T>& topic)
      : topic_(topic), reader_(participant.create_reader(topic)) {}
  bool write(std::uint64_t) override { return true; }
  bool read(std::uint64_t& seen) override {
    while (const auto sample = reader_.take()) {
      std::uint64_t seed = 0;
      while (seed < kSeeds && our_bytes(sample->value) != our_bytes(our_sample(topic_, seed))) ++seed;
      if (seed == kSeeds) return false;
      seen |= std::uint64_t{1} << seed;
    }
    return reader_.statistics().dropped_malformed == 0;
  }
  std::string_view topic() const override { return topic_.name; }

 private:
  const bus::Topic<T>& topic_;
  bus::Reader<T> reader_;
};

template <template <class> class Ours>
std::vector<std::unique_ptr<OurChannel>> channels(bus::Participant& participant) {
  std::vector<std::unique_ptr<OurChannel>> all;
  topics::for_each([&](const auto& topic) {
    using T = typename std::remove_cvref_t<decltype(topic)>::Type;
    all.push_back(std::make_unique<Ours<T>>(participant, topic));
  });
  return all;
}

std::set<std::string> shared_memory_files() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm"))
    names.insert(entry.path().filename().string());
  return names;
}

/// What Fast DDS left in shared memory for this process, of what was not there `before`: after the vendor's and the
/// host's two bytes, names have the process's number, low byte first.
std::set<std::string> left_in_shared_memory(pid_t pid, const std::set<std::string>& before) {
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), ".%02x.%02x.", static_cast<unsigned>(pid) & 0xffu,
                static_cast<unsigned>(pid) >> 8 & 0xffu);
  std::set<std::string> left = shared_memory_files();
  std::erase_if(left, [&](const std::string& name) {
    return before.contains(name) || !name.starts_with("fast") || name.find(number.data()) == std::string::npos;
  });
  return left;
}

class ExchangeTest : public testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  const std::set<std::string> shared_memory_before_ = shared_memory_files();

  static std::string peer() {
    return beside_this_program("native_" + std::string(std::get<0>(GetParam())) + "_peer");
  }
  static bus::ParticipantConfig config(std::uint32_t domain) {
    bus::ParticipantConfig config;
    config.vendor = std::get<1>(GetParam());
    config.domain = domain;
    config.name = "exchange_test";
    return config;
  }
};

TEST_P(ExchangeTest, ANativeWriterReachesOurReaderOnEveryTopic) {
  const std::uint32_t domain = domain_of_this_run();
  ChildProcess native({peer(), "write", std::to_string(domain)});
  bus::Participant participant(config(domain));
  const auto readers = channels<OurReader>(participant);
  std::vector<std::uint64_t> seen(readers.size(), 0);
  const auto end = std::chrono::steady_clock::now() + kLimit;
  while (!std::all_of(seen.begin(), seen.end(), [](std::uint64_t s) { return s == kAll; }) &&
         std::chrono::steady_clock::now() < end) {
    for (std::size_t k = 0; k < readers.size(); ++k) {
      ASSERT_TRUE(readers[k]->read(seen[k]))
          << readers[k]->topic() << ": a sample with other values than were written";
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  for (std::size_t k = 0; k < readers.size(); ++k) EXPECT_EQ(seen[k], kAll) << readers[k]->topic();
  native.close_input();
  EXPECT_TRUE(native.wait_until_end(std::chrono::seconds(5)));
  EXPECT_EQ(native.exit_status(), 0) << native.output();
  EXPECT_EQ(left_in_shared_memory(native.pid(), shared_memory_before_), std::set<std::string>{});
}

TEST_P(ExchangeTest, OurWriterReachesANativeReaderOnEveryTopic) {
  const std::uint32_t domain = domain_of_this_run() + 1;
  ChildProcess native({peer(), "read", std::to_string(domain)});
  bus::Participant participant(config(domain));
  const auto writers = channels<OurWriter>(participant);
  const auto end = std::chrono::steady_clock::now() + kLimit;
  for (std::uint64_t round = 0; native.running() && std::chrono::steady_clock::now() < end; ++round) {
    for (const auto& writer : writers) ASSERT_TRUE(writer->write(round % kSeeds)) << writer->topic();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  native.close_input();
  EXPECT_TRUE(native.wait_until_end(std::chrono::seconds(5)));
  EXPECT_EQ(native.exit_status(), 0) << native.output();
  EXPECT_EQ(left_in_shared_memory(native.pid(), shared_memory_before_), std::set<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(Vendors, ExchangeTest,
                         testing::Combine(testing::Values("fastdds", "cyclonedds"),
                                          testing::Values("fastdds", "cyclonedds")),
                         [](const auto& vendors) {
                           return "native_" + std::string(std::get<0>(vendors.param)) + "_with_our_" +
                                  std::get<1>(vendors.param);
                         });

}  // namespace
}  // namespace eciton::native_peers
