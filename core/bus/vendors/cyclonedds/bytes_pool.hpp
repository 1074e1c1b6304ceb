// Memory for samples on their way through Cyclone DDS, which counts references to them and frees them from its own
// threads: blocks of a few sizes, reserved when an endpoint is created and kept for reuse.
#pragma once

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace eciton::bus::cyclonedds {

/// A lock with priority inheritance: a real-time step and a vendor's thread of lower priority share it.
class InheritingMutex {
 public:
  InheritingMutex();
  ~InheritingMutex() { pthread_mutex_destroy(&mutex_); }
  InheritingMutex(const InheritingMutex&) = delete;
  InheritingMutex& operator=(const InheritingMutex&) = delete;
  void lock() { pthread_mutex_lock(&mutex_); }
  void unlock() { pthread_mutex_unlock(&mutex_); }

 private:
  pthread_mutex_t mutex_;
};

/// Blocks by size class (powers of two). `acquire` takes from what was reserved; only when that runs out (many events
/// of many keys, samples still held for retransmission) it allocates, up to a bound for the whole process, and keeps
/// it.
class BytesPool {
 public:
  /// Of all blocks together. The largest fleet of the tests stays below 3 MiB.
  static constexpr std::size_t kBytesMax = std::size_t{64} << 20;
  static constexpr std::size_t kSizeMax = std::size_t{1} << 20;

  static BytesPool& instance();

  /// Makes room for `count` more samples of up to `size` bytes at a time; false: over the bound.
  bool reserve(std::size_t size, std::size_t count);
  void unreserve(std::size_t size, std::size_t count);

  /// Real-time safe within the reservation. Null: over the bound.
  void* acquire(std::size_t size);
  static void release(void* block);

  /// Gives free blocks back; called when no domain is left.
  void trim();
  std::size_t bytes() const { return bytes_.load(std::memory_order_relaxed); }

 private:
  struct Block {  // precedes what is handed out, and keeps its alignment
    Block* next;
    std::uint64_t size_class;
  };
  struct SizeClass {
    InheritingMutex mutex;
    Block* free = nullptr;
    std::size_t blocks = 0;    // existing, free or not
    std::size_t reserved = 0;  // asked for by endpoints
  };
  static constexpr std::size_t kSmallestShift = 7;
  static constexpr std::size_t kClasses = 14;  // 128 bytes to 1 MiB
  static std::size_t class_of(std::size_t size);
  static constexpr std::size_t capacity(std::size_t size_class) {
    return std::size_t{1} << (size_class + kSmallestShift);
  }
  Block* allocate(std::size_t size_class);
  void put_back(Block* block);

  std::array<SizeClass, kClasses> classes_;
  std::atomic<std::size_t> bytes_{0};
};

}  // namespace eciton::bus::cyclonedds
