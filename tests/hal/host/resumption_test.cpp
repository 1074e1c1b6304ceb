// A hardware host that was killed: what the next one makes of its checkpoint, before there is a ring.
#include "hal/host/resumption.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <mutex>

#include "core/base/wall_clock.hpp"
#include "core/runtime/checkpoint.hpp"
#include "tests/hal/host/host_bench.hpp"

namespace eciton::hal {
namespace {

constexpr TimePoint killed_at{1000s};

/// A board that answers at once, a hundred times.
class Bench {
 public:
  Bench() : devices(configured(board, airframe)) {
    std::string name = (std::filesystem::temp_directory_path() / "eciton_resumption_XXXXXX").string();
    directory = ::mkdtemp(name.data());
  }
  ~Bench() { std::filesystem::remove_all(directory); }

  std::filesystem::path file() const { return directory / "actuators.checkpoint"; }

  /// As the host that was killed left it: hovering level, alone or in a chain.
  void leave_checkpoint(bool armed, msg::SafeOutput safe_output) {
    SafeOutput output(airframe);
    output.set_attitude(robot::Matrix3::Identity());
    msg::RotorCommand command{.module_id = bench_id, .armed = armed, .safe_output = safe_output};
    const double each_N = airframe.mass_kg * robot::gravity_m_s2 / static_cast<double>(airframe.rotors.size());
    for (std::size_t k = 0; k < airframe.rotors.size(); ++k) command.rotors.push_back({.thrust_N = each_N});
    output.command(command);
    output.note_written(killed_at, armed);
    runtime::StateWriter counting({});
    counting(output);
    std::vector<std::byte> bytes(counting.size());
    runtime::StateWriter writer(bytes);
    writer(output);
    ASSERT_TRUE(runtime::CheckpointFile(file(), SafeOutput::state_version, bytes.size()).save(bytes));
  }

  std::unique_ptr<Resumption> begin(Duration later) {
    return Resumption::begin(file(), airframe, devices, {[this] { return sense(); }, [this] { act(); }},
                             killed_at + later);
  }
  /// Until it has written so often, or five seconds.
  bool acted(int times) {
    const Duration end = monotonic_now() + 5s;
    while (monotonic_now() < end) {
      const std::scoped_lock lock(mutex);
      if (acts >= times) return true;
    }
    return false;
  }
  double thrust_N() {
    double sum = 0;
    for (std::size_t k = 0; k < airframe.rotors.size(); ++k) sum += board.actuators().rotors[k].thrust_N;
    return sum;
  }

  robot::Airframe airframe = robot::legion();
  sim::Board board;
  Devices devices;
  std::filesystem::path directory;
  std::mutex mutex;
  int acts = 0;

 private:
  bool sense() {
    if (sensed == 100) return false;
    readings.stamp = readings.imu.stamp = killed_at + (++sensed) * bench_tick;
    readings.imu.specific_force_M_m_s2 = {0, 0, robot::gravity_m_s2};
    readings.imu_count = static_cast<std::uint64_t>(sensed);
    board.set_sensors(readings);
    return true;
  }
  void act() {
    const std::scoped_lock lock(mutex);
    ++acts;
  }

  sim::SensorFrame readings;
  int sensed = 0;
};

TEST(ResumptionTest, HoldsTheHoverOfAFlightThatWasOnAMomentAgo) {
  for (const auto safe : {msg::SafeOutput::descend, msg::SafeOutput::hold_hover}) {
    Bench bench;
    bench.leave_checkpoint(true, safe);
    const auto resumption = bench.begin(75ms);  // the board held the rotors for so long
    ASSERT_NE(resumption, nullptr);
    ASSERT_TRUE(bench.acted(100));
    const SafeOutput output = resumption->end();
    EXPECT_TRUE(bench.devices.armed);
    EXPECT_TRUE(bench.board.actuators().armed);
    EXPECT_TRUE(output.flies());
    EXPECT_NEAR(bench.thrust_N(), bench.airframe.mass_kg * robot::gravity_m_s2, 0.5);
  }
}

TEST(ResumptionTest, ThrustsMoreWhereItHasFallen) {
  Bench bench;
  bench.leave_checkpoint(true, msg::SafeOutput::descend);
  const auto resumption = bench.begin(275ms);  // 0.2 s of them without rotors: 2 m/s down
  ASSERT_NE(resumption, nullptr);
  ASSERT_TRUE(bench.acted(100));
  resumption->end();
  EXPECT_GT(bench.thrust_N(), 1.1 * bench.airframe.mass_kg * robot::gravity_m_s2);
}

TEST(ResumptionTest, DoesNotStartRotorsThatStoodOrAFlightThatIsOver) {
  Bench standing;
  standing.leave_checkpoint(false, msg::SafeOutput::motors_off);
  EXPECT_EQ(standing.begin(100ms), nullptr);
  Bench over;
  over.leave_checkpoint(true, msg::SafeOutput::descend);
  EXPECT_EQ(over.begin(3s), nullptr);
  EXPECT_EQ(over.begin(-1s), nullptr);  // the clock was set: nothing is known
  Bench fresh;
  EXPECT_EQ(fresh.begin(0s), nullptr);
  for (const Bench* bench : {&standing, &over, &fresh}) EXPECT_FALSE(bench->board.actuators().armed);
}

}  // namespace
}  // namespace eciton::hal
