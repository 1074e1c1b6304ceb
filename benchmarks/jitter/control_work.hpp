// A periodic service that does what control does in flight, and notes how late each of its steps began.
#pragma once

#include <vector>

#include "core/bus/participant.hpp"
#include "core/runtime/service_group.hpp"
#include "services/control/control_service.hpp"

namespace eciton::bench {

class ControlWork final : public runtime::Service {
 public:
  /// `at_most`: steps remembered.
  ControlWork(bus::Participant& ring, std::uint32_t module_id, Duration period, std::size_t at_most);

  std::string_view name() const override { return "control_work"; }
  runtime::Schedule schedule() override { return runtime::every(period_, runtime::Phase::control); }
  void step(TimePoint now) noexcept override;

  /// The entry that knows when a step was due; before the run.
  void watch(const runtime::ServiceGroup::Entry& entry) { entry_ = &entry; }
  /// µs between when a step was due and when it began; the first step is due when it begins.
  const std::vector<double>& late_us() const { return late_us_; }
  /// Whether control flies: otherwise it does less than its work.
  bool flies() const { return flies_; }

 private:
  void fly(TimePoint now) noexcept;

  std::uint32_t module_id_;
  Duration period_;
  control::ControlService control_;
  bus::Writer<msg::ModuleState> state_;
  bus::Writer<msg::ModeRequest> mode_;
  bus::Writer<msg::FlightGoal> goal_;
  bus::Writer<msg::RotorState> rotors_;
  const runtime::ServiceGroup::Entry* entry_ = nullptr;
  std::vector<double> late_us_;
  std::uint64_t steps_ = 0;
  bool flies_ = false;
};

}  // namespace eciton::bench
