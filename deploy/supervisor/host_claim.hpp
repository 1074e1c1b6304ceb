// Things of which a host has one, such as the module with id 3 or the DDS domain 13: claimed by an abstract
// socket, which the kernel frees when the process ends and which reaches as far as the network does.
#pragma once

#include <string>

#include "core/base/result.hpp"

namespace eciton::deploy {

class HostClaim {
 public:
  /// `what` names the thing, as "module id 3". An Error names the process that has it.
  static Result<HostClaim> take(const std::string& what);

  HostClaim(HostClaim&& other) noexcept;
  HostClaim& operator=(HostClaim&& other) noexcept;
  ~HostClaim();

 private:
  explicit HostClaim(int socket) : socket_(socket) {}
  int socket_ = -1;
};

}  // namespace eciton::deploy
