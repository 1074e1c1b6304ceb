// Contract checks: a broken assumption of the program itself, on in release. On the ground it ends the
// process; a service in the air installs a handler that falls to a safe output instead.
#pragma once

namespace eciton {

struct Violation {
  const char* condition;
  const char* message;
  const char* file;
  int line;
};

using ViolationHandler = void (*)(const Violation&) noexcept;

/// Installs the handler for this process and returns the one before. The default prints and aborts.
/// A handler may return: the check then continues, so it must have led to a safe output by itself.
ViolationHandler set_violation_handler(ViolationHandler handler) noexcept;

void report_violation(const Violation& violation) noexcept;

}  // namespace eciton

#define ECITON_EXPECT(condition, message)                                    \
  do {                                                                       \
    if (!(condition)) [[unlikely]]                                           \
      ::eciton::report_violation({#condition, message, __FILE__, __LINE__}); \
  } while (false)
