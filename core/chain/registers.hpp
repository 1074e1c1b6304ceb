// A bounded table of single-writer registers, joined: of two entries with one key the newer version stays.
// The join is idempotent, commutative and associative, so order, loss and duplication of messages do not matter.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/bounded.hpp"

namespace eciton::chain {

/// Entry offers key(), version() and content(), each ordered. Real-time safe: no allocation, O(Bound).
template <class Entry, std::size_t Bound>
class Registers {
 public:
  enum class Joined { unchanged, changed, refused };

  Joined join(const Entry& entry) {
    Entry* const place = std::lower_bound(entries_.begin(), entries_.end(), entry,
                                          [](const Entry& a, const Entry& b) { return a.key() < b.key(); });
    if (place != entries_.end() && place->key() == entry.key()) return supersede(*place, entry);
    if (entries_.full()) {
      ++refused_;
      return Joined::refused;
    }
    const std::size_t k = static_cast<std::size_t>(place - entries_.begin());
    entries_.push_back(entry);
    std::rotate(entries_.begin() + k, entries_.end() - 1, entries_.end());
    ++revision_;
    return Joined::changed;
  }

  void join(const Registers& other) {
    for (const Entry& entry : other.entries_) join(entry);
  }

  /// In the order of their keys.
  std::span<const Entry> entries() const { return {entries_.data(), entries_.size()}; }

  template <class Key>
  const Entry* find(const Key& key) const {
    const Entry* const place = std::lower_bound(entries_.begin(), entries_.end(), key,
                                                [](const Entry& a, const Key& b) { return a.key() < b; });
    return place != entries_.end() && place->key() == key ? place : nullptr;
  }

  /// Grows with every change of an entry.
  std::uint64_t revision() const { return revision_; }
  /// Entries that found no place.
  std::uint64_t refused() const { return refused_; }
  /// Two contents under one version: a register has two writers, as with a module id given twice.
  std::uint64_t conflicts() const { return conflicts_; }

  bool operator==(const Registers& other) const { return entries_ == other.entries_; }

 private:
  Joined supersede(Entry& kept, const Entry& entry) {
    if (kept.version() == entry.version() && kept.content() != entry.content()) ++conflicts_;
    const bool newer =
        kept.version() < entry.version() || (kept.version() == entry.version() && kept.content() < entry.content());
    if (!newer) return Joined::unchanged;
    kept = entry;
    ++revision_;
    return Joined::changed;
  }

  BoundedVector<Entry, Bound> entries_;
  std::uint64_t revision_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t conflicts_ = 0;
};

}  // namespace eciton::chain
