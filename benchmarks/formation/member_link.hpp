// What passes between `bench formation` and a member of the chain it measures: orders there, what came to pass on
// the member's ring back. One Unix socket per member, which network namespaces do not part.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/base/result.hpp"
#include "core/base/time.hpp"

namespace eciton::bench {

struct MemberOrder {
  enum class What : std::uint32_t {
    approach,  // the port nears the peer's: what docking publishes before a latch
    latch,     // its latch has caught
    release    // it is open
  } what = What::approach;
  std::uint32_t port = 0;
  std::uint32_t peer = 0;
  std::uint32_t peer_port = 0;
  std::uint32_t follower = 0;  // 1: this one comes to the other
};

struct MemberNews {
  enum class What : std::uint32_t {
    hello,    // it runs
    latched,  // the latch's state went out
    released,
    view,   // of another active view
    wrench  // the first contact wrench of an epoch
  } what = What::hello;
  std::uint32_t module_id = 0;
  std::int64_t monotonic_ns = 0;
  std::uint64_t epoch = 0;
  std::uint32_t members = 0;
};

/// A connected SOCK_SEQPACKET socket; whole messages, never waits but in `wait`.
class MemberLink {
 public:
  MemberLink() = default;
  explicit MemberLink(int fd) : fd_(fd) {}
  MemberLink(MemberLink&& other) noexcept;
  MemberLink& operator=(MemberLink&& other) noexcept;
  ~MemberLink();

  static eciton::Result<MemberLink> connect(const std::filesystem::path& path);
  int fd() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }

  bool send(const MemberOrder& order) { return send_bytes(&order, sizeof order); }
  bool send(const MemberNews& news) { return send_bytes(&news, sizeof news); }
  std::optional<MemberOrder> take_order();
  std::optional<MemberNews> take_news();

 private:
  bool send_bytes(const void* data, std::size_t size);
  bool receive(void* data, std::size_t size);

  int fd_ = -1;
};

/// Where members call.
class MemberListener {
 public:
  static eciton::Result<MemberListener> open(const std::filesystem::path& path);
  MemberListener(MemberListener&& other) noexcept;
  MemberListener& operator=(MemberListener&&) = delete;
  ~MemberListener();
  int fd() const { return fd_; }
  std::optional<MemberLink> accept();

 private:
  MemberListener(int fd, std::filesystem::path path) : fd_(fd), path_(std::move(path)) {}
  int fd_ = -1;
  std::filesystem::path path_;
};

}  // namespace eciton::bench
