// The network behind sim_network.hpp: matches endpoints and carries samples between them, at once where
// nothing delays them, else through a heap of flights ordered by (time, sequence).
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "core/bus/vendors/sim_network/endpoints.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"

namespace eciton::bus::sim_network {

class Medium {
 public:
  explicit Medium(std::uint32_t domain) : domain_(domain) {}
  ~Medium();
  Medium(const Medium&) = delete;
  Medium& operator=(const Medium&) = delete;

  // What Network offers; see there.
  void configure(std::uint64_t seed, Pacing pacing);
  void set_default_link(const LinkQuality& quality);
  void set_link(std::string_view from, std::string_view to, const LinkQuality& quality);
  void partition(const std::vector<std::vector<std::string>>& groups);
  void advance(TimePoint now);
  std::optional<TimePoint> next_delivery() const;
  Statistics statistics() const;
  Statistics statistics(std::string_view from, std::string_view to) const;
  std::uint64_t mismatched() const;
  std::uint64_t writes_refused() const;
  bool in_use() const;

  // What the plugin offers. Creating functions return nullptr and say why in `error`.
  Participant* create_participant(std::string_view name, std::string& error);
  void destroy(Participant& participant);
  Writer* create_writer(Participant& participant, std::string_view topic, const eciton_type& type,
                        const eciton_qos& qos, std::string& error);
  Reader* create_reader(Participant& participant, std::string_view topic, const eciton_type& type,
                        const eciton_qos& qos, eciton_delivery delivery, std::string& error);
  void destroy(Writer& writer);
  void destroy(Reader& reader);
  bool write(Writer& writer, std::span<const std::uint8_t> cdr);
  std::uint32_t take(Reader& reader, std::uint32_t count_max, eciton_sink sink, void* context);
  std::uint32_t matched(const Writer& writer) const;
  std::uint32_t matched(const Reader& reader) const;
  eciton_reader_losses losses(const Reader& reader) const;

 private:
  /// The bound on samples in flight grows with the network, up to a million.
  static constexpr std::size_t flights_per_match = 64, flights_least = 4096, flights_bound = 1u << 20;

  using LinkName = std::pair<std::string, std::string>;

  /// A sample being sent; its slot in the writer's pool is filled when something must outlast the write.
  struct Outgoing {
    Writer& writer;
    std::span<const std::uint8_t> cdr;
    KeyHash key;
    std::uint64_t sequence;
    std::uint32_t slot = SamplePool::none;
  };

  std::int64_t now_ns() const;
  Link& link(std::string_view from, std::string_view to);
  const LinkQuality& quality_of(const Link& link) const;
  void start_thread_if_needed();
  void run_thread();

  std::uint32_t group_of(const std::string& name) const;
  std::string refusal(std::string_view kind, const Participant& participant, std::string_view topic,
                      const eciton_type& type, const eciton_qos& qos) const;
  void match_if_fitting(Writer& writer, Reader& reader);
  template <class Gone>
  void drop_flights(Gone&& gone);

  void send(Match& match, Outgoing& outgoing);
  void send_history(Match& match);
  void launch(Outgoing& outgoing, Flight flight);
  void land(const Flight& flight);
  void land_all_due(std::int64_t now, std::unique_lock<std::mutex>& lock);
  void deliver(Match& match, const Outgoing& sample, bool duplicate);
  bool remember(Outgoing& outgoing);
  void deliver_inline(std::unique_lock<std::mutex>& lock);

  mutable std::mutex mutex_;
  const std::uint32_t domain_;
  std::uint64_t seed_ = 0;
  Pacing pacing_ = Pacing::immediate_wall;
  std::int64_t virtual_now_ns_ = 0;
  LinkQuality default_quality_;
  std::map<LinkName, Link> links_;               // pointers to its elements stay valid
  std::map<std::string, std::uint32_t> groups_;  // of the partition
  std::vector<std::unique_ptr<Participant>> participants_;
  std::uint64_t numbered_ = 0;                    // so far, those gone included
  std::vector<std::unique_ptr<Writer>> writers_;  // in order of creation, as are the readers
  std::vector<std::unique_ptr<Reader>> readers_;
  std::vector<Flight> flights_;  // a heap, reserved up to its bound
  std::size_t flights_max_ = 0;
  std::size_t matches_ = 0;
  std::uint64_t order_ = 0;
  std::uint64_t mismatched_ = 0;
  std::uint64_t writes_refused_ = 0;

  std::vector<Reader*> awaiting_;  // readers that await_delivery; room for all
  Reader* served_ = nullptr;       // is being given samples, unlocked, by one thread for all
  std::condition_variable served_changed_;

  std::condition_variable sooner_;  // a flight became due before all others, or the end
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace eciton::bus::sim_network
