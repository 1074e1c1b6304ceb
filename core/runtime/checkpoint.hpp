// A service's small state in a file of the runtime directory, so that it goes on where it was after its process
// died. The step only hands the state over; a thread of its own writes it.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "core/bus/waker.hpp"
#include "core/runtime/service.hpp"

namespace eciton::runtime {

/// The file of a checkpoint: a header with version, size and checksum, then the bytes. Replaced whole, by
/// renaming, so that a reader sees the old one or the new one.
class CheckpointFile {
 public:
  CheckpointFile(std::filesystem::path file, std::uint32_t version, std::size_t size);

  Status save(std::span<const std::byte> state) const;
  /// True: filled in. False: there is no file. An error: a file of another version or size, or a damaged one.
  Result<bool> load(std::span<std::byte> state) const;
  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
  std::uint32_t version_;
  std::size_t size_;
};

/// Where the service of this name finds and leaves its state.
inline std::filesystem::path checkpoint_file(const std::filesystem::path& directory, std::string_view service) {
  return directory / (std::string(service) + ".checkpoint");
}

/// The state that a service of this version left, into the same values: for whoever cannot wait for the service.
/// As CheckpointFile::load.
template <class State>
Result<bool> load_state(const std::filesystem::path& file, std::uint32_t version, State& state) {
  StateWriter counting({});
  counting(state);
  std::vector<std::byte> bytes(counting.size());
  const auto loaded = CheckpointFile(file, version, bytes.size()).load(bytes);
  if (loaded && *loaded) {
    StateReader reader(bytes);
    reader(state);
  }
  return loaded;
}

/// The bytes last put, from one thread to one other, neither waiting: three buffers, of which each thread has one
/// and the third changes hands.
class LatestBytes {
 public:
  explicit LatestBytes(std::size_t size);

  /// One thread; real-time safe.
  void put(std::span<const std::byte> bytes) noexcept;
  /// Another thread: what was put since the last call; nothing, if nothing was. Valid until the next call.
  std::optional<std::span<const std::byte>> take() noexcept;

 private:
  static constexpr std::uint32_t fresh = 4;  // beside the number of the buffer in the middle

  std::array<std::vector<std::byte>, 3> buffers_;
  std::uint32_t back_ = 0;
  std::atomic<std::uint32_t> middle_{1};
  std::uint32_t front_ = 2;
};

/// Writes what is put, at most once in `interval`, and the last of it before it ends.
class CheckpointWriter {
 public:
  CheckpointWriter(CheckpointFile file, std::size_t size, Duration interval);
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  /// One thread; real-time safe.
  void put(std::span<const std::byte> state) noexcept;
  std::uint64_t written() const { return written_.load(std::memory_order_relaxed); }
  std::uint64_t failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  void run();
  void save_latest();

  CheckpointFile file_;
  LatestBytes latest_;
  Duration interval_;
  bus::Waker put_;
  std::atomic<bool> ending_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> failed_{0};
  std::thread thread_;
};

/// A service's checkpoint. Its version and size decide whether a file is read.
class Checkpoint {
 public:
  Checkpoint(Service& service, const std::filesystem::path& file, Duration interval = std::chrono::milliseconds(50));

  /// Before the service's first step. False: no file, it starts anew. An error is for a warning: it starts anew too.
  Result<bool> load();
  /// Starts the thread that writes; before the service is active.
  void start();
  /// Between steps; real-time safe. Without effect before start.
  void save() noexcept;
  const CheckpointWriter* writer() const { return writer_.get(); }

 private:
  Service& service_;
  std::vector<std::byte> state_;
  CheckpointFile file_;
  Duration interval_;
  std::unique_ptr<CheckpointWriter> writer_;
};

}  // namespace eciton::runtime
