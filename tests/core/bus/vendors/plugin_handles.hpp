// Plugins loaded as the framework loads them, and their handles with owners, for the tests of the C ABI.
#pragma once

#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/bus/plugin.h"
#include "tests/core/bus/vendors/bytes_sample.hpp"

namespace eciton::bus {

inline const eciton_plugin& plugin(const std::string& vendor) {
  const char* directory = std::getenv("ECITON_PLUGIN_PATH");
  const std::string path =
      (directory != nullptr ? std::string(directory) + "/" : "") + "lib" ECITON_PLUGIN_PREFIX + vendor + ".so";
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    std::fprintf(stderr, "%s\n", dlerror());
    std::abort();
  }
  return *reinterpret_cast<const eciton_plugin* (*)()>(dlsym(library, ECITON_PLUGIN_ENTRY))();
}

/// Another run on this machine most likely has another.
inline std::uint32_t domain_of_this_run() { return 100 + static_cast<std::uint32_t>(getpid()) % 100; }

inline bool wait_for(const std::function<bool()>& condition,
                     std::chrono::milliseconds limit = std::chrono::seconds(10)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

class TestParticipant {
 public:
  explicit TestParticipant(const std::string& vendor, std::uint32_t domain = domain_of_this_run(),
                           std::vector<const char*> peers = {}, const char* network_interface = "lo")
      : plugin_(plugin(vendor)) {
    const eciton_participant_config config = {
        domain, "test", network_interface, peers.data(), static_cast<std::uint32_t>(peers.size()), 3000};
    char error[512] = "";
    handle_ = plugin_.participant_create(&config, error, sizeof error);
    error_ = error;
  }
  ~TestParticipant() {
    if (handle_ != nullptr) plugin_.participant_destroy(handle_);
  }
  TestParticipant(const TestParticipant&) = delete;
  TestParticipant& operator=(const TestParticipant&) = delete;

  const eciton_plugin& abi() const { return plugin_; }
  eciton_participant* handle() const { return handle_; }
  const std::string& error() const { return error_; }

 private:
  const eciton_plugin& plugin_;
  eciton_participant* handle_ = nullptr;
  std::string error_;
};

class TestWriter {
 public:
  TestWriter(TestParticipant& participant, const char* topic, const eciton_type& type, const eciton_qos& qos)
      : abi_(participant.abi()) {
    char error[512] = "";
    handle_ = abi_.writer_create(participant.handle(), topic, &type, &qos, error, sizeof error);
    error_ = error;
  }
  ~TestWriter() {
    if (handle_ != nullptr) abi_.writer_destroy(handle_);
  }
  TestWriter(const TestWriter&) = delete;
  TestWriter& operator=(const TestWriter&) = delete;

  bool write(const Cdr& cdr) {
    return abi_.writer_write(handle_, cdr.data(), static_cast<std::uint32_t>(cdr.size())) == 1;
  }
  std::uint32_t matched() const { return abi_.writer_matched(handle_); }
  bool created() const { return handle_ != nullptr; }
  const std::string& error() const { return error_; }

 private:
  const eciton_plugin& abi_;
  eciton_writer* handle_ = nullptr;
  std::string error_;
};

class TestReader {
 public:
  TestReader(TestParticipant& participant, const char* topic, const eciton_type& type, const eciton_qos& qos)
      : abi_(participant.abi()) {
    char error[512] = "";
    const eciton_delivery delivery = {[](void* self) { ++static_cast<TestReader*>(self)->signals_; }, nullptr, this};
    handle_ = abi_.reader_create(participant.handle(), topic, &type, &qos, delivery, error, sizeof error);
    error_ = error;
  }
  ~TestReader() { destroy(); }
  TestReader(const TestReader&) = delete;
  TestReader& operator=(const TestReader&) = delete;

  void destroy() {
    if (handle_ != nullptr) abi_.reader_destroy(handle_);
    handle_ = nullptr;
  }
  /// Appends what there is to `taken`.
  std::uint32_t take(std::uint32_t count_max = 1000) {
    return abi_.reader_take(
        handle_, count_max,
        [](void* self, const std::uint8_t* cdr, std::uint32_t size) {
          static_cast<TestReader*>(self)->taken.emplace_back(cdr, cdr + size);
        },
        this);
  }
  bool wait_until_taken(std::size_t count) {
    return wait_for([this, count] {
      take();
      return taken.size() >= count;
    });
  }
  std::uint32_t matched() const { return abi_.reader_matched(handle_); }
  std::uint32_t signals() const { return signals_; }
  bool created() const { return handle_ != nullptr; }
  const std::string& error() const { return error_; }

  std::vector<Cdr> taken;

 private:
  const eciton_plugin& abi_;
  eciton_reader* handle_ = nullptr;
  std::atomic<std::uint32_t> signals_{0};
  std::string error_;
};

/// Both ends know of each other: from here on nothing reliable is lost.
inline bool connected(const TestWriter& writer, const TestReader& reader) {
  return wait_for([&] { return writer.matched() > 0 && reader.matched() > 0; });
}

}  // namespace eciton::bus
