// Checkpoints: what was put is found again; what is damaged, foreign or missing is not taken for a state.
#include "core/runtime/checkpoint.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <thread>

#include "core/base/wall_clock.hpp"
#include "core/robot/trajectory.hpp"

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

/// Keeps a State, under a version.
template <class Kept = State>
class Keeper final : public Service {
 public:
  explicit Keeper(std::uint32_t version, const Kept& kept = {}) : state(kept), version_(version) {}
  std::string_view name() const override { return "keeper"; }
  Schedule schedule() override { return every(10ms, Phase::coordinate); }
  void step(TimePoint) noexcept override {}
  std::uint32_t state_version() const noexcept override { return version_; }
  void save_state(StateWriter& writer) const noexcept override { writer(state); }
  void load_state(StateReader& reader) noexcept override { reader(state); }

  Kept state;

 private:
  std::uint32_t version_;
};

class CheckpointTest : public ::testing::Test {
 protected:
  CheckpointTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "eciton-checkpoint-XXXXXX").string();
    directory_ = ::mkdtemp(pattern.data());
    file_ = directory_ / "control-1";
  }
  ~CheckpointTest() override { std::filesystem::remove_all(directory_); }

  void put_and_end(std::int64_t number, std::uint32_t version = 3) {
    Keeper keeper(version, state_of(number));
    Checkpoint checkpoint(keeper, file_);
    checkpoint.start();
    checkpoint.save();
  }
  std::string bytes() {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& bytes) { std::ofstream(file_, std::ios::binary) << bytes; }
  std::string refusal(std::uint32_t version = 3) {
    Keeper keeper(version);
    const auto loaded = Checkpoint(keeper, file_).load();
    return loaded ? "" : loaded.error().message;
  }

  std::filesystem::path directory_;
  std::filesystem::path file_;
};

TEST_F(CheckpointTest, FindsTheLastStatePut) {
  put_and_end(41);
  put_and_end(42);
  Keeper keeper(3);
  const auto loaded = Checkpoint(keeper, file_).load();
  ASSERT_TRUE(loaded && *loaded);
  EXPECT_EQ(keeper.state.stamp_ns, 42);
  EXPECT_EQ(keeper.state.z_m, 1.5);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_), {}), 1) << "nothing is left beside it";
}

TEST_F(CheckpointTest, StartsAnewWithoutAFile) {
  Keeper keeper(3);
  const auto loaded = Checkpoint(keeper, file_).load();
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
  Keeper<int> narrow(2);
  const auto other = Checkpoint(narrow, file_).load();
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
  Keeper keeper(3);
  Checkpoint checkpoint(keeper, file_, 20ms);
  checkpoint.start();
  const Duration begin = monotonic_now();
  for (int k = 0; k < 200; ++k) {
    keeper.state = state_of(k);
    checkpoint.save();
    std::this_thread::sleep_for(200us);
  }
  const std::uint64_t written = checkpoint.writer()->written();
  const auto most = static_cast<std::uint64_t>((monotonic_now() - begin) / 20ms + 1);
  EXPECT_LE(written, most);
}

TEST_F(CheckpointTest, CountsWhatItCannotWriteAndGoesOn) {
  file_ = directory_ / "missing" / "control-1";
  Keeper keeper(3);
  Checkpoint checkpoint(keeper, file_, 1ms);
  checkpoint.start();
  const Duration until = monotonic_now() + 10s;
  while (checkpoint.writer()->failed() < 2 && monotonic_now() < until) {
    checkpoint.save();
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_GE(checkpoint.writer()->failed(), 2u);
  std::filesystem::create_directory(directory_ / "missing");
  while (checkpoint.writer()->written() == 0 && monotonic_now() < until) {
    checkpoint.save();
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(refusal(), "");
}

TEST(ServiceStateTest, WritesMembersMatricesAndPlainValuesAndReadsThemBack) {
  robot::PoseMotion motion({.p_WM = {1, 2, 3}, .v_WM = {0.1, 0, 0}}, {{2, 2, 3}, robot::exp_so3({0, 0, 1})}, 5,
                           robot::SpeedProfile::quintic, {});
  StateWriter counting({});
  counting(motion, 7);
  EXPECT_FALSE(counting.complete());
  std::vector<std::byte> bytes(counting.size());
  StateWriter writer(bytes);
  writer(motion, 7);
  EXPECT_TRUE(writer.complete());

  robot::PoseMotion other;
  int seven = 0;
  StateReader reader(bytes);
  reader(other);
  EXPECT_FALSE(reader.complete()) << "an int is left";
  reader(seven);
  EXPECT_TRUE(reader.complete());
  EXPECT_EQ(seven, 7);
  for (const double t_s : {0.0, 5.5, 6.0, 100.0}) {
    EXPECT_EQ(other.at(t_s).p_WM, motion.at(t_s).p_WM);
    EXPECT_EQ(other.at(t_s).R_WM, motion.at(t_s).R_WM);
  }
  reader(seven);
  EXPECT_FALSE(reader.complete()) << "there was no more";
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
