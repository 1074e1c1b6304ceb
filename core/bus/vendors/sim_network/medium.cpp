// Who is connected to whom: participants, endpoints and their matches, link qualities and partitions.
#include "core/bus/vendors/sim_network/medium.hpp"

#include <algorithm>
#include <stdexcept>

namespace eciton::bus::sim_network {

Medium::~Medium() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
  }
  sooner_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Medium::configure(std::uint64_t seed, Pacing pacing) {
  const std::scoped_lock lock(mutex_);
  if (!participants_.empty())
    throw std::logic_error("sim_network: configure() of domain " + std::to_string(domain_) + " after participant '" +
                           participants_.front()->name + "'; configure it before the first one");
  seed_ = seed;
  pacing_ = pacing;
  for (auto& [names, a_link] : links_) a_link.random = RandomStream(link_seed(seed, names.first, names.second));
  start_thread_if_needed();
}

void Medium::set_default_link(const LinkQuality& quality) {
  const std::scoped_lock lock(mutex_);
  default_quality_ = quality;
  start_thread_if_needed();
}

void Medium::set_link(std::string_view from, std::string_view to, const LinkQuality& quality) {
  const std::scoped_lock lock(mutex_);
  link(from, to).quality = quality;
  start_thread_if_needed();
}

Link& Medium::link(std::string_view from, std::string_view to) {
  const auto [at, is_new] = links_.try_emplace(
      LinkName(from, to), Link{.quality = {}, .random = RandomStream(link_seed(seed_, from, to)), .statistics = {}});
  return at->second;
}

const LinkQuality& Medium::quality_of(const Link& a_link) const {
  return a_link.quality ? *a_link.quality : default_quality_;
}

void Medium::start_thread_if_needed() {
  bool delays = default_quality_ != LinkQuality{};
  for (const auto& [names, a_link] : links_) delays = delays || (a_link.quality && *a_link.quality != LinkQuality{});
  if (delays && pacing_ == Pacing::immediate_wall && !thread_.joinable())
    thread_ = std::thread([this] { run_thread(); });
}

/// Takes the flights for which gone(match) holds out of the heap; those of best effort are lost.
template <class Gone>
void Medium::drop_flights(Gone&& gone) {
  const auto drop = [&gone](const Flight& flight) {
    if (!gone(*flight.match)) return false;
    if (!flight.match->reliable) flight.match->count_lost();
    if (flight.ordered) --flight.match->ordered_in_flight;
    flight.match->writer->pool.release(flight.slot);
    return true;
  };
  if (std::erase_if(flights_, drop) > 0) std::make_heap(flights_.begin(), flights_.end(), later);
}

void Medium::partition(const std::vector<std::vector<std::string>>& groups) {
  std::unique_lock lock(mutex_);
  groups_.clear();
  for (std::uint32_t k = 0; k < groups.size(); ++k)
    for (const auto& name : groups[k]) groups_[name] = k + 1;
  for (auto& participant : participants_) participant->group = group_of(participant->name);
  drop_flights([](const Match& match) { return !match.cut && match.apart(); });
  for (auto& writer : writers_)
    for (auto& match : writer->matches) {
      // What was in flight is sent anew, from the history, once healed.
      if (!match->cut && match->apart()) match->next_sequence = match->last_delivered + 1;
      match->cut = match->apart();
      if (!match->cut && match->reliable) send_history(*match);
    }
  deliver_inline(lock);
}

std::uint32_t Medium::group_of(const std::string& name) const {
  const auto group = groups_.find(name);
  return group == groups_.end() ? 0 : group->second;
}

Participant* Medium::create_participant(std::string_view name, std::string& error) {
  const std::scoped_lock lock(mutex_);
  for (const auto& other : participants_)
    if (other->name == name) {
      error = "sim_network: a participant named '" + other->name + "' is already in domain " +
              std::to_string(domain_) + "; the name is the address: give each participant its own";
      return nullptr;
    }
  participants_.push_back(std::make_unique<Participant>(Participant{
      .medium = this, .name = std::string(name), .number = ++numbered_, .group = group_of(std::string(name))}));
  return participants_.back().get();
}

void Medium::destroy(Participant& participant) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(participants_, [&participant](const auto& each) { return each.get() == &participant; });
}

std::string Medium::refusal(std::string_view kind, const Participant& participant, std::string_view topic,
                            const eciton_type& type, const eciton_qos& qos) const {
  const std::string where = "sim_network: " + std::string(kind) + " of topic '" + std::string(topic) +
                            "' in participant '" + participant.name + "', domain " + std::to_string(domain_);
  if (qos.depth == 0 || qos.instances_max == 0)
    return where + ": depth " + std::to_string(qos.depth) + " and instances_max " +
           std::to_string(qos.instances_max) + " must be at least 1";
  if (type.key_size == 0 && qos.instances_max != 1)
    return where + ": instances_max " + std::to_string(qos.instances_max) + " without a key must be 1";
  if (type.size_max < 4) return where + ": size_max " + std::to_string(type.size_max) + " must be at least 4";
  if (type.key_size > 0 && !type.key_hash) return where + ": a keyed type needs key_hash";
  return {};
}

Writer* Medium::create_writer(Participant& participant, std::string_view topic, const eciton_type& type,
                              const eciton_qos& qos, std::string& error) {
  const std::scoped_lock lock(mutex_);
  error = refusal("writer", participant, topic, type, qos);
  if (!error.empty()) return nullptr;
  Writer& writer = *writers_.emplace_back(std::make_unique<Writer>(participant, topic, type, qos));
  for (auto& reader : readers_) match_if_fitting(writer, *reader);
  return &writer;
}

Reader* Medium::create_reader(Participant& participant, std::string_view topic, const eciton_type& type,
                              const eciton_qos& qos, eciton_delivery delivery, std::string& error) {
  std::unique_lock lock(mutex_);
  error = refusal("reader", participant, topic, type, qos);
  if (!error.empty()) return nullptr;
  Reader& reader = *readers_.emplace_back(std::make_unique<Reader>(participant, topic, type, qos, delivery));
  awaiting_.reserve(readers_.size());
  for (auto& writer : writers_) match_if_fitting(*writer, reader);
  deliver_inline(lock);
  return &reader;
}

void Medium::match_if_fitting(Writer& writer, Reader& reader) {
  if (&writer.participant == &reader.participant || writer.topic != reader.topic) return;
  if (writer.type_name != reader.type_name || (writer.type.key_size == 0) != (reader.type.key_size == 0) ||
      writer.qos.reliable < reader.qos.reliable || writer.qos.transient_local < reader.qos.transient_local) {
    ++mismatched_;
    return;
  }
  const bool with_history = reader.qos.reliable && reader.qos.transient_local;
  const std::uint64_t known = with_history ? 0 : writer.sequence;
  Match& match = *writer.matches.emplace_back(
      std::make_unique<Match>(Match{.writer = &writer,
                                    .reader = &reader,
                                    .link = &link(writer.participant.name, reader.participant.name),
                                    .reliable = reader.qos.reliable != 0,
                                    .cut = writer.participant.group != reader.participant.group,
                                    .next_sequence = known + 1,
                                    .last_delivered = known}));
  reader.matches.push_back(&match);
  if (++matches_ * flights_per_match > flights_max_ && flights_max_ < flights_bound) {
    flights_max_ = std::max<std::size_t>(2 * flights_max_, flights_least);
    flights_.reserve(flights_max_);
  }
  if (match.reliable) send_history(match);
}

void Medium::destroy(Writer& writer) {
  const std::scoped_lock lock(mutex_);
  drop_flights([&writer](const Match& match) { return match.writer == &writer; });
  for (const auto& match : writer.matches) std::erase(match->reader->matches, match.get());
  matches_ -= writer.matches.size();
  std::erase_if(writers_, [&writer](const auto& each) { return each.get() == &writer; });
}

void Medium::destroy(Reader& reader) {
  std::unique_lock lock(mutex_);
  std::erase(awaiting_, &reader);
  served_changed_.wait(lock, [&] { return served_ != &reader; });
  drop_flights([&reader](const Match& match) { return match.reader == &reader; });
  matches_ -= reader.matches.size();
  for (Match* match : reader.matches)
    std::erase_if(match->writer->matches, [match](const auto& each) { return each.get() == match; });
  std::erase_if(readers_, [&reader](const auto& each) { return each.get() == &reader; });
}

std::uint32_t Medium::matched(const Writer& writer) const {
  const std::scoped_lock lock(mutex_);
  return static_cast<std::uint32_t>(writer.matches.size());
}

std::uint32_t Medium::matched(const Reader& reader) const {
  const std::scoped_lock lock(mutex_);
  return static_cast<std::uint32_t>(reader.matches.size());
}

eciton_reader_losses Medium::losses(const Reader& reader) const {
  const std::scoped_lock lock(mutex_);
  return reader.losses;
}

bool Medium::in_use() const {
  const std::scoped_lock lock(mutex_);
  return !participants_.empty();
}

Statistics Medium::statistics() const {
  const std::scoped_lock lock(mutex_);
  Statistics sum;
  for (const auto& [names, a_link] : links_) sum += a_link.statistics;
  return sum;
}

Statistics Medium::statistics(std::string_view from, std::string_view to) const {
  const std::scoped_lock lock(mutex_);
  const auto at = links_.find(LinkName(from, to));
  return at == links_.end() ? Statistics{} : at->second.statistics;
}

std::uint64_t Medium::mismatched() const {
  const std::scoped_lock lock(mutex_);
  return mismatched_;
}

std::uint64_t Medium::writes_refused() const {
  const std::scoped_lock lock(mutex_);
  return writes_refused_;
}

}  // namespace eciton::bus::sim_network
