// A command that goes on in the background once it has started well; its caller waits for that.
#pragma once

#include <sys/types.h>

#include <string>

namespace eciton::deploy {

class Detached {
 public:
  /// Nothing is detached; the reports do nothing.
  Detached() = default;
  /// Goes on in two processes; the child is in a session of its own. Before any thread is made.
  static Detached fork();
  Detached(Detached&& other) noexcept;
  Detached& operator=(Detached&&) = delete;
  ~Detached();

  bool is_parent() const { return child_ > 0; }
  /// The parent's exit status: 0 when the child has started, 2 when it says why not.
  int wait_for_start();

  /// The child's; what it prints goes nowhere afterwards.
  void report_started();
  void report_failure(const std::string& message);

 private:
  pid_t child_ = 0;
  int pipe_ = -1;
};

}  // namespace eciton::deploy
