// Services made of a schedule and a function, and what tests of executors share.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "core/bus/participant.hpp"
#include "core/runtime/service.hpp"
#include "idl/topics.hpp"

namespace eciton::runtime::testing {

class FakeService final : public Service {
 public:
  FakeService(
      std::string name, Schedule schedule, std::function<void(TimePoint)> body = [](TimePoint) {})
      : name_(std::move(name)), schedule_(schedule), body_(std::move(body)) {}
  std::string_view name() const override { return name_; }
  Schedule schedule() override { return schedule_; }
  void step(TimePoint now) noexcept override { body_(now); }

 private:
  std::string name_;
  Schedule schedule_;
  std::function<void(TimePoint)> body_;
};

/// As estimation does: a state for each IMU sample, stamped as the sample.
class FakeEstimation final : public Service {
 public:
  FakeEstimation(bus::Participant& ring, std::uint32_t module_id)
      : imu_(ring.create_reader(topics::imu)),
        state_(ring.create_writer(topics::module_state)),
        module_id_(module_id) {
    imu_.news_only_of(module_id);
  }
  std::string_view name() const override { return "estimation"; }
  Schedule schedule() override { return on(imu_, 50ms, Phase::estimate); }
  void step(TimePoint) noexcept override {
    ++steps;
    if (const auto imu = imu_.take_newest()) state_.write({.module_id = module_id_, .stamp_ns = imu->value.stamp_ns});
  }
  int steps = 0;

 private:
  bus::Reader<msg::Imu> imu_;
  bus::Writer<msg::ModuleState> state_;
  std::uint32_t module_id_;
};

/// As control does: a rotor command for each state.
class FakeControl final : public Service {
 public:
  FakeControl(bus::Participant& ring, std::uint32_t module_id)
      : state_(ring.create_reader(topics::module_state)),
        rotors_(ring.create_writer(topics::rotor_command)),
        module_id_(module_id) {
    state_.news_only_of(module_id);
  }
  std::string_view name() const override { return "control"; }
  Schedule schedule() override { return on(state_, 50ms, Phase::control); }
  void step(TimePoint) noexcept override {
    ++steps;
    while (const auto state = state_.take()) {
      if (state->value.module_id != module_id_) continue;
      rotors_.write({.module_id = module_id_, .stamp_ns = state->value.stamp_ns});
    }
  }
  TimePoint newest_state() { return state_.trigger().newest_stamp(); }
  int steps = 0;

 private:
  bus::Reader<msg::ModuleState> state_;
  bus::Writer<msg::RotorCommand> rotors_;
  std::uint32_t module_id_;
};

}  // namespace eciton::runtime::testing
