// An expected failure: Result<T> holds a value or an Error whose message names the thing, where it
// stands and what would be right. "Nothing yet" is std::optional; a broken assumption is a contract check.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace eciton {

struct Error {
  std::string message;
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

struct Done {};
using Status = Result<Done>;
inline Status ok() { return Done{}; }

/// What a program ends with when its input is wrong: prints the message, exit status 2.
struct BadInput {
  Error error;
};

/// For start-up code: the value, or BadInput thrown to main.
template <class T>
T value_or_throw(Result<T> result) {
  if (!result) throw BadInput{result.error()};
  return std::move(result).value();
}
inline void ok_or_throw(const Status& status) {
  if (!status) throw BadInput{status.error()};
}

}  // namespace eciton
