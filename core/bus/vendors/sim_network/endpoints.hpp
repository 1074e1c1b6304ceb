// What a network holds: participants, their writers and readers, and the matches between these. Plain
// data; every change is made by Medium, under its lock.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bus/plugin.h"
#include "core/bus/vendors/sim_network/keep_last.hpp"
#include "core/bus/vendors/sim_network/link.hpp"
#include "core/bus/vendors/sim_network/sample_pool.hpp"

namespace eciton::bus::sim_network {

class Medium;
struct Reader;
struct Writer;

struct Participant {
  Medium* medium;
  std::string name;
  std::uint64_t number = 0;  // from 1, in the order of creation
  std::uint32_t group = 0;   // of the partition; 0: not named in it
};

/// A writer and a reader that fit together, in different participants.
struct Match {
  Writer* writer;
  Reader* reader;
  Link* link;
  bool reliable;
  bool cut = false;                  // by a partition
  std::uint64_t next_sequence = 1;   // first not yet handed to the link
  std::uint64_t last_delivered = 0;  // greatest sequence the reader was given
  std::int64_t last_due_ns = std::numeric_limits<std::int64_t>::min();
  std::uint32_t ordered_in_flight = 0;

  bool apart() const;  // by the partition as it is now
  void count_lost() const;
};

struct Endpoint {
  Endpoint(Participant& owner, std::string_view topic_name, const eciton_type& the_type, const eciton_qos& the_qos,
           std::uint32_t slots)
      : participant(owner),
        topic(topic_name),
        type_name(the_type.name),
        type(the_type),
        qos(the_qos),
        pool(slots, the_type.size_max) {}

  Participant& participant;
  std::string topic;
  std::string type_name;
  eciton_type type;
  eciton_qos qos;
  SamplePool pool;
};

struct Writer : Endpoint {
  /// Samples of one writer in flight beyond those in its history.
  static constexpr std::uint32_t in_flight_max = 512;

  Writer(Participant& owner, std::string_view topic_name, const eciton_type& the_type, const eciton_qos& the_qos)
      : Endpoint(owner, topic_name, the_type, the_qos,
                 in_flight_max + (the_qos.reliable ? the_qos.depth * the_qos.instances_max : 0)) {
    if (the_qos.reliable) history.emplace(the_qos.depth, the_qos.instances_max);
  }

  std::uint64_t sequence = 0;
  std::optional<KeepLast> history;              // of a reliable writer
  std::vector<std::unique_ptr<Match>> matches;  // in order of creation
};

struct Reader : Endpoint {
  /// Two slots more than the queue holds: for the sample being taken and the one that comes in.
  Reader(Participant& owner, std::string_view topic_name, const eciton_type& the_type, const eciton_qos& the_qos,
         eciton_delivery the_delivery)
      : Endpoint(owner, topic_name, the_type, the_qos, the_qos.depth * the_qos.instances_max + 2),
        delivery(the_delivery),
        queue(the_qos.depth, the_qos.instances_max) {}

  eciton_delivery delivery;
  KeepLast queue;
  std::vector<Match*> matches;
  eciton_reader_losses losses{};
  std::uint64_t origin = 0;      // of the sample being taken: its participant's number
  bool awaits_delivery = false;  // has samples that are to be given to it at once
};

inline bool Match::apart() const { return writer->participant.group != reader->participant.group; }
inline void Match::count_lost() const {
  ++link->statistics.lost;
  ++reader->losses.lost;
}

/// A sample on its way; in the heap by (due_ns, order).
struct Flight {
  std::int64_t due_ns;
  std::uint64_t order;
  Match* match;
  std::int64_t attempt_ns;  // when the attempt that arrives was made
  std::uint32_t slot;       // in the writer's pool
  bool ordered;             // keeps its place behind earlier samples of the match
  bool duplicate;
};

inline bool later(const Flight& a, const Flight& b) {
  return a.due_ns != b.due_ns ? a.due_ns > b.due_ns : a.order > b.order;
}

}  // namespace eciton::bus::sim_network
