// Where broken contracts end up.
#include "core/base/contract.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace eciton {
namespace {

void abort_process(const Violation& v) noexcept {
  std::fprintf(stderr, "%s:%d: contract broken: %s (%s)\n", v.file, v.line, v.message, v.condition);
  std::abort();
}

std::atomic<ViolationHandler> current_handler{&abort_process};

}  // namespace

ViolationHandler set_violation_handler(ViolationHandler handler) noexcept {
  return current_handler.exchange(handler != nullptr ? handler : &abort_process);
}

void report_violation(const Violation& violation) noexcept { current_handler.load()(violation); }

}  // namespace eciton
