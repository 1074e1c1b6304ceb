// Checkpoints: what was put is found again; what is damaged, foreign or missing is not taken for a state.
#include "core/runtime/checkpoint.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <thread>

#include "core/base/wall_clock.hpp"

namespace eciton::runtime {
namespace {

struct State {
  std::int64_t stamp_ns = 0;
  double z_m = 0;
  std::array<std::int64_t, 30> copies{};
};

State state_of(std::int64_t number) {
  State state{.stamp_ns = number, .z_m = 1.5};
  state.copies.fill(number);
  return state;
}

class CheckpointTest : public ::testing::Test {
 protected:
  CheckpointTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "eciton-checkpoint-XXXXXX").string();
    directory_ = ::mkdtemp(pattern.data());
    file_ = directory_ / "control-1";
  }
  ~CheckpointTest() override { std::filesystem::remove_all(directory_); }

  void put_and_end(std::int64_t number, std::uint32_t version = 3) {
    Checkpoint<State> checkpoint(file_, version);
    checkpoint.start();
    checkpoint.put(state_of(number));
  }
  std::string bytes() {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& bytes) { std::ofstream(file_, std::ios::binary) << bytes; }
  std::string refusal(std::uint32_t version = 3) {
    const auto loaded = Checkpoint<State>(file_, version).load();
    return loaded ? "" : loaded.error().message;
  }

  std::filesystem::path directory_;
  std::filesystem::path file_;
};

TEST_F(CheckpointTest, FindsTheLastStatePut) {
  put_and_end(41);
  put_and_end(42);
  const auto loaded = Checkpoint<State>(file_, 3).load();
  ASSERT_TRUE(loaded && *loaded);
  EXPECT_EQ((*loaded)->stamp_ns, 42);
  EXPECT_EQ((*loaded)->z_m, 1.5);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_), {}), 1) << "nothing is left beside it";
}

TEST_F(CheckpointTest, StartsAnewWithoutAFile) {
  const auto loaded = Checkpoint<State>(file_, 3).load();
  ASSERT_TRUE(loaded);
  EXPECT_FALSE(*loaded);
}

TEST_F(CheckpointTest, RefusesAChangedByteAndAnotherLength) {
  put_and_end(42);
  const std::string good = bytes();
  ASSERT_EQ(good.size(), 24 + sizeof(State));
  for (std::size_t k = 0; k < good.size(); k += k < 24 ? 1 : 11) {
    std::string bad = good;
    bad[k] = static_cast<char>(bad[k] ^ 0x10);
    write(bad);
    EXPECT_NE(refusal(), "") << "byte " << k;
    write(good.substr(0, k));
    EXPECT_NE(refusal(), "") << "cut to " << k;
  }
  write(good + "x");
  EXPECT_NE(refusal(), "");
  write(good);
  EXPECT_EQ(refusal(), "");
}

TEST_F(CheckpointTest, NamesAnotherVersionAndAnotherSize) {
  put_and_end(42, 2);
  EXPECT_NE(refusal().find("version 2, this program writes 3"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find("control-1"), std::string::npos);
  const auto other = Checkpoint<int>(file_, 2).load();
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("256 bytes, this program's 4"), std::string::npos) << other.error().message;
}

TEST_F(CheckpointTest, ChecksumIsTheOneOfZlib) {
  // CRC-32 of "123456789" is 0xcbf43926, the check value of every catalogue.
  CheckpointFile file(file_, 1, 9);
  ASSERT_TRUE(file.save(std::as_bytes(std::span("123456789", 9))));
  EXPECT_EQ(bytes().substr(12, 4), "\x26\x39\xf4\xcb");
}

TEST_F(CheckpointTest, WritesSeldomHoweverOftenItIsPut) {
  Checkpoint<State> checkpoint(file_, 3, 20ms);
  checkpoint.start();
  const Duration begin = monotonic_now();
  for (int k = 0; k < 200; ++k) {
    checkpoint.put(state_of(k));
    std::this_thread::sleep_for(200us);
  }
  const std::uint64_t written = checkpoint.writer()->written();
  const auto most = static_cast<std::uint64_t>((monotonic_now() - begin) / 20ms + 1);
  EXPECT_LE(written, most);
}

TEST_F(CheckpointTest, CountsWhatItCannotWriteAndGoesOn) {
  file_ = directory_ / "missing" / "control-1";
  Checkpoint<State> checkpoint(file_, 3, 1ms);
  checkpoint.start();
  const Duration until = monotonic_now() + 10s;
  while (checkpoint.writer()->failed() < 2 && monotonic_now() < until) {
    checkpoint.put(state_of(1));
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_GE(checkpoint.writer()->failed(), 2u);
  std::filesystem::create_directory(directory_ / "missing");
  while (checkpoint.writer()->written() == 0 && monotonic_now() < until) {
    checkpoint.put(state_of(2));
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(refusal(), "");
}

TEST(LatestBytesTest, NeverGivesAMixtureOfTwoStates) {
  LatestBytes latest(sizeof(State));
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::int64_t k = 1; k <= 20'000; ++k) {
      const State state = state_of(k);
      latest.put(std::as_bytes(std::span(&state, 1)));
    }
    done = true;
  });
  std::int64_t newest = 0;
  for (bool last = false; !last;) {
    last = done;
    const auto bytes = latest.take();
    if (!bytes) continue;
    State state;
    std::memcpy(&state, bytes->data(), sizeof state);
    ASSERT_GT(state.stamp_ns, newest) << "each once, in order";
    newest = state.stamp_ns;
    for (const std::int64_t copy : state.copies) ASSERT_EQ(copy, newest);
  }
  writer.join();
  EXPECT_EQ(newest, 20'000);
}

}  // namespace
}  // namespace eciton::runtime
