// Where running modules and demos keep what lives as long as they do: sockets, logs, generated configs.
// One directory each, locked while it is in use and removed at the end.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.hpp"

namespace eciton::deploy {

/// $ECITON_RUNTIME_DIR; else /run/eciton for root, $XDG_RUNTIME_DIR/eciton, /tmp/eciton-<uid>.
std::filesystem::path runtime_root();

/// A directory below the root that this process holds.
class RuntimeDirectory {
 public:
  /// Makes and locks `name`; what a process that was killed left in it is removed. An Error names the
  /// process that holds it.
  static Result<RuntimeDirectory> claim(const std::string& name, const std::filesystem::path& root = runtime_root());

  RuntimeDirectory(RuntimeDirectory&& other) noexcept;
  RuntimeDirectory& operator=(RuntimeDirectory&& other) noexcept;
  /// Removes it, with all that is in it, and the root if nothing else is left there.
  ~RuntimeDirectory();

  const std::filesystem::path& path() const { return path_; }
  const std::string& name() const { return name_; }

  /// Another process asked for the end (see request_stop).
  bool stop_requested() const;
  /// Notes in the lock which process holds it: after a fork.
  void note_holder() const;

 private:
  RuntimeDirectory(std::string name, std::filesystem::path path, int lock)
      : name_(std::move(name)), path_(std::move(path)), lock_(lock) {}

  std::string name_;
  std::filesystem::path path_;
  int lock_ = -1;
};

/// A directory that some process holds.
struct HeldDirectory {
  std::string name;
  std::filesystem::path path;
  pid_t holder = 0;
};

std::vector<HeldDirectory> held_directories(const std::filesystem::path& root = runtime_root());
bool is_held(const std::filesystem::path& directory);
/// Asks the holder to end; it looks several times a second.
Status request_stop(const HeldDirectory& directory);

}  // namespace eciton::deploy
