// The Unix socket by which a running net is asked: one line there, one answer back, then it is closed.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>

#include "core/base/result.hpp"

namespace eciton::net {

/// The relay's side, in its poll loop: never waits, and holds few clients at a time.
class ControlServer {
 public:
  using Answer = std::function<std::string(const std::string& line)>;

  static Result<ControlServer> listen(const std::filesystem::path& path);
  ControlServer(ControlServer&& other) noexcept;
  ControlServer& operator=(ControlServer&&) = delete;
  ~ControlServer();

  /// One that is readable or writable when `serve` has something to do.
  int file_descriptor() const { return epoll_; }
  void serve(const Answer& answer);

 private:
  struct Client {
    int fd = -1;
    std::string request;
    std::string reply;  // what is left of it
    bool answered = false;
  };

  ControlServer(int listener, int epoll) : listener_(listener), epoll_(epoll) {}
  void accept_client();
  void serve(Client& client, const Answer& answer);
  void drop(Client& client);

  int listener_ = -1;
  int epoll_ = -1;
  std::array<Client, 8> clients_;
};

/// A client's side: sends the line and waits for the answer, a few seconds at most.
Result<std::string> ask(const std::filesystem::path& path, const std::string& line);

}  // namespace eciton::net
