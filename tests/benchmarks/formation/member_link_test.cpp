// Orders and news over a real socket.
#include "benchmarks/formation/member_link.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

namespace eciton::bench {
namespace {

std::filesystem::path scratch() { return testing::TempDir() + "members-" + std::to_string(::getpid()); }

TEST(MemberLinkTest, CarriesWholeMessagesBothWaysAndNoticesTheEnd) {
  const auto path = scratch();
  auto listener = MemberListener::open(path);
  ASSERT_TRUE(listener) << listener.error().message;
  EXPECT_FALSE(listener->accept());
  auto member = MemberLink::connect(path);
  ASSERT_TRUE(member) << member.error().message;
  auto caller = listener->accept();
  ASSERT_TRUE(caller);

  EXPECT_TRUE(caller->send(MemberOrder{.what = MemberOrder::What::latch, .port = 1, .peer = 62, .peer_port = 0}));
  EXPECT_TRUE(caller->send(MemberOrder{.what = MemberOrder::What::release, .port = 1}));
  const auto first = member->take_order();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->what, MemberOrder::What::latch);
  EXPECT_EQ(first->peer, 62u);
  EXPECT_EQ(member->take_order()->what, MemberOrder::What::release);
  EXPECT_FALSE(member->take_order());
  EXPECT_TRUE(member->is_open());

  EXPECT_TRUE(member->send(MemberNews{.what = MemberNews::What::view, .module_id = 62, .epoch = 7, .members = 3}));
  const auto news = caller->take_news();
  ASSERT_TRUE(news);
  EXPECT_EQ(news->epoch, 7u);

  { const MemberLink gone = std::move(*member); }
  EXPECT_FALSE(caller->take_news());
  EXPECT_FALSE(caller->is_open());
}

TEST(MemberLinkTest, APathThatNobodyServesOrThatIsTooLongIsNamed) {
  const auto nobody = MemberLink::connect("/nonexistent/socket");
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().message.find("/nonexistent/socket"), std::string::npos);
  EXPECT_FALSE(MemberListener::open("/tmp/" + std::string(200, 'x')));
}

}  // namespace
}  // namespace eciton::bench
