// Members of one chain, whose last link is made and undone again and again.
#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/formation/fleet.hpp"
#include "benchmarks/formation/member_link.hpp"

namespace eciton::bench {

/// One formation, in seconds since the first of the two latches caught; of the last member.
struct FormationTimes {
  double view_s = 0;    // all members fly by the view of all members
  double skew_s = 0;    // between the first to do so and the last
  double wrench_s = 0;  // all have a contact wrench of that view's epoch
};

/// What stops a measurement.
struct FormationFailure {
  std::string why;
};

class ChainTrials {
 public:
  ChainTrials(const FormationOptions& options, const RunControl& control, const net::OwnedNet* net,
              std::uint32_t modules, const VendorPair& pair);

  /// Starts the members and links all but the last; throws FormationFailure.
  void prepare();
  /// One link and its end. Nothing: it did not come about in time. Throws FormationFailure when a member ended or it
  /// is interrupted.
  std::optional<FormationTimes> trial();

 private:
  struct Member {
    std::uint32_t id = 0;
    MemberLink link;
    MemberNews latched, view, wrench;  // the last of each
    bool has_view = false;
  };

  void start_members();
  void link(std::size_t first, bool measured_pause);
  void unlink(std::size_t first);
  void pump();
  bool wait_until(const std::function<bool()>& done, Duration timeout);
  void take(Member& member);
  /// Whether members [from, to) fly by one view of exactly their number.
  bool agreed(std::size_t from, std::size_t to) const;
  bool shared(std::size_t from, std::size_t to) const;

  const RunControl& control_;
  Fleet fleet_;
  VendorPair pair_;
  MemberListener listener_;
  std::vector<Member> members_;
  std::mt19937_64 random_;
};

}  // namespace eciton::bench
