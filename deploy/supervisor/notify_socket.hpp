// The supervisor's end of systemd's notify protocol: where a child says that it is ready, that it works, that it
// ends.
#pragma once

#include <filesystem>

#include "core/base/result.hpp"

namespace eciton::deploy {

/// For one child: its name says who speaks. The path is the child's NOTIFY_SOCKET.
class NotifySocket {
 public:
  /// Replaces what is left there. An Error names the path.
  static Result<NotifySocket> open(const std::filesystem::path& path);

  NotifySocket(NotifySocket&& other) noexcept;
  NotifySocket& operator=(NotifySocket&& other) noexcept;
  ~NotifySocket();

  struct Notices {
    bool ready = false;     // READY=1
    bool alive = false;     // WATCHDOG=1
    bool stopping = false;  // STOPPING=1
  };
  /// What was said since the last call; what else the protocol knows is passed over. Never waits.
  Notices take();

  const std::filesystem::path& path() const { return path_; }

 private:
  NotifySocket(std::filesystem::path path, int socket) : path_(std::move(path)), socket_(socket) {}

  std::filesystem::path path_;
  int socket_ = -1;
};

}  // namespace eciton::deploy
