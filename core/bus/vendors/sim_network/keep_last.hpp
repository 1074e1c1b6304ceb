// Which samples an endpoint keeps: the last `depth` of each key, in order of arrival. The writer's history
// and the reader's queue are both this; the bytes lie in a SamplePool. Nothing allocates after creation.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "core/bus/vendors/sim_network/sample_pool.hpp"

namespace eciton::bus::sim_network {

class KeepLast {
 public:
  static constexpr std::uint32_t none = SamplePool::none;

  KeepLast(std::uint32_t depth, std::uint32_t instances_max)
      : depth_(depth),
        instances_max_(instances_max),
        nodes_(std::make_unique_for_overwrite<Node[]>(std::size_t{depth} * instances_max)),
        free_(std::make_unique_for_overwrite<std::uint32_t[]>(std::size_t{depth} * instances_max)),
        buckets_(std::bit_ceil(2 * std::size_t{instances_max}), none) {
    instances_.reserve(instances_max);
  }

  struct Inserted {
    bool kept;              // false: one key more than the bound
    std::uint32_t evicted;  // the slot that made room, or none
  };
  Inserted insert(const KeyHash& key, std::uint32_t slot) {
    const std::uint32_t instance = find_or_add(key);
    if (instance == none) return {false, none};
    std::uint32_t evicted = none;
    if (instances_[instance].count == depth_) evicted = remove(instances_[instance].oldest);
    append(instance, slot);
    return {true, evicted};
  }

  /// Whether the next sample of this key replaces one.
  bool full(const KeyHash& key) const {
    const std::uint32_t instance = buckets_[find(key)];
    return instance != none && instances_[instance].count == depth_;
  }

  bool empty() const { return head_ == none; }
  /// The slot that came first.
  std::uint32_t pop() { return remove(head_); }

  /// Calls visit(slot) in order of arrival.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::uint32_t node = head_; node != none; node = nodes_[node].next) visit(nodes_[node].slot);
  }

 private:
  struct Node {
    std::uint32_t slot, instance;
    std::uint32_t previous, next;  // in order of arrival
    std::uint32_t next_of_instance;
  };
  struct Instance {
    KeyHash key;
    std::uint32_t count = 0;
    std::uint32_t oldest = none, newest = none;
  };

  /// The bucket of the key: its own, or the empty one it would take.
  std::size_t find(const KeyHash& key) const {
    std::uint64_t half[2];
    std::memcpy(half, key.data(), sizeof half);
    const std::uint64_t hash = (half[0] ^ std::rotl(half[1], 29)) * 0x9e3779b97f4a7c15u;
    std::size_t bucket = (hash ^ (hash >> 32)) & (buckets_.size() - 1);
    while (buckets_[bucket] != none && instances_[buckets_[bucket]].key != key)
      bucket = (bucket + 1) & (buckets_.size() - 1);
    return bucket;
  }

  std::uint32_t find_or_add(const KeyHash& key) {
    std::uint32_t& instance = buckets_[find(key)];
    if (instance == none && instances_.size() < instances_max_) {
      instance = static_cast<std::uint32_t>(instances_.size());
      instances_.push_back({.key = key});
    }
    return instance;
  }

  void append(std::uint32_t instance, std::uint32_t slot) {
    const std::uint32_t node = free_count_ > 0 ? free_[--free_count_] : fresh_++;
    nodes_[node] = {.slot = slot, .instance = instance, .previous = tail_, .next = none, .next_of_instance = none};
    (tail_ == none ? head_ : nodes_[tail_].next) = node;
    tail_ = node;
    Instance& owner = instances_[instance];
    (owner.count == 0 ? owner.oldest : nodes_[owner.newest].next_of_instance) = node;
    owner.newest = node;
    ++owner.count;
  }

  /// Only ever the oldest of its instance: the head of all is, too.
  std::uint32_t remove(std::uint32_t node) {
    const Node& gone = nodes_[node];
    (gone.previous == none ? head_ : nodes_[gone.previous].next) = gone.next;
    (gone.next == none ? tail_ : nodes_[gone.next].previous) = gone.previous;
    Instance& owner = instances_[gone.instance];
    owner.oldest = gone.next_of_instance;
    --owner.count;
    free_[free_count_++] = node;
    return gone.slot;
  }

  std::uint32_t depth_, instances_max_;
  std::uint32_t head_ = none, tail_ = none;
  std::uint32_t fresh_ = 0, free_count_ = 0;
  std::unique_ptr<Node[]> nodes_;
  std::unique_ptr<std::uint32_t[]> free_;
  std::vector<Instance> instances_;
  std::vector<std::uint32_t> buckets_;  // open addressing, at most half full
};

}  // namespace eciton::bus::sim_network
