// One frozen ring, and the thread that writes it.
#include "core/runtime/flight_recorder.hpp"

#include <pthread.h>
#include <sched.h>

#include "core/base/log.hpp"

namespace eciton::runtime {

FlightRecorder::FlightRecorder(const RecorderConfig& config, std::uint32_t module_id, std::string service,
                               std::vector<Column> columns)
    : config_(config),
      module_id_(module_id),
      service_(std::move(service)),
      columns_(std::move(columns)),
      rows_(columns_.size(), config.rows),
      frozen_(columns_.size(), config.rows),
      thread_([this] { run(); }) {}

FlightRecorder::~FlightRecorder() {
  ending_ = true;
  wake_.signal();
  thread_.join();
}

FaultRecordName FlightRecorder::freeze(TimePoint now, std::string_view fault) noexcept {
  if (waits_.load(std::memory_order_acquire)) {
    ++missed_;
    wake_.signal();
    return {};
  }
  frozen_.copy(rows_);
  frozen_at_ = now;
  fault_ = fault;
  frozen_missed_ = missed_.load(std::memory_order_relaxed);
  waits_.store(true, std::memory_order_release);
  wake_.signal();
  return fault_record_name(service_, now);
}

void FlightRecorder::run() {
  // Whoever made this thread may be real-time already.
  const sched_param parameters{.sched_priority = 0};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &parameters);
  while (!ending_) {
    wake_.wait(std::chrono::hours(1));
    if (waits_.load(std::memory_order_acquire)) write_frozen();
    say_missed();
  }
  if (waits_.load(std::memory_order_acquire)) write_frozen();
}

void FlightRecorder::write_frozen() {
  const std::filesystem::path directory = config_.directory;
  const std::filesystem::path file = directory / fault_record_name(service_, frozen_at_).view();
  std::error_code failed;
  std::filesystem::create_directories(directory, failed);  // if it fails, so does what follows, and says why
  remove_old_fault_records(directory, service_, config_.files - 1);
  const Status written = write_fault_record(file,
                                            {.module_id = module_id_,
                                             .service = service_,
                                             .at = frozen_at_,
                                             .text = fault_.view(),
                                             .missed = frozen_missed_ - missed_noted_},
                                            columns_, frozen_);
  const std::size_t steps = frozen_.size();
  const std::string fault(fault_.view());
  if (written) missed_noted_ = frozen_missed_;
  ++(written ? written_ : failed_);
  waits_.store(false, std::memory_order_release);
  if (written) {
    spdlog::warn("{}: {}; the {} steps before it are in {}", service_, fault, steps, file.string());
  } else if (failed_ == 1) {
    // Once: a full disk would fill the log too.
    spdlog::error("{}: {}; {}; further ones are counted", service_, fault, written.error().message);
  }
}

void FlightRecorder::say_missed() {
  const std::uint64_t missed = missed_.load();
  if (missed == missed_said_) return;
  spdlog::warn("{}: {} faults came while another was being written: they get no file of their own", service_,
               missed - missed_said_);
  missed_said_ = missed;
}

}  // namespace eciton::runtime
