// Load, power, fly on.
#include "hal/host/resumption.hpp"

#include <algorithm>

#include "core/base/log.hpp"
#include "core/runtime/checkpoint.hpp"

namespace eciton::hal {
namespace {

// Of what lies between the last output known of and now, rotors were held by the board for so long, and it is a
// checkpoint's age more on the average.
constexpr Duration held_by_the_board = std::chrono::milliseconds(75);

}  // namespace

std::unique_ptr<Resumption> Resumption::begin(const std::filesystem::path& checkpoint,
                                              const robot::Airframe& airframe, Devices& devices, BoardAccess board,
                                              TimePoint now) {
  SafeOutput output(airframe);
  const auto loaded = runtime::load_state(checkpoint, SafeOutput::state_version, output);
  if (!loaded) spdlog::warn("{}", loaded.error().message);
  if (!loaded || !*loaded || !output.armed()) return nullptr;
  const Duration away = now - output.written_at();
  if (away < Duration::zero() || away > runtime::resume_within) return nullptr;
  if (const Status powered = devices.rotors->activate(); !powered) {
    spdlog::error("the flight cannot go on: {}", powered.error().message);
    return nullptr;
  }
  devices.armed = true;
  output.resume(std::max(0.0, to_s(away - held_by_the_board)));
  spdlog::warn("back in flight after {:.0f} ms: it holds its hover until commands come", 1e3 * to_s(away));
  return std::unique_ptr<Resumption>(new Resumption(std::move(output), devices, std::move(board)));
}

Resumption::Resumption(SafeOutput output, Devices& devices, BoardAccess board)
    : output_(std::move(output)), devices_(devices), board_(std::move(board)), thread_([this] { fly(); }) {}

Resumption::~Resumption() { end(); }

SafeOutput Resumption::end() {
  ending_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
  return output_;
}

void Resumption::fly() {
  TimePoint last{};
  while (!ending_.load(std::memory_order_relaxed)) {
    ImuReading imu;
    if (!board_.wait_sensors() || devices_.imu->read(imu) != Io::ok) continue;
    output_.hear_imu(imu.stamp, robot::vector(imu.w_WM_M_rad_s), robot::vector(imu.specific_force_M_m_s2));
    const double dt_s = last == TimePoint{} ? 0 : std::clamp(to_s(imu.stamp - last), 0.0, 0.02);
    last = imu.stamp;
    const std::span<const RotorSetpoint> setpoints = output_.update(dt_s);
    if (setpoints.empty()) devices_.rotors->deactivate();
    devices_.armed = !setpoints.empty();
    if (devices_.armed) devices_.rotors->write(setpoints);
    board_.act();
  }
}

}  // namespace eciton::hal
