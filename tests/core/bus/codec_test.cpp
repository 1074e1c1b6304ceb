// The codec on every type of the wire contract: against bytes by hand and an independent encoder, back again,
// and against whatever a broken or hostile peer may send.
#include "core/bus/codec.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "idl/topics.hpp"
#include "tests/allocation_guard/allocation_guard.hpp"
#include "tests/core/bus/reference_cdr.hpp"

namespace eciton::bus::testing {
namespace {

using eciton::testing::AllocationGuard;
using Bytes = std::vector<std::uint8_t>;

template <Message T>
Bytes encoded(const T& sample) {
  Bytes bytes(TypeTraits<T>::size_max);
  bytes.resize(encode(sample, bytes));
  return bytes;
}

/// From memory that ends where the bytes end, so that the address sanitizer sees every read beyond.
template <Message T>
bool decodes(const Bytes& bytes, T& sample) {
  const auto exact = std::make_unique<std::uint8_t[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), exact.get());
  return decode(std::span<const std::uint8_t>(exact.get(), bytes.size()), sample);
}
template <Message T>
bool decodes(const Bytes& bytes) {
  T sample;
  return decodes(bytes, sample);
}

/// Calls visit(T{}) for the type of every topic.
template <class Visit>
void for_each_type(Visit&& visit) {
  topics::for_each([&]<class T>(const Topic<T>&) {
    SCOPED_TRACE(TypeTraits<T>::name);
    visit(T{});
  });
}

TEST(CodecTest, WritesTheBytesWorkedOutByHand) {
  msg::LinkClaim claim;
  claim.module_id = 0x01020304;
  claim.port = 5;
  claim.stamp_ns = -2;
  claim.incarnation = 6;
  claim.sequence_number = 7;
  claim.withdrawn = true;
  claim.peer_id = 8;
  claim.peer_port = 9;
  claim.latch = msg::LatchStatus::latched;
  const Bytes expected = {0,   1,   0,   0,                        // plain CDR, little-endian
                          4,   3,   2,   1,                        // module_id
                          5,   0,   0,   0,                        // port
                          254, 255, 255, 255, 255, 255, 255, 255,  // stamp_ns
                          6,   0,   0,   0,   0,   0,   0,   0,
                          7,   0,   0,   0,   0,   0,   0,   0,  // incarnation, sequence_number
                          1,   0,   0,   0,                      // withdrawn, padding
                          8,   0,   0,   0,   9,   0,   0,   0,  // peer_id, peer_port
                          2,   0,   0,   0};                     // latch
  EXPECT_EQ(encoded(claim), expected);
  msg::LinkClaim back;
  ASSERT_TRUE(decodes(expected, back));
  EXPECT_EQ(back, claim);
  const KeyHash key = {1, 2, 3, 4, 0, 0, 0, 5};
  EXPECT_EQ(key_hash(claim), key);
}

TEST(CodecTest, WritesStringsAndSequencesAsWorkedOutByHand) {
  msg::Fault fault;
  fault.module_id = 1;
  fault.stamp_ns = 2;
  fault.severity = msg::Severity::error;
  fault.service = "ab";
  fault.device = "";
  fault.text = "xyz";
  fault.record = "csv";
  const Bytes expected = {0, 1, 0, 0, 1,   0,   0,   0, 0, 0,  //
                          0, 0,                                // module_id, padding to 8
                          2, 0, 0, 0, 0,   0,   0,   0,        // stamp_ns
                          2, 0, 0, 0,                          // severity
                          3, 0, 0, 0, 'a', 'b', 0,   0,        // service: its length with the zero; padding
                          1, 0, 0, 0, 0,   0,   0,   0,        // device
                          4, 0, 0, 0, 'x', 'y', 'z', 0,        // text
                          4, 0, 0, 0, 'c', 's', 'v', 0};       // record
  EXPECT_EQ(encoded(fault), expected);
  msg::Fault back;
  ASSERT_TRUE(decodes(expected, back));
  EXPECT_EQ(back, fault);
}

TEST(CodecTest, AgreesWithAnIndependentEncoderInBothByteOrdersAndReadsItBack) {
  std::mt19937_64 random(1);
  for_each_type([&]<class T>(T) {
    for (int k = 0; k < 100; ++k) {
      const T sample = random_sample<T>(random);
      ASSERT_EQ(encoded(sample), reference_cdr(sample).padded());
      for (const bool big_endian : {false, true}) {
        T back;
        ASSERT_TRUE(decodes(reference_cdr(sample, big_endian).padded(), back));
        ASSERT_EQ(back, sample);
      }
    }
  });
}

TEST(CodecTest, TheLargestSampleFillsSizeMaxAndOneByteLessRefusesIt) {
  for_each_type([]<class T>(T) {
    // Any seed that makes every sequence and string full would do; so the bound is reached by growing.
    std::mt19937_64 random(2);
    std::size_t largest = 0;
    for (int k = 0; k < 300; ++k) largest = std::max(largest, encoded(random_sample<T>(random)).size());
    EXPECT_LE(largest, TypeTraits<T>::size_max);
    const T sample = random_sample<T>(random);
    Bytes short_buffer(encoded(sample).size() - 1);
    EXPECT_EQ(encode(sample, short_buffer), 0u);
  });
  msg::ChainView full;
  full.members.resize(16);
  full.links.resize(full.links.bound());
  EXPECT_EQ(encoded(full).size(), TypeTraits<msg::ChainView>::size_max);
}

TEST(CodecTest, KeyHashesAreTheBigEndianKeyFromEitherByteOrder) {
  std::mt19937_64 random(3);
  for_each_type([&]<class T>(T) {
    const T sample = random_sample<T>(random);
    ReferenceCdr key(true);
    if constexpr (TypeTraits<T>::keyed) TypeTraits<T>::visit_key(key, sample);
    KeyHash expected{};
    ASSERT_EQ(key.bytes.size() - 4, TypeTraits<T>::key_size);
    std::copy(key.bytes.begin() + 4, key.bytes.end(), expected.begin());
    EXPECT_EQ(key_hash(sample), expected);
    if constexpr (TypeTraits<T>::keyed) {
      for (const bool big_endian : {false, true}) {
        const Bytes bytes = reference_cdr(sample, big_endian).padded();
        KeyHash hash{};
        ASSERT_EQ(key_hash_of_bytes<T>(bytes.data(), static_cast<std::uint32_t>(bytes.size()), 0, hash.data()), 1);
        EXPECT_EQ(hash, expected);
      }
    }
  });
}

TEST(CodecTest, RefusesASampleTruncatedAtAnyLength) {
  std::mt19937_64 random(4);
  for_each_type([&]<class T>(T) {
    for (int k = 0; k < 5; ++k) {
      const Bytes whole = reference_cdr(random_sample<T>(random), k % 2 == 1).bytes;
      for (std::size_t size = 0; size < whole.size(); ++size)
        ASSERT_FALSE(decodes<T>(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))))
            << size << " of " << whole.size() << " bytes";
    }
  });
}

TEST(CodecTest, RefusesWhatIsLongerThanItsPadding) {
  std::mt19937_64 random(5);
  for_each_type([&]<class T>(T) {
    Bytes bytes = reference_cdr(random_sample<T>(random)).bytes;
    bytes.resize(bytes.size() + 4);
    EXPECT_FALSE(decodes<T>(bytes));
  });
}

TEST(CodecTest, RefusesOtherRepresentations) {
  Bytes bytes = encoded(msg::Imu{});
  for (int first = 0; first < 256; ++first)
    for (int second = 0; second < 256; ++second) {
      bytes[0] = static_cast<std::uint8_t>(first);
      bytes[1] = static_cast<std::uint8_t>(second);
      ASSERT_EQ(decodes<msg::Imu>(bytes), first == 0 && second <= 1) << first << ' ' << second;
    }
}

TEST(CodecTest, RefusesEveryNumberThatIsNotFinite) {
  std::mt19937_64 random(6);
  for (const double poison : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()}) {
    for_each_type([&]<class T>(T) {
      T sample = random_sample<T>(random);
      PoisonedNumber numbers(-1, poison);
      TypeTraits<T>::visit(numbers, sample);
      for (int chosen = 0; chosen < numbers.count; ++chosen) {
        T poisoned = sample;
        PoisonedNumber at(chosen, poison);
        TypeTraits<T>::visit(at, poisoned);
        ASSERT_FALSE(decodes<T>(reference_cdr(poisoned).padded())) << "number " << chosen;
      }
      ASSERT_TRUE(decodes<T>(reference_cdr(sample).padded()));
    });
  }
}

TEST(CodecTest, RefusesUnknownEnumeratorsBooleansAndLengths) {
  Bytes claim = encoded(msg::LinkClaim{});
  const auto with = [](Bytes bytes, std::size_t at, std::uint8_t value) {
    bytes[at] = value;
    return bytes;
  };
  EXPECT_TRUE(decodes<msg::LinkClaim>(with(claim, 36, 1)));   // withdrawn
  EXPECT_FALSE(decodes<msg::LinkClaim>(with(claim, 36, 2)));  // neither true nor false
  EXPECT_TRUE(decodes<msg::LinkClaim>(with(claim, 48, 2)));   // latched
  EXPECT_FALSE(decodes<msg::LinkClaim>(with(claim, 48, 3)));  // the first that is no status
  EXPECT_FALSE(decodes<msg::LinkClaim>(with(claim, 51, 1)));

  msg::Fault fault;
  fault.service = "abc";
  const Bytes text = encoded(fault);                        // service: length at 24, characters from 28
  EXPECT_FALSE(decodes<msg::Fault>(with(text, 24, 0)));     // not even the zero
  EXPECT_FALSE(decodes<msg::Fault>(with(text, 24, 33)));    // more than the bound
  EXPECT_FALSE(decodes<msg::Fault>(with(text, 27, 0xff)));  // far more than there are bytes
  EXPECT_FALSE(decodes<msg::Fault>(with(text, 31, 'd')));   // no zero at the end
  EXPECT_FALSE(decodes<msg::Fault>(with(text, 29, 0)));     // a zero inside

  msg::JointState state;
  state.joints.resize(8);
  const Bytes sequence = encoded(state);  // joints: length at 20
  ASSERT_EQ(sequence[20], 8);
  EXPECT_FALSE(decodes<msg::JointState>(with(sequence, 20, 9)));
  EXPECT_FALSE(decodes<msg::JointState>(with(sequence, 23, 0xff)));
}

TEST(CodecTest, SurvivesAHundredThousandBrokenSamples) {
  constexpr int per_type = 100'000 / std::tuple_size_v<decltype(topics::all)> + 1;
  std::mt19937_64 random(7);
  int accepted = 0, refused = 0;
  for_each_type([&]<class T>(T) {
    for (int k = 0; k < per_type; ++k) {
      Bytes bytes = reference_cdr(random_sample<T>(random), random() % 2 == 0).padded();
      if (random() % 8 == 0) bytes.resize(random() % (TypeTraits<T>::size_max + 8));
      for (auto flips = random() % 8; flips > 0 && !bytes.empty(); --flips) {
        // Mostly behind the header, which is soon tried.
        const std::size_t at =
            random() % 16 == 0 ? random() % bytes.size() : bytes.size() - 1 - random() % bytes.size();
        bytes[at] = random() % 2 == 0 ? static_cast<std::uint8_t>(random())
                                      : static_cast<std::uint8_t>(bytes[at] ^ (1u << random() % 8));
      }
      KeyHash hash{};
      key_hash_of_bytes<T>(bytes.data(), static_cast<std::uint32_t>(bytes.size()), 0, hash.data());
      T sample;
      if (!decodes(bytes, sample)) {
        ++refused;
        continue;
      }
      // What is let in is a proper sample: it survives the way out and in again.
      ++accepted;
      T again;
      ASSERT_TRUE(decodes(encoded(sample), again)) << "seed 7, sample " << k;
      ASSERT_EQ(again, sample) << "seed 7, sample " << k;
    }
  });
  EXPECT_GT(accepted, 10'000);
  EXPECT_GT(refused, 10'000);
}

TEST(CodecTest, LeavesTheHeapAloneWellFormedOrNot) {
  if (!AllocationGuard::available()) GTEST_SKIP() << "the sanitizers bring a heap of their own";
  std::mt19937_64 random(8);
  for_each_type([&]<class T>(T) {
    const T sample = random_sample<T>(random);
    Bytes buffer(TypeTraits<T>::size_max);
    const Bytes whole = encoded(sample);
    std::uint64_t uses = 0;
    {
      AllocationGuard guard;
      encode(sample, buffer);
      T back;
      ASSERT_TRUE(decode(whole, back));
      ASSERT_EQ(key_hash(back), key_hash(sample));
      uses = guard.framework();
    }
    EXPECT_EQ(uses, 0u) << "well-formed";
    {
      AllocationGuard guard;
      for (std::size_t size = 0; size < whole.size(); size += 3) {
        T back;
        const bool good = decode(std::span(whole).first(size), back);
        asm volatile("" : : "g"(good));
      }
      uses = guard.framework();
    }
    EXPECT_EQ(uses, 0u) << "a peer's malformed samples must not cost the step path its bounds";
  });
}

}  // namespace
}  // namespace eciton::bus::testing
