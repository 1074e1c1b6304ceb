// How many samples of its writers a reader never saw, told from the numbers that each writer gives its samples.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

namespace eciton::bus::vendors {

using WriterGuid = std::array<std::uint8_t, 16>;

/// For a plugin's reader_origin: of the GUID's first twelve bytes, which all endpoints of a participant share.
/// FNV-1a.
inline std::uint64_t origin_of(const WriterGuid& writer) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  bool known = false;
  for (std::size_t k = 0; k < 12; ++k) {
    known = known || writer[k] != 0;
    hash = (hash ^ writer[k]) * 0x100000001b3u;
  }
  return known ? hash : 0;
}

/// Samples may come in any order. Of more writers than there is room for, the one unheard for longest is forgotten,
/// and what it missed kept. Real-time safe, not thread-safe.
class SequenceGaps {
 public:
  static constexpr std::size_t writers_max = 32;

  void observe(const WriterGuid& writer, std::int64_t number) {
    if (number <= 0) return;
    ++clock_;
    Writer& known = find(writer);
    if (known.count == 0) {
      known = {writer, number, number, 1, clock_, false};
      return;
    }
    missing_ -= known.missing();
    if (number < known.first) known.first = number;
    if (number > known.last) known.last = number;
    ++known.count;
    known.heard = clock_;
    missing_ += known.missing();
  }

  /// What is missing so far of a writer first heard since the last call is its past: a late joiner of a topic that
  /// keeps samples is given only the last of each key.
  void forget_the_past() {
    for (Writer& writer : writers_) {
      if (writer.count == 0 || writer.past_is_over) continue;
      missing_ -= writer.missing();
      writer.first = writer.last - writer.count + 1;
      writer.past_is_over = true;
    }
  }

  std::uint64_t missing() const { return static_cast<std::uint64_t>(missing_ > 0 ? missing_ : 0); }

 private:
  struct Writer {
    WriterGuid guid{};
    std::int64_t first = 0, last = 0, count = 0;
    std::uint64_t heard = 0;
    bool past_is_over = false;

    std::int64_t missing() const { return last - first + 1 - count; }
  };

  /// The writer's place, or the one it takes, with a count of 0.
  Writer& find(const WriterGuid& guid) {
    Writer* oldest = &writers_[0];
    for (Writer& writer : writers_) {
      if (writer.count > 0 && writer.guid == guid) return writer;
      if (writer.heard < oldest->heard) oldest = &writer;
    }
    oldest->count = 0;
    return *oldest;
  }

  std::array<Writer, writers_max> writers_;
  std::int64_t missing_ = 0;
  std::uint64_t clock_ = 0;
};

}  // namespace eciton::bus::vendors
