// What a program composes its services with: made for one pace or another, the services do not notice.
#pragma once

#include "core/runtime/service_group.hpp"
#include "core/runtime/stop_signal.hpp"

namespace eciton::runtime {

class Executor {
 public:
  /// `participants`: all that the services use, sharing one waker, the one on the module ring first.
  Executor(const ExecutorConfig& config, std::vector<bus::Participant*> participants, ServiceGroup::Pacing pacing)
      : group_(config, std::move(participants), pacing) {}
  virtual ~Executor() = default;

  /// Before run. The service outlives the executor. Throws BadInput on a bad schedule.
  void add(Service& service) { group_.add(service); }

  /// Steps the services on the calling thread until told to stop.
  virtual void run(const StopFlag& stop) = 0;

  /// As ServiceGroup::find_idle: for a watchdog, from when all are added.
  std::string_view find_idle() noexcept { return group_.find_idle(); }

  const ServiceGroup& group() const { return group_; }

 protected:
  ServiceGroup group_;
};

}  // namespace eciton::runtime
