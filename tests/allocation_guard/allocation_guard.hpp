// Proves that a stretch of code leaves the heap alone: counts what the current thread allocates and frees
// while the guard lives, apart for Eciton's own code and for the DDS vendors' libraries.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace eciton::testing {

/// One at a time per thread:
///   { AllocationGuard guard; service.step(now); EXPECT_EQ(guard.framework(), 0u) << guard.describe(); }
/// A use of the heap belongs to the innermost caller that is Eciton's (the program itself or a libeciton_*)
/// or a vendor's; what lies between, as the C++ library, belongs to its caller.
class AllocationGuard {
 public:
  AllocationGuard();
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// False under the sanitizers, which bring a heap of their own: skip the test.
  static bool available();

  std::uint64_t framework() const { return framework_; }
  std::uint64_t vendor() const { return vendor_; }
  /// Who used the heap first in Eciton's code, frame by frame, as addr2line takes it. Ends the counting.
  std::string describe();

  /// From the heap: the calling thread asked for or gave back memory, its caller being at `caller`.
  static void record(const void* caller) noexcept;

 private:
  enum class Owner : std::uint8_t { framework, vendor };
  struct Library {
    std::uintptr_t begin, end;
    Owner owner;
  };
  static constexpr int frames_max = 32;

  void list_libraries();
  const Library* find(const void* address) const;
  void count(const void* caller) noexcept;

  std::array<Library, 64> libraries_{};
  std::size_t library_count_ = 0;
  std::uint64_t framework_ = 0;
  std::uint64_t vendor_ = 0;
  std::array<void*, frames_max> first_{};
  int first_size_ = 0;
};

}  // namespace eciton::testing
