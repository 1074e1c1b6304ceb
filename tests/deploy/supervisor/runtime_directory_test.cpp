// Claims on runtime directories: exclusive, naming the holder, cleaned up by whoever comes next.
#include "deploy/supervisor/runtime_directory.hpp"

#include <gtest/gtest.h>

#include "tests/deploy/supervisor/scratch.hpp"

namespace eciton::deploy {
namespace {

TEST(RuntimeDirectoryTest, IsRemovedWithItsRootAtTheEnd) {
  Scratch scratch;
  const auto root = scratch.path() / "root";
  {
    auto directory = RuntimeDirectory::claim("m1", root);
    ASSERT_TRUE(directory.ok()) << directory.error().message;
    std::ofstream(directory->path() / "world.sock") << "x";
    EXPECT_TRUE(std::filesystem::exists(root / "m1" / "world.sock"));
  }
  EXPECT_FALSE(std::filesystem::exists(root));
}

TEST(RuntimeDirectoryTest, RefusesASecondClaimNamingTheHolder) {
  Scratch scratch;
  auto first = RuntimeDirectory::claim("m1", scratch.path());
  ASSERT_TRUE(first.ok());
  const auto second = RuntimeDirectory::claim("m1", scratch.path());
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find("process " + std::to_string(::getpid())), std::string::npos);
  EXPECT_NE(second.error().message.find("m1 is already running"), std::string::npos);
  const auto other = RuntimeDirectory::claim("m2", scratch.path());
  EXPECT_TRUE(other.ok());
  EXPECT_EQ(held_directories(scratch.path()).size(), 2u);
}

TEST(RuntimeDirectoryTest, ClearsWhatAKilledProcessLeft) {
  Scratch scratch;
  std::filesystem::create_directory(scratch.path() / "m1");
  std::ofstream(scratch.path() / "m1" / "lock") << "1\n";
  std::ofstream(scratch.path() / "m1" / "stop") << "";
  EXPECT_TRUE(held_directories(scratch.path()).empty());
  const auto directory = RuntimeDirectory::claim("m1", scratch.path());
  ASSERT_TRUE(directory.ok());
  EXPECT_FALSE(directory->stop_requested());
  EXPECT_EQ(held_directories(scratch.path()).at(0).holder, ::getpid());
}

TEST(RuntimeDirectoryTest, PassesOnARequestToStop) {
  Scratch scratch;
  const auto directory = RuntimeDirectory::claim("m1", scratch.path());
  ASSERT_TRUE(directory.ok());
  EXPECT_FALSE(directory->stop_requested());
  ASSERT_TRUE(request_stop(held_directories(scratch.path()).at(0)).ok());
  EXPECT_TRUE(directory->stop_requested());
}

TEST(RuntimeDirectoryTest, FollowsTheEnvironment) {
  ::setenv("ECITON_RUNTIME_DIR", "/somewhere/of/mine", 1);
  EXPECT_EQ(runtime_root(), "/somewhere/of/mine");
  ::unsetenv("ECITON_RUNTIME_DIR");
  ::setenv("XDG_RUNTIME_DIR", "/run/user/7", 1);
  EXPECT_EQ(runtime_root(), ::geteuid() == 0 ? "/run/eciton" : "/run/user/7/eciton");
}

TEST(RuntimeDirectoryTest, RefusesARootThatIsNoDirectory) {
  Scratch scratch;
  std::ofstream(scratch.file("root")) << "x";
  const auto directory = RuntimeDirectory::claim("m1", scratch.path() / "root");
  ASSERT_FALSE(directory.ok());
  EXPECT_NE(directory.error().message.find("ECITON_RUNTIME_DIR"), std::string::npos);
}

}  // namespace
}  // namespace eciton::deploy
