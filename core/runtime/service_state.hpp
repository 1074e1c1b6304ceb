// What a service goes on with after its process died, as bytes: plain values one after another, in bounded memory.
// A class whose members are kept has `template <class Self, class V> static void visit_state(Self&, V&)`.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace eciton::runtime {

namespace detail {

template <class T, class V>
concept VisitsState = requires(T& value, V& visitor) {
  std::remove_cv_t<T>::visit_state(value, visitor);
};
/// A matrix of fixed size, whose elements lie together in itself.
template <class T>
concept FixedMatrix = !std::is_trivially_copyable_v<T> && (std::remove_cv_t<T>::SizeAtCompileTime > 0) &&
                      std::is_trivially_copyable_v<typename T::Scalar>;

}  // namespace detail

/// Counts all bytes, keeps those that fit. Real-time safe.
class StateWriter {
 public:
  explicit StateWriter(std::span<std::byte> out) : out_(out) {}

  template <class... Ts>
  void operator()(const Ts&... values) noexcept {
    (write(values), ...);
  }
  std::size_t size() const { return size_; }
  bool complete() const { return size_ <= out_.size(); }

 private:
  template <class T>
  void write(const T& value) noexcept {
    if constexpr (detail::VisitsState<const T, StateWriter>) {
      T::visit_state(value, *this);
    } else if constexpr (detail::FixedMatrix<T>) {
      append(value.data(), sizeof(typename T::Scalar) * static_cast<std::size_t>(value.size()));
    } else {
      static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
      append(&value, sizeof value);
    }
  }
  void append(const void* from, std::size_t bytes) noexcept {
    if (size_ + bytes <= out_.size()) std::memcpy(out_.data() + size_, from, bytes);
    size_ += bytes;
  }

  std::span<std::byte> out_;
  std::size_t size_ = 0;
};

/// Of bytes that a writer of the same values made.
class StateReader {
 public:
  explicit StateReader(std::span<const std::byte> in) : in_(in) {}

  template <class... Ts>
  void operator()(Ts&... values) noexcept {
    (read(values), ...);
  }
  /// All was there and nothing is left: writer and reader were of one mind.
  bool complete() const { return !short_ && in_.empty(); }

 private:
  template <class T>
  void read(T& value) noexcept {
    if constexpr (detail::VisitsState<T, StateReader>) {
      T::visit_state(value, *this);
    } else if constexpr (detail::FixedMatrix<T>) {
      take(value.data(), sizeof(typename T::Scalar) * static_cast<std::size_t>(value.size()));
    } else {
      static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
      take(&value, sizeof value);
    }
  }
  void take(void* to, std::size_t bytes) noexcept {
    if (bytes > in_.size()) {
      short_ = true;
      return;
    }
    std::memcpy(to, in_.data(), bytes);
    in_ = in_.subspan(bytes);
  }

  std::span<const std::byte> in_;
  bool short_ = false;
};

}  // namespace eciton::runtime
