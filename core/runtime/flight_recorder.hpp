// What a service knew and did in its last steps, kept for the case of a fault: frozen by the step that raises it,
// written to a file by a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/config.hpp"
#include "core/bus/waker.hpp"
#include "core/runtime/fault_record.hpp"

namespace eciton::runtime {

struct RecorderConfig {
  std::string directory;     // of the files; it is made when it is needed. Empty: nothing is kept
  std::uint32_t rows = 500;  // steps: 1 s of control's at 500 Hz
  std::uint32_t files = 16;  // of each service; the oldest go

  template <class V>
  void visit_fields(V& v) {
    v("directory", directory);
    v("rows", rows, in_range(1, 10000));
    v("files", files, in_range(1, 1000));
  }
};

class FlightRecorder {
 public:
  /// Before the service is active: it allocates, and starts the thread. The directory is not empty.
  FlightRecorder(const RecorderConfig& config, std::uint32_t module_id, std::string service,
                 std::vector<Column> columns);
  /// After what is frozen is written.
  ~FlightRecorder();
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  /// The row of this step, to be filled in. The step's thread; real-time safe.
  std::span<double> push(TimePoint now) noexcept { return rows_.push(now); }
  /// What was pushed so far is to be written, for this fault; the name of its file in the directory. Empty when the
  /// fault before is still being written: this one is counted, and said in the log and in the next file. The step's
  /// thread; real-time safe: it copies the rows.
  FaultRecordName freeze(TimePoint now, std::string_view fault) noexcept;

  /// Any thread. Files written, and not: the disk is full, the directory not ours.
  std::uint64_t written() const noexcept { return written_.load(); }
  std::uint64_t failed() const noexcept { return failed_.load(); }
  /// Faults that got no file of their own.
  std::uint64_t missed() const noexcept { return missed_.load(); }

 private:
  void run();
  void write_frozen();
  void say_missed();

  RecorderConfig config_;
  std::uint32_t module_id_;
  std::string service_;
  std::vector<Column> columns_;
  RowRing rows_;

  // Of the step's thread while nothing waits to be written, else of the other.
  RowRing frozen_;
  TimePoint frozen_at_{};
  BoundedString<127> fault_;
  std::uint64_t frozen_missed_ = 0;  // until then
  std::atomic<bool> waits_{false};

  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> failed_{0};
  std::atomic<std::uint64_t> missed_{0};
  std::uint64_t missed_noted_ = 0;  // in a file
  std::uint64_t missed_said_ = 0;   // in the log
  std::atomic<bool> ending_{false};
  bus::Waker wake_;
  std::thread thread_;
};

}  // namespace eciton::runtime
