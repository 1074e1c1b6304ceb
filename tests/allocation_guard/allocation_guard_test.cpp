// The guard itself: it catches what it should, from whom, and nothing else.
#include "tests/allocation_guard/allocation_guard.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

extern "C" void fake_plugin_call_vendor();
extern "C" void fake_plugin_allocate_in_callback();

namespace eciton::testing {
namespace {

class AllocationGuardTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationGuard::available()) GTEST_SKIP() << "the sanitizers bring a heap of their own";
  }
};

/// What the compiler must not optimise away.
template <class T>
void use(T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

TEST_F(AllocationGuardTest, ADeliberateVectorIsCaught) {
  AllocationGuard guard;
  {
    std::vector<int> numbers(100);
    use(numbers);
  }
  EXPECT_EQ(guard.framework(), 2u);  // new and delete
  EXPECT_EQ(guard.vendor(), 0u);
  EXPECT_NE(guard.describe().find("allocation_guard_test"), std::string::npos) << guard.describe();
}

TEST_F(AllocationGuardTest, EveryWayToTheHeapIsCaught) {
  AllocationGuard guard;
  void* memory = std::malloc(10);
  use(memory);
  memory = std::realloc(memory, 1000);
  use(memory);
  std::free(memory);
  EXPECT_EQ(guard.framework(), 3u);
  memory = std::calloc(10, 10);
  use(memory);
  std::free(memory);
  EXPECT_EQ(guard.framework(), 5u);
  memory = std::aligned_alloc(64, 128);
  use(memory);
  std::free(memory);
  EXPECT_EQ(guard.framework(), 7u);
  void* aligned = nullptr;
  EXPECT_EQ(::posix_memalign(&aligned, 64, 128), 0);
  std::free(aligned);
  EXPECT_EQ(guard.framework(), 9u);
  std::free(nullptr);
  EXPECT_EQ(guard.framework(), 9u);
}

TEST_F(AllocationGuardTest, WhatTheCppLibraryAllocatesBelongsToItsCaller) {
  AllocationGuard guard;
  std::string text = std::to_string(1) + std::string(100, 'x');
  use(text);
  EXPECT_GT(guard.framework(), 0u);
}

TEST_F(AllocationGuardTest, AVendorsLibraryIsCountedApart) {
  AllocationGuard guard;
  fake_plugin_call_vendor();
  EXPECT_EQ(guard.vendor(), 2u);
  EXPECT_EQ(guard.framework(), 0u) << guard.describe();
}

TEST_F(AllocationGuardTest, APluginCalledBackByAVendorIsOurs) {
  AllocationGuard guard;
  fake_plugin_allocate_in_callback();
  EXPECT_EQ(guard.framework(), 2u);
  EXPECT_EQ(guard.vendor(), 0u);
}

TEST_F(AllocationGuardTest, OtherThreadsAndOtherTimesDoNotCount) {
  std::vector<int> before(100);
  use(before);
  std::thread other;
  {
    AllocationGuard guard;
    EXPECT_EQ(guard.framework(), 0u);
  }
  other = std::thread([] {
    std::vector<int> elsewhere(100);
    use(elsewhere);
  });
  AllocationGuard guard;
  other.join();
  EXPECT_EQ(guard.framework(), 0u) << guard.describe();
}

TEST_F(AllocationGuardTest, AnExceptionIsCaughtToo) {
  AllocationGuard guard;
  try {
    throw 1;
  } catch (int) {
  }
  EXPECT_GT(guard.framework(), 0u);
}

}  // namespace
}  // namespace eciton::testing
