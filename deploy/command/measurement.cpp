// Written to a file of its own beside it and renamed: nobody reads half of it.
#include "deploy/command/measurement.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace eciton::deploy {
namespace {

std::string draft_of(const std::string& path) { return path + "." + std::to_string(::getpid()); }

Error cannot_write(const std::string& path, int why) {
  return Error{"--json " + path + ": cannot be written: " + std::strerror(why)};
}

}  // namespace

Status check_measurement_file(const std::string& path) {
  if (path.empty()) return ok();
  const std::string draft = draft_of(path);
  if (!std::ofstream(draft)) return cannot_write(path, errno);
  std::remove(draft.c_str());
  return ok();
}

Status write_measurement(const std::string& path, const Measurement& m) {
  const Json object{{"command", m.command}, {"config", m.config},   {"seed", m.seed},
                    {"clock", m.clock},     {"metrics", m.metrics}, {"series", m.series}};
  const std::string draft = draft_of(path);
  {
    std::ofstream file(draft);
    file << object.dump(2) << "\n";
    if (!file.flush()) return cannot_write(path, errno);
  }
  if (std::rename(draft.c_str(), path.c_str()) != 0) {
    const int why = errno;
    std::remove(draft.c_str());
    return cannot_write(path, why);
  }
  return ok();
}

}  // namespace eciton::deploy
