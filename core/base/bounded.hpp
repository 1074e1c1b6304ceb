// Strings and sequences of bounded length inside the object: trivially copyable, never allocating.
// What does not fit is cut off by `assign` and refused by `push_back`.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace eciton {

template <std::size_t Bound>
class BoundedString {
 public:
  constexpr BoundedString() = default;
  constexpr BoundedString(std::string_view text) { assign(text); }
  constexpr BoundedString(const char* text) { assign(text); }

  static constexpr std::size_t bound() { return Bound; }
  /// Takes the first `Bound` characters; returns whether all fitted.
  constexpr bool assign(std::string_view text) {
    size_ = static_cast<std::uint32_t>(std::min(text.size(), Bound));
    std::copy_n(text.begin(), size_, data_.begin());
    std::fill(data_.begin() + size_, data_.end(), '\0');
    return size_ == text.size();
  }
  constexpr std::string_view view() const { return {data_.data(), size_}; }
  constexpr operator std::string_view() const { return view(); }
  constexpr const char* c_str() const { return data_.data(); }
  constexpr std::size_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr bool operator==(const BoundedString& other) const { return view() == other.view(); }

 private:
  std::uint32_t size_ = 0;
  std::array<char, Bound + 1> data_{};
};

template <class T, std::size_t Bound>
class BoundedVector {
 public:
  using value_type = T;
  static constexpr std::size_t bound() { return Bound; }

  constexpr std::size_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr bool full() const { return size_ == Bound; }
  constexpr void clear() { resize(0); }
  /// New elements are value-initialised; a size over the bound is cut to it. Returns whether it fitted.
  constexpr bool resize(std::size_t size) {
    const bool fits = size <= Bound;
    const auto kept = static_cast<std::uint32_t>(fits ? size : Bound);
    for (std::size_t k = kept; k < size_; ++k) data_[k] = T{};
    size_ = kept;
    return fits;
  }
  constexpr bool push_back(const T& value) {
    if (full()) return false;
    data_[size_++] = value;
    return true;
  }
  constexpr T& operator[](std::size_t k) { return data_[k]; }
  constexpr const T& operator[](std::size_t k) const { return data_[k]; }
  constexpr T& back() { return data_[size_ - 1]; }
  constexpr const T& back() const { return data_[size_ - 1]; }
  constexpr T* data() { return data_.data(); }
  constexpr const T* data() const { return data_.data(); }
  constexpr T* begin() { return data(); }
  constexpr T* end() { return data() + size_; }
  constexpr const T* begin() const { return data(); }
  constexpr const T* end() const { return data() + size_; }
  constexpr bool operator==(const BoundedVector& other) const {
    return std::equal(begin(), end(), other.begin(), other.end());
  }

 private:
  std::uint32_t size_ = 0;
  std::array<T, Bound> data_{};
};

}  // namespace eciton
