// Orders go to both ends of a link; news of every member come back, all on the machine's one monotonic clock.
#include "benchmarks/formation/chain_trials.hpp"

#include <algorithm>

#include "core/base/wall_clock.hpp"

namespace eciton::bench {
namespace {

constexpr Duration pump_at_most = std::chrono::milliseconds(100);
constexpr Duration start_timeout = std::chrono::seconds(40);
constexpr Duration trial_timeout = std::chrono::seconds(10);
constexpr Duration approach = std::chrono::milliseconds(600);  // wrenches flow and peers count as near
constexpr std::uint32_t male = 0, female = 1;                  // LEGION's ports

}  // namespace

ChainTrials::ChainTrials(const FormationOptions& options, const RunControl& control, const net::OwnedNet* net,
                         std::uint32_t modules, const VendorPair& pair)
    : control_(control),
      fleet_(options, net),
      pair_(pair),
      listener_(value_or_throw(MemberListener::open(fleet_.directory() / "members.sock"))),
      members_(modules),
      random_(options.seed) {}

void ChainTrials::prepare() {
  start_members();
  const auto alone = [&] {
    return std::all_of(members_.begin(), members_.end(), [](const Member& m) { return m.has_view; });
  };
  if (!wait_until(alone, start_timeout)) throw FormationFailure{"not every member came up"};
  // Participants meet meanwhile: a beacon of each has been heard by then.
  const Duration met = monotonic_now() + std::chrono::seconds(3);
  wait_until([&] { return monotonic_now() >= met; }, start_timeout);
  for (std::size_t first = 0; first + 2 < members_.size(); ++first) {
    link(first, false);
    if (!wait_until([&] { return agreed(0, first + 2) && shared(0, first + 2); }, start_timeout)) {
      throw FormationFailure{"the first " + std::to_string(first + 2) + " members did not become a chain"};
    }
  }
}

void ChainTrials::start_members() {
  for (std::uint32_t index = 0; index < members_.size(); ++index) {
    members_[index].id = first_id + index;
    const auto file = fleet_.write_config(index, index % 2 == 0 ? pair_.first : pair_.second, {});
    const Status started = fleet_.start(
        index, {"eciton-bench-member", "--config", file, "--socket", fleet_.directory() / "members.sock"});
    if (!started) throw FormationFailure{started.error().message};
  }
}

std::optional<FormationTimes> ChainTrials::trial() {
  const std::size_t n = members_.size();
  for (Member& m : members_) m.latched = m.wrench = {};
  link(n - 2, true);
  const auto formed = [&] { return agreed(0, n) && shared(0, n); };
  const bool came = wait_until(formed, trial_timeout);
  std::optional<FormationTimes> times;
  if (came) {
    const std::int64_t begin_ns =
        std::min(members_[n - 2].latched.monotonic_ns, members_[n - 1].latched.monotonic_ns);
    const auto [first, last] =
        std::minmax_element(members_.begin(), members_.end(),
                            [](const auto& a, const auto& b) { return a.view.monotonic_ns < b.view.monotonic_ns; });
    const auto wrench = std::max_element(members_.begin(), members_.end(), [](const auto& a, const auto& b) {
      return a.wrench.monotonic_ns < b.wrench.monotonic_ns;
    });
    times = FormationTimes{.view_s = to_s(Duration(last->view.monotonic_ns - begin_ns)),
                           .skew_s = to_s(Duration(last->view.monotonic_ns - first->view.monotonic_ns)),
                           .wrench_s = to_s(Duration(wrench->wrench.monotonic_ns - begin_ns))};
  }
  unlink(n - 2);
  if (!wait_until([&] { return agreed(0, n - 1) && agreed(n - 1, n); }, start_timeout)) {
    throw FormationFailure{"the last member did not leave the chain"};
  }
  return times;
}

/// The male port of `first` is in the female one of the next.
void ChainTrials::link(std::size_t first, bool measured_pause) {
  Member &a = members_[first], &b = members_[first + 1];
  MemberOrder to_a{.what = MemberOrder::What::approach, .port = male, .peer = b.id, .peer_port = female};
  MemberOrder to_b{
      .what = MemberOrder::What::approach, .port = female, .peer = a.id, .peer_port = male, .follower = 1};
  a.link.send(to_a);
  b.link.send(to_b);
  // So that a latch catches at any time of the services' periods.
  const auto spread =
      std::chrono::microseconds(std::uniform_int_distribution<>(0, measured_pause ? 50'000 : 0)(random_));
  const Duration caught = monotonic_now() + approach + spread;
  wait_until([&] { return monotonic_now() >= caught; }, start_timeout);
  to_a.what = to_b.what = MemberOrder::What::latch;
  a.link.send(to_a);
  b.link.send(to_b);
}

void ChainTrials::unlink(std::size_t first) {
  members_[first].link.send(MemberOrder{.what = MemberOrder::What::release, .port = male});
  members_[first + 1].link.send(MemberOrder{.what = MemberOrder::What::release, .port = female});
}

bool ChainTrials::agreed(std::size_t from, std::size_t to) const {
  for (std::size_t k = from; k < to; ++k) {
    const Member& m = members_[k];
    if (!m.has_view || m.view.members != to - from || m.view.epoch != members_[from].view.epoch) return false;
  }
  return true;
}

bool ChainTrials::shared(std::size_t from, std::size_t to) const {
  for (std::size_t k = from; k < to; ++k) {
    if (members_[k].wrench.epoch != members_[k].view.epoch || members_[k].wrench.epoch == 0) return false;
  }
  return true;
}

bool ChainTrials::wait_until(const std::function<bool()>& done, Duration timeout) {
  const Duration end = monotonic_now() + timeout;
  while (!done()) {
    if (monotonic_now() > end) return false;
    pump();
  }
  return true;
}

void ChainTrials::pump() {
  std::vector<pollfd> wait{{control_.stop.file_descriptor(), POLLIN, 0}, {listener_.fd(), POLLIN, 0}};
  for (const Member& m : members_) {
    if (m.link.is_open()) wait.push_back({m.link.fd(), POLLIN, 0});
  }
  fleet_.add_descriptors(wait);
  deploy::wait_for(wait, std::chrono::milliseconds(10));
  if (control_.stop.requested()) throw FormationFailure{"interrupted"};
  if (const std::string trouble = fleet_.trouble(); !trouble.empty()) throw FormationFailure{trouble};
  while (auto caller = listener_.accept()) {
    // It says hello at once; who it is stands in that.
    std::vector<pollfd> hello{{caller->fd(), POLLIN, 0}};
    deploy::wait_for(hello, pump_at_most * 50);
    const auto news = caller->take_news();
    for (Member& m : members_) {
      if (news && news->module_id == m.id) m.link = std::move(*caller);
    }
  }
  for (Member& m : members_) take(m);
}

void ChainTrials::take(Member& member) {
  while (const auto news = member.link.take_news()) {
    switch (news->what) {
      case MemberNews::What::latched:
        member.latched = *news;
        break;
      case MemberNews::What::view:
        member.view = *news;
        member.has_view = true;
        break;
      case MemberNews::What::wrench:
        member.wrench = *news;
        break;
      case MemberNews::What::hello:
      case MemberNews::What::released:
        break;
    }
  }
}

}  // namespace eciton::bench
