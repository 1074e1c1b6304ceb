// A service's faults, each told when the step that raised it is done and, where that is recorded, with the file
// that holds what the service knew and did before.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/bus/participant.hpp"
#include "core/runtime/flight_recorder.hpp"
#include "idl/topics.hpp"

namespace eciton::runtime {

/// A column's words for the values of an enumeration of the contract.
template <class E>
std::vector<std::string_view> words_of() {
  const auto& names = bus::EnumTraits<E>::names;
  return {std::begin(names), std::end(names)};
}

/// NaN of what never came.
inline double age_s(TimePoint now, TimePoint at) noexcept {
  return at == TimePoint{} ? std::numeric_limits<double>::quiet_NaN() : to_s(now - at);
}

/// Fills a row value by value, in the order of its columns; what is over is left out. Real-time safe.
class RowFiller {
 public:
  explicit RowFiller(std::span<double> row) : row_(row) {}

  /// Numbers, enumerators, and what holds numbers one after another: arrays and vectors of maths.
  template <class... Ts>
  void operator()(const Ts&... values) noexcept {
    (put(values), ...);
  }
  std::size_t filled() const { return filled_; }

 private:
  template <class T>
  void put(const T& value) noexcept {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      if (filled_ < row_.size()) row_[filled_++] = static_cast<double>(value);
    } else {
      for (std::size_t k = 0; k < static_cast<std::size_t>(value.size()); ++k) put(value.data()[k]);
    }
  }

  std::span<double> row_;
  std::size_t filled_ = 0;
};

/// One thread. All but its making is real-time safe.
class FaultReporter {
 public:
  /// `service`: by which its faults and files go.
  FaultReporter(bus::Participant& ring, std::uint32_t module_id, std::string_view service,
                const RecorderConfig& config, std::vector<Column> columns)
      : module_id_(module_id), service_(service), fault_(ring.create_writer(topics::fault)) {
    if (!config.directory.empty()) recorder_.emplace(config, module_id, service_, std::move(columns));
  }

  /// Whether rows are kept.
  bool records() const { return recorder_.has_value(); }
  /// The row of this step; only where it records, and once a step.
  RowFiller row(TimePoint now) noexcept { return RowFiller(recorder_->push(now)); }

  /// Within a step: told by tell(), after the step's row.
  void raise(TimePoint now, msg::Severity severity, std::string_view device, std::string_view text) noexcept {
    msg::Fault fault{.module_id = module_id_, .stamp_ns = to_ns(now), .severity = severity};
    fault.service = std::string_view(service_);
    fault.device = device;
    fault.text = text;
    if (!raised_.push_back(fault)) fault_.write(fault);
  }
  /// Last in every step.
  void tell(TimePoint now) noexcept {
    if (raised_.empty()) return;
    // All of one step have one file; it goes by the first.
    FaultRecordName file;
    if (recorder_) file = recorder_->freeze(now, raised_[0].text.view());
    for (msg::Fault& fault : raised_) {
      fault.record = file.view();
      fault_.write(fault);
    }
    raised_.clear();
  }

  const FlightRecorder* recorder() const { return recorder_ ? &*recorder_ : nullptr; }

 private:
  std::uint32_t module_id_;
  std::string service_;
  BoundedVector<msg::Fault, 4> raised_;  // in this step
  std::optional<FlightRecorder> recorder_;
  bus::Writer<msg::Fault> fault_;
};

}  // namespace eciton::runtime
