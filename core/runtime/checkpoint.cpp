// The file format, and the thread that writes it.
#include "core/runtime/checkpoint.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/base/contract.hpp"
#include "core/base/log.hpp"

namespace eciton::runtime {

namespace {

struct Header {
  std::array<char, 8> magic = {'E', 'C', 'I', 'T', 'O', 'N', 'C', 'P'};
  std::uint32_t version = 0;
  std::uint32_t crc32 = 0;  // of the state
  std::uint64_t size = 0;
};
static_assert(sizeof(Header) == 24, "no padding: it is written as it lies");

/// CRC-32 as IEEE 802.3 and zlib have it.
std::uint32_t crc32(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const std::byte byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// Closes a file descriptor.
struct File {
  explicit File(int descriptor) : fd(descriptor) {}
  ~File() {
    if (fd >= 0) ::close(fd);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  bool write_all(std::span<const std::byte> bytes) const {
    return ::write(fd, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  }
  int fd;
};

std::string why() { return std::strerror(errno); }

}  // namespace

CheckpointFile::CheckpointFile(std::filesystem::path file, std::uint32_t version, std::size_t size)
    : file_(std::move(file)), version_(version), size_(size) {}

Status CheckpointFile::save(std::span<const std::byte> state) const {
  const std::filesystem::path beside = file_.string() + ".new";
  Header header{.version = version_, .crc32 = crc32(state), .size = state.size()};
  {
    const File file(::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0640));
    // A file that cannot be held to disk by a power cut: the runtime directory does not outlive one either.
    if (file.fd < 0 || !file.write_all(std::as_bytes(std::span(&header, 1))) || !file.write_all(state)) {
      return Error{"checkpoint " + beside.string() + " cannot be written: " + why()};
    }
  }
  if (::rename(beside.c_str(), file_.c_str()) != 0) {
    return Error{"checkpoint " + file_.string() + " cannot be replaced: " + why()};
  }
  return ok();
}

Result<bool> CheckpointFile::load(std::span<std::byte> state) const {
  const auto refuse = [this](const std::string& what) {
    return Error{"checkpoint " + file_.string() + " is ignored: " + what};
  };
  const File file(::open(file_.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.fd < 0 && errno == ENOENT) return false;
  if (file.fd < 0) return refuse(why());
  Header header;
  if (::read(file.fd, &header, sizeof header) != static_cast<ssize_t>(sizeof header) ||
      header.magic != Header{}.magic) {
    return refuse("it is not one");
  }
  if (header.version != version_) {
    return refuse("it has version " + std::to_string(header.version) + ", this program writes " +
                  std::to_string(version_));
  }
  if (header.size != size_ || state.size() != size_) {
    return refuse("its state has " + std::to_string(header.size) + " bytes, this program's " + std::to_string(size_));
  }
  std::byte beyond{};
  if (::read(file.fd, state.data(), state.size()) != static_cast<ssize_t>(state.size()) ||
      ::read(file.fd, &beyond, 1) != 0 || crc32(state) != header.crc32) {
    return refuse("it is damaged");
  }
  return true;
}

LatestBytes::LatestBytes(std::size_t size) {
  for (auto& buffer : buffers_) buffer.resize(size);
}

void LatestBytes::put(std::span<const std::byte> bytes) noexcept {
  std::memcpy(buffers_[back_].data(), bytes.data(), std::min(bytes.size(), buffers_[back_].size()));
  back_ = middle_.exchange(back_ | fresh, std::memory_order_acq_rel) & ~fresh;
}

std::optional<std::span<const std::byte>> LatestBytes::take() noexcept {
  if ((middle_.load(std::memory_order_relaxed) & fresh) == 0) return std::nullopt;
  front_ = middle_.exchange(front_, std::memory_order_acq_rel) & ~fresh;
  return buffers_[front_];
}

CheckpointWriter::CheckpointWriter(CheckpointFile file, std::size_t size, Duration interval)
    : file_(std::move(file)), latest_(size), interval_(interval), thread_([this] { run(); }) {}

CheckpointWriter::~CheckpointWriter() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  ended_.notify_one();
  put_.signal();
  thread_.join();
}

void CheckpointWriter::put(std::span<const std::byte> state) noexcept {
  latest_.put(state);
  put_.signal();
}

void CheckpointWriter::run() {
  while (!ending_) {
    put_.wait(std::chrono::hours(1));
    save_latest();
    std::unique_lock lock(mutex_);
    ended_.wait_for(lock, interval_, [this] { return ending_.load(); });
  }
  save_latest();
}

void CheckpointWriter::save_latest() {
  const auto state = latest_.take();
  if (!state) return;
  const Status saved = file_.save(*state);
  ++(saved ? written_ : failed_);
  // Once: a full or missing directory would fill the log too.
  if (!saved && failed_ == 1) spdlog::warn("{}", saved.error().message);
}

namespace {

std::size_t state_size(const Service& service) {
  StateWriter counting({});
  service.save_state(counting);
  return counting.size();
}

}  // namespace

Checkpoint::Checkpoint(Service& service, const std::filesystem::path& file, Duration interval)
    : service_(service),
      state_(state_size(service)),
      file_(file, service.state_version(), state_.size()),
      interval_(interval) {}

Result<bool> Checkpoint::load() {
  const auto found = file_.load(state_);
  if (!found || !*found) return found;
  StateReader reader(state_);
  service_.load_state(reader);
  ECITON_EXPECT(reader.complete(), "a service loads what it saves, value for value");
  return true;
}

void Checkpoint::start() { writer_ = std::make_unique<CheckpointWriter>(file_, state_.size(), interval_); }

void Checkpoint::save() noexcept {
  if (!writer_) return;
  StateWriter writer(state_);
  service_.save_state(writer);
  writer_->put(state_);
}

}  // namespace eciton::runtime
