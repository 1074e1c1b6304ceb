// A participant made with a vendor's own API and nothing changed, a writer and a reader on each of some topics.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace eciton::bench {

class NativeParticipant {
 public:
  virtual ~NativeParticipant() = default;
};

/// Throw std::runtime_error naming what the vendor refused.
std::unique_ptr<NativeParticipant> make_cyclonedds_participant(std::uint32_t domain,
                                                               const std::vector<std::string>& topics);
std::unique_ptr<NativeParticipant> make_fastdds_participant(std::uint32_t domain,
                                                            const std::vector<std::string>& topics);

}  // namespace eciton::bench
