// A hardware host on a bench: its two services on a simulated ring in virtual time, the simulated devices of a
// LEGION module on a board without a world, and the ring's other side.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "hal/host/act_service.hpp"
#include "hal/host/sense_service.hpp"
#include "hal/sim/make_devices.hpp"

namespace eciton::hal {

inline constexpr std::uint32_t bench_domain = 13, bench_id = 3, other_id = 4;
inline constexpr Duration bench_tick = std::chrono::milliseconds(2);

inline Devices configured(sim::Board& board, const robot::Airframe& airframe) {
  Devices devices = sim::make_devices(board, airframe);
  devices.for_each([](Device& device) { ok_or_throw(device.configure()); });
  ok_or_throw(devices.joints->activate());
  for (auto& latch : devices.latches) ok_or_throw(latch->activate());
  return devices;
}

/// Level, at rest, 1 g.
class HostBench {
 public:
  HostBench()
      : network_(fresh_network()),
        devices(configured(board, airframe)),
        ring(participant("hardware")),
        sense(ring, {.module_id = bench_id}, devices),
        act(ring, {.module_id = bench_id}, airframe, devices),
        services(participant("services")) {
    readings.imu.specific_force_M_m_s2 = {0, 0, robot::gravity_m_s2};
  }

  /// One tick: new readings, sense, act; what was written before it arrives first.
  void tick() {
    now += bench_tick;
    readings.stamp = readings.imu.stamp = now;
    ++readings.imu_count;
    board.set_sensors(readings);
    network_.advance(now);
    ring.set_now(now);
    services.set_now(now);
    sense.step(now);
    act.step(now);
    network_.advance(now);
    while (const auto fault = faults_heard_.take()) faults.emplace_back(fault->value.text.view());
    while (const auto event = events_heard_.take())
      events.emplace_back(event->value.from.view(), event->value.to.view());
  }
  void tick_for(Duration span) {
    for (const TimePoint end = now + span; now < end;) tick();
  }

  /// An armed command with these thrusts, gimbals at zero.
  static msg::RotorCommand command(std::vector<double> thrusts_N) {
    msg::RotorCommand out{.module_id = bench_id, .armed = true, .safe_output = msg::SafeOutput::descend};
    for (const double thrust_N : thrusts_N) out.rotors.push_back({.thrust_N = thrust_N});
    return out;
  }
  /// Stamped now, and acted on in a tick.
  void send(msg::RotorCommand out) {
    out.stamp_ns = to_ns(now);
    rotor_command.write(out);
    tick();
  }

  const sim::ActuatorFrame& out() const { return board.actuators(); }
  std::vector<double> thrusts_N() const {
    std::vector<double> all;
    for (std::size_t k = 0; k < airframe.rotors.size(); ++k) all.push_back(out().rotors[k].thrust_N);
    return all;
  }
  /// What the rotors make, by turning each thrust about the outer and then the inner gimbal's axis.
  robot::Wrench wrench_B() const {
    robot::Wrench sum;
    for (std::size_t k = 0; k < airframe.rotors.size(); ++k) {
      const RotorSetpoint& set = out().rotors[k];
      const robot::Vector3 thrust = Eigen::AngleAxisd(set.gimbal_rad[0], robot::Vector3::UnitX()) *
                                    Eigen::AngleAxisd(set.gimbal_rad[1], robot::Vector3::UnitY()) *
                                    robot::Vector3(0, 0, set.thrust_N);
      sum.force += thrust;
      sum.moment += airframe.rotors[k].p_BR_m.cross(thrust) + airframe.rotors[k].drag_ratio_m * thrust;
    }
    return sum;
  }
  double weight_N() const { return airframe.mass_kg * robot::gravity_m_s2; }

 private:
  static bus::sim_network::Network& fresh_network() {
    bus::sim_network::Network::reset_all();
    auto& network = bus::sim_network::Network::of(bench_domain);
    network.configure(1, bus::sim_network::Pacing::virtual_time);
    return network;
  }
  static bus::ParticipantConfig participant(const std::string& name) {
    return {.vendor = "sim_network", .domain = bench_domain, .name = name, .network_interface = "lo", .peers = {}};
  }

  bus::sim_network::Network& network_;

 public:
  TimePoint now{1000s};
  robot::Airframe airframe = robot::legion();
  sim::Board board;
  sim::SensorFrame readings;
  Devices devices;
  bus::Participant ring;
  SenseService sense;
  ActService act;
  bus::Participant services;
  bus::Writer<msg::RotorCommand> rotor_command = services.create_writer(topics::rotor_command);
  bus::Writer<msg::JointCommand> joint_command = services.create_writer(topics::joint_command);
  bus::Writer<msg::LatchCommand> latch_command = services.create_writer(topics::latch_command);
  bus::Writer<msg::ModuleState> module_state = services.create_writer(topics::module_state);
  std::vector<std::string> faults;                          // so far
  std::vector<std::pair<std::string, std::string>> events;  // from, to

 private:
  bus::Reader<msg::Fault> faults_heard_ = services.create_reader(topics::fault);
  bus::Reader<msg::Event> events_heard_ = services.create_reader(topics::event);
};

}  // namespace eciton::hal
