// Participants, writers and readers for the tests of sim_network, straight on its C ABI. A sample is an
// encapsulation header, a key and a number.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "core/bus/plugin.h"
#include "core/bus/vendors/sim_network/sim_network.hpp"

namespace eciton::bus::sim_network::testing {

inline constexpr std::uint32_t sample_size = 12;
inline constexpr std::uint32_t domain = 3;
inline constexpr std::uint32_t error_size = 256;

inline std::array<std::uint8_t, sample_size> bytes_of(std::uint32_t key, std::uint32_t number) {
  std::array<std::uint8_t, sample_size> bytes{0, 1, 0, 0};
  std::memcpy(&bytes[4], &key, 4);
  std::memcpy(&bytes[8], &number, 4);
  return bytes;
}

inline eciton_type keyed_type(const char* name = "test::Keyed") {
  return {
      .name = name, .size_max = sample_size, .key_size = 4, .key_hash = [](auto* cdr, auto size, int, auto* hash) {
        if (size < 8) return 0;
        for (int k = 0; k < 4; ++k) hash[k] = cdr[7 - k];
        return 1;
      }};
}
inline eciton_type plain_type(const char* name = "test::Plain") {
  return {.name = name, .size_max = sample_size, .key_size = 0, .key_hash = nullptr};
}

inline constexpr eciton_qos best_effort{.reliable = 0, .transient_local = 0, .depth = 1, .instances_max = 8};
inline constexpr eciton_qos best_effort_deep{.reliable = 0, .transient_local = 0, .depth = 4096, .instances_max = 1};
inline constexpr eciton_qos reliable{.reliable = 1, .transient_local = 0, .depth = 1, .instances_max = 8};
inline constexpr eciton_qos reliable_deep{.reliable = 1, .transient_local = 0, .depth = 4096, .instances_max = 1};
inline constexpr eciton_qos transient_local{.reliable = 1, .transient_local = 1, .depth = 2, .instances_max = 8};

class TestWriter {
 public:
  TestWriter(eciton_participant* participant, const eciton_type& type, const eciton_qos& qos, const char* topic = "t")
      : handle_(eciton_dds_plugin()->writer_create(participant, topic, &type, &qos, error.data(), error_size)) {}
  TestWriter(TestWriter&& other) noexcept : error(other.error), handle_(std::exchange(other.handle_, nullptr)) {}
  ~TestWriter() {
    if (handle_) eciton_dds_plugin()->writer_destroy(handle_);
  }
  bool exists() const { return handle_ != nullptr; }
  bool write(std::uint32_t number, std::uint32_t key = 0) {
    const auto bytes = bytes_of(key, number);
    return eciton_dds_plugin()->writer_write(handle_, bytes.data(), sample_size) != 0;
  }
  bool write_bytes(const std::vector<std::uint8_t>& bytes) {
    return eciton_dds_plugin()->writer_write(handle_, bytes.data(), static_cast<std::uint32_t>(bytes.size())) != 0;
  }
  std::uint32_t matched() const { return eciton_dds_plugin()->writer_matched(handle_); }

  std::array<char, error_size> error{};

 private:
  eciton_writer* handle_;
};

class TestReader {
 public:
  TestReader(eciton_participant* participant, const eciton_type& type, const eciton_qos& qos,
             eciton_delivery delivery = {}, const char* topic = "t")
      : handle_(eciton_dds_plugin()->reader_create(participant, topic, &type, &qos, delivery, error.data(),
                                                   error_size)) {}
  TestReader(TestReader&& other) noexcept : error(other.error), handle_(std::exchange(other.handle_, nullptr)) {}
  ~TestReader() {
    if (handle_) eciton_dds_plugin()->reader_destroy(handle_);
  }
  bool exists() const { return handle_ != nullptr; }
  /// The numbers of all samples that are there.
  std::vector<std::uint32_t> take(std::uint32_t count_max = 100000) {
    std::vector<std::uint32_t> numbers;
    eciton_dds_plugin()->reader_take(
        handle_, count_max,
        [](void* context, const std::uint8_t* cdr, std::uint32_t size) {
          ASSERT_EQ(size, sample_size);
          std::uint32_t number = 0;
          std::memcpy(&number, cdr + 8, 4);
          static_cast<std::vector<std::uint32_t>*>(context)->push_back(number);
        },
        &numbers);
    return numbers;
  }
  /// As `take`, but touches no heap: how many, and the sum of their numbers.
  std::pair<std::uint32_t, std::uint64_t> take_sum() {
    std::uint64_t sum = 0;
    const std::uint32_t count = eciton_dds_plugin()->reader_take(
        handle_, 1000,
        [](void* context, const std::uint8_t* cdr, std::uint32_t) {
          std::uint32_t number = 0;
          std::memcpy(&number, cdr + 8, 4);
          *static_cast<std::uint64_t*>(context) += number;
        },
        &sum);
    return {count, sum};
  }
  std::uint32_t matched() const { return eciton_dds_plugin()->reader_matched(handle_); }
  eciton_reader_losses losses() const {
    eciton_reader_losses losses{};
    eciton_dds_plugin()->reader_losses(handle_, &losses);
    return losses;
  }

  std::array<char, error_size> error{};

 private:
  eciton_reader* handle_;
};

class TestParticipant {
 public:
  explicit TestParticipant(const char* name, std::uint32_t in_domain = domain) {
    const eciton_participant_config config{.domain = in_domain,
                                           .name = name,
                                           .network_interface = "lo",
                                           .peers = nullptr,
                                           .peer_count = 0,
                                           .lease_ms = 1000};
    handle_ = eciton_dds_plugin()->participant_create(&config, error.data(), error_size);
  }
  TestParticipant(const TestParticipant&) = delete;
  TestParticipant& operator=(const TestParticipant&) = delete;
  ~TestParticipant() {
    if (handle_) eciton_dds_plugin()->participant_destroy(handle_);
  }
  bool exists() const { return handle_ != nullptr; }
  operator eciton_participant*() const { return handle_; }

  std::array<char, error_size> error{};

 private:
  eciton_participant* handle_;
};

/// A network in virtual time, dropped after the test.
class VirtualNetwork : public ::testing::Test {
 protected:
  VirtualNetwork() { network().configure(7, Pacing::virtual_time); }
  ~VirtualNetwork() override { Network::reset_all(); }
  static Network& network() { return Network::of(domain); }
  static void advance(Duration to) { network().advance(TimePoint{to}); }
};

}  // namespace eciton::bus::sim_network::testing
