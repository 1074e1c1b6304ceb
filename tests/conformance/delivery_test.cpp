// Samples arrive as they were written, once, at whom they are for.
#include "tests/conformance/ring.hpp"

namespace eciton::bus::conformance {
namespace {

TEST_P(Conformance, DeliversTypedSamplesByKey) {
  auto writer = a.create_writer(topics::link_claim);
  auto reader = b.create_reader(topics::link_claim);
  ASSERT_TRUE(matched(writer, reader));
  const std::vector<msg::LinkClaim> sent = {claim(1, 0, 10), claim(1, 1, 11), claim(2, 0, 12)};
  for (const auto& sample : sent) EXPECT_TRUE(writer.write(sample));
  EXPECT_EQ(take_count(reader, sent.size()), sent);
  EXPECT_EQ(reader.statistics().delivered, sent.size());
  EXPECT_EQ(reader.statistics().dropped(), 0u);
  EXPECT_EQ(writer.written(), sent.size());
  EXPECT_EQ(writer.refused(), 0u);
}

TEST_P(Conformance, DeliversWithoutAKey) {
  auto writer = a.create_writer(topics::clock);
  auto reader = b.create_reader(topics::clock);
  ASSERT_TRUE(matched(writer, reader));
  for (std::uint64_t tick = 1; tick <= 20; ++tick) {
    msg::Clock clock;
    clock.tick = tick;
    clock.imu_sampled = tick % 2 == 0;
    EXPECT_TRUE(writer.write(clock));
    const auto got = take_count(reader, 1);  // as lockstep does: one tick after the other
    ASSERT_EQ(got.size(), 1u);
    EXPECT_EQ(got[0], clock);
  }
}

TEST_P(Conformance, DeliversTheLargestSampleOfATopic) {
  auto writer = a.create_writer(topics::chain_view);
  auto reader = b.create_reader(topics::chain_view);
  ASSERT_TRUE(matched(writer, reader));
  msg::ChainView view;
  view.module_id = 3;
  for (std::uint32_t k = 0; k < 16; ++k) view.members.push_back(k);
  for (std::uint32_t k = 0; k < 32; ++k) view.links.push_back({k / 2, k % 2, k / 2 + 1, 2 + k % 2});
  EXPECT_TRUE(writer.write(view));
  const auto got = take_count(reader, 1);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0], view);
}

TEST_P(Conformance, WakesTheReadersParticipant) {
  auto writer = a.create_writer(topics::joint_command);
  auto reader = b.create_reader(topics::joint_command);
  ASSERT_TRUE(matched(writer, reader));
  while (b.waker().wait(Duration::zero())) {
  }
  EXPECT_TRUE(writer.write({}));
  bool got = false;
  for (int k = 0; k < 100 && !got; ++k) {
    EXPECT_TRUE(b.waker().wait(15s));
    got = reader.take().has_value();
  }
  EXPECT_TRUE(got);
}

TEST_P(Conformance, DeliversInsideAParticipantAtOnceAndExactlyOnce) {
  auto writer = a.create_writer(topics::link_claim);
  auto own = a.create_reader(topics::link_claim);
  auto other = b.create_reader(topics::link_claim);
  ASSERT_TRUE(matched(writer, other));
  EXPECT_EQ(own.matched(), 0u);
  for (std::uint64_t number = 1; number <= 10; ++number) {
    EXPECT_TRUE(writer.write(claim(1, 0, number)));
    const auto sample = own.take();
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->value.sequence_number, number);
    EXPECT_FALSE(own.take());
    EXPECT_EQ(take_count(other, 1).at(0).sequence_number, number);
  }
  EXPECT_FALSE(own.take());  // by now the vendor would have delivered them again
  EXPECT_EQ(own.statistics().received, 10u);
  EXPECT_EQ(other.statistics().received, 10u);
}

TEST_P(Conformance, DeliversToEveryReaderAndFromEveryWriter) {
  Participant c(config_of(GetParam().reader));
  auto from_a = a.create_writer(topics::link_claim);
  auto from_b = b.create_writer(topics::link_claim);
  auto at_b = b.create_reader(topics::link_claim);
  auto at_c = c.create_reader(topics::link_claim);
  ASSERT_TRUE(matched(from_a, at_b, 2));
  ASSERT_TRUE(eventually([&] { return from_b.matched() == 1 && at_c.matched() == 2; }));
  from_a.write(claim(1, 0, 7));
  from_b.write(claim(2, 0, 8));
  auto at_both = take_count(at_c, 2);
  EXPECT_EQ(at_both.size(), 2u);
  EXPECT_EQ(take_count(at_b, 2).size(), 2u);  // one of them its own participant's
}

TEST_P(Conformance, RawEndpointsCarryTheVeryBytes) {
  const TopicInfo topic = info(topics::external_wrench);
  auto writer = a.create_raw_writer(topic);
  auto reader = b.create_raw_reader(topic);
  ASSERT_TRUE(matched(writer, reader));
  msg::ExternalWrench wrench;
  wrench.module_id = 5;
  wrench.force_W_N = {1, 2, 3};
  std::vector<std::uint8_t> sent(topic.type.size_max);
  sent.resize(encode(wrench, sent));
  std::vector<std::uint8_t> got;
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(writer.write(sent));
    reader.take(
        [](void* context, std::span<const std::uint8_t> cdr) {
          static_cast<std::vector<std::uint8_t>*>(context)->assign(cdr.begin(), cdr.end());
        },
        &got);
    return !got.empty();
  }));
  EXPECT_EQ(got, sent);
}

TEST_P(Conformance, AForeignByteOrderIsUnderstood) {
  auto writer = a.create_raw_writer(info(topics::link_claim));
  auto reader = b.create_reader(topics::link_claim);
  ASSERT_TRUE(matched(writer, reader));
  const msg::LinkClaim sample = claim(0x01020304, 7, 0x0102030405060708);
  std::array<std::uint8_t, TypeTraits<msg::LinkClaim>::size_max> bytes{};
  Encoder encoder(bytes, true);
  TypeTraits<msg::LinkClaim>::visit(encoder, sample);
  const std::size_t size = encoder.finish();
  ASSERT_EQ(bytes[1], 0);  // plain CDR, big-endian
  EXPECT_TRUE(writer.write(std::span(bytes).first(size)));
  const auto got = take_count(reader, 1);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0], sample);
}

TEST_P(Conformance, AnotherTypeOrAnotherKeyNeverMatches) {
  TopicInfo other_type = info(topics::link_claim), unkeyed = info(topics::link_claim);
  other_type.type.name = "eciton::msg::Else";
  unkeyed.type.key_size = 0;
  auto foreign = a.create_raw_writer(other_type);
  Participant c(config_of(GetParam().writer));
  auto keyless = c.create_raw_writer(unkeyed);
  Participant d(config_of(GetParam().writer));
  auto proper = d.create_writer(topics::link_claim);
  auto reader = b.create_reader(topics::link_claim);
  ASSERT_TRUE(matched(proper, reader));
  std::array<std::uint8_t, TypeTraits<msg::LinkClaim>::size_max> bytes{};
  const auto size = encode(claim(9, 9, 9), bytes);
  foreign.write(std::span(bytes).first(size));
  keyless.write(std::span(bytes).first(size));
  proper.write(claim(1, 0, 1));
  EXPECT_EQ(take_count(reader, 1), std::vector{claim(1, 0, 1)});
  EXPECT_EQ(foreign.matched(), 0u);
  EXPECT_EQ(keyless.matched(), 0u);
  EXPECT_EQ(reader.statistics().received, 1u);
}

INSTANTIATE_TEST_SUITE_P(Delivery, Conformance, ::testing::ValuesIn(all_pairs), name_of);

}  // namespace
}  // namespace eciton::bus::conformance
