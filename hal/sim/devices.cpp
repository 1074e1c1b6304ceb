// The simulated devices: between the hal's interfaces and a board.
#include "hal/sim/devices.hpp"

#include <algorithm>
#include <string>

namespace eciton::hal::sim {
namespace {

constexpr double battery_nominal_V = 24.2;
/// Of each new reading, at 500 Hz: smoothed over 0.1 s, fast enough for the sag of a climb, slow enough for its
/// noise.
constexpr double battery_share = 0.02;

/// Copies a frame's readings out, once per frame received.
template <class Reading, std::size_t Max>
Io read_once(const Board& board, const Lifecycle& lifecycle, const std::array<Reading, Max>& from, std::size_t count,
             std::span<Reading> to, std::uint64_t& frames_read) {
  if (!lifecycle.readable() || to.size() != count) return Io::error;
  if (board.frames_received() == frames_read) return Io::nothing_new;
  frames_read = board.frames_received();
  std::copy_n(from.begin(), count, to.begin());
  return Io::ok;
}

Status fits(const char* device, std::size_t count, std::size_t max) {
  if (count <= max) return ok();
  return Error{std::string("simulated ") + device + ": " + std::to_string(count) + " of them; a frame holds " +
               std::to_string(max)};
}

}  // namespace

Status Lifecycle::activate(const char* device) {
  if (state_ == State::unconfigured) {
    return Error{std::string("simulated ") + device + ": activated before it was configured"};
  }
  state_ = State::active;
  return ok();
}

Status SimRotorBus::configure() {
  if (Status status = fits("rotor bus", rotors_, max_rotors); !status) return status;
  lifecycle_.configure();
  return ok();
}

Status SimRotorBus::activate() {
  if (Status status = lifecycle_.activate("rotor bus"); !status) return status;
  board_.actuators().rotors.fill({});
  board_.actuators().throttle_percent.fill(0);
  board_.actuators().armed = true;
  follow_battery(1);
  return ok();
}

void SimRotorBus::deactivate() noexcept {
  lifecycle_.deactivate();
  board_.actuators().armed = false;
  board_.actuators().rotors.fill({});
  board_.actuators().throttle_percent.fill(0);
}

Io SimRotorBus::write(std::span<const RotorSetpoint> commands) noexcept {
  if (!lifecycle_.active() || commands.size() != rotors_) return Io::error;
  std::copy(commands.begin(), commands.end(), board_.actuators().rotors.begin());
  if (compensates_) follow_battery(battery_share);
  for (std::size_t k = 0; k < rotors_; ++k) {
    board_.actuators().throttle_percent[k] =
        map_.percent(commands[k].thrust_N, battery_V_ > 0 ? battery_V_ : battery_nominal_V);
  }
  return Io::ok;
}

void SimRotorBus::follow_battery(double share) {
  const double read_V = board_.sensors().rotors[0].battery_V;
  if (!(read_V > 0)) return;
  battery_V_ = battery_V_ > 0 ? battery_V_ + share * (read_V - battery_V_) : read_V;
}

Io SimRotorBus::read(std::span<RotorReading> states) noexcept {
  return read_once(board_, lifecycle_, board_.sensors().rotors, rotors_, states, frames_read_);
}

Status SimJointBus::configure() {
  if (Status status = fits("joint bus", joints_, max_joints); !status) return status;
  lifecycle_.configure();
  return ok();
}

Status SimJointBus::activate() {
  if (Status status = lifecycle_.activate("joint bus"); !status) return status;
  for (std::size_t k = 0; k < joints_; ++k) {
    board_.actuators().joints[k] = {.position_rad = board_.sensors().joints[k].position_rad, .velocity_rad_s = 0};
  }
  board_.actuators().joints_powered = true;
  return ok();
}

void SimJointBus::deactivate() noexcept {
  lifecycle_.deactivate();
  board_.actuators().joints_powered = false;
}

Io SimJointBus::write(std::span<const JointSetpoint> commands) noexcept {
  if (!lifecycle_.active() || commands.size() != joints_) return Io::error;
  std::copy(commands.begin(), commands.end(), board_.actuators().joints.begin());
  return Io::ok;
}

Io SimJointBus::read(std::span<JointReading> states) noexcept {
  return read_once(board_, lifecycle_, board_.sensors().joints, joints_, states, frames_read_);
}

Status SimLatch::configure() {
  if (port_ >= max_ports) return Error{"simulated latch of port " + std::to_string(port_) + ": ports are 0 to 3"};
  lifecycle_.configure();
  return ok();
}

Status SimLatch::activate() { return lifecycle_.activate("latch"); }

void SimLatch::deactivate() noexcept {
  lifecycle_.deactivate();
  board_.actuators().latches[port_] = LatchCommand::hold;
}

Io SimLatch::write(bool engage) noexcept {
  if (!lifecycle_.active()) return Io::error;
  board_.actuators().latches[port_] = engage ? LatchCommand::engage : LatchCommand::release;
  return Io::ok;
}

Io SimLatch::read(LatchReading& reading) noexcept {
  if (!lifecycle_.readable()) return Io::error;
  if (board_.frames_received() == frames_read_) return Io::nothing_new;
  frames_read_ = board_.frames_received();
  reading = board_.sensors().latches[port_];
  return Io::ok;
}

Status SimImu::configure() {
  lifecycle_.configure();
  return ok();
}
Status SimImu::activate() { return lifecycle_.activate("IMU"); }
void SimImu::deactivate() noexcept { lifecycle_.deactivate(); }

Io SimImu::read(ImuReading& reading) noexcept {
  if (!lifecycle_.readable()) return Io::error;
  const SensorFrame& frame = board_.sensors();
  if (frame.imu_count == samples_read_) return Io::nothing_new;
  samples_read_ = frame.imu_count;
  reading = frame.imu;
  return Io::ok;
}

Status SimPoseSource::configure() {
  lifecycle_.configure();
  return ok();
}
Status SimPoseSource::activate() { return lifecycle_.activate("pose source"); }
void SimPoseSource::deactivate() noexcept { lifecycle_.deactivate(); }

Io SimPoseSource::read(PoseReading& reading) noexcept {
  if (!lifecycle_.readable()) return Io::error;
  const SensorFrame& frame = board_.sensors();
  if (frame.pose_count == samples_read_) return Io::nothing_new;
  samples_read_ = frame.pose_count;
  reading = frame.pose;
  return Io::ok;
}

}  // namespace eciton::hal::sim
