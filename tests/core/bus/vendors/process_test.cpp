// Plugins in processes of their own: pairs and fleets of either vendor find each other, and every one hears state and
// sensor samples of all the others.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/native_peers/child_process.hpp"

namespace eciton::bus {
namespace {

using native_peers::ChildProcess;

void expect_all_hear_all(const std::vector<std::string>& vendors, std::uint32_t domain, const std::string& peer) {
  const std::string program = native_peers::beside_this_program("vendors_peer");
  std::vector<std::unique_ptr<ChildProcess>> fleet;
  for (std::size_t k = 0; k < vendors.size(); ++k) {
    std::vector<std::string> command = {program, vendors[k], std::to_string(domain), std::to_string(k + 1),
                                        std::to_string(vendors.size())};
    if (!peer.empty()) command.push_back(peer);
    fleet.push_back(std::make_unique<ChildProcess>(command));
  }
  for (const auto& process : fleet) {
    EXPECT_TRUE(process->wait_until_end(std::chrono::seconds(40)));
    EXPECT_EQ(process->exit_status(), 0) << process->output();
  }
}

std::uint32_t domain_of_this_run() { return 100 + static_cast<std::uint32_t>(getpid()) % 100; }

class ProcessTest : public testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  std::vector<std::string> pair() const { return {std::get<0>(GetParam()), std::get<1>(GetParam())}; }
};

TEST_P(ProcessTest, TwoFindEachOtherByMulticast) { expect_all_hear_all(pair(), domain_of_this_run(), ""); }

TEST_P(ProcessTest, TwoFindEachOtherAsUnicastPeers) {
  expect_all_hear_all(pair(), domain_of_this_run() + 1, "127.0.0.1");
}

INSTANTIATE_TEST_SUITE_P(Vendors, ProcessTest,
                         testing::Combine(testing::Values("fastdds", "cyclonedds"),
                                          testing::Values("fastdds", "cyclonedds")),
                         [](const auto& vendors) {
                           return std::string(std::get<0>(vendors.param)) + "_and_" + std::get<1>(vendors.param);
                         });

TEST(FleetTest, SixOfBothVendorsHearEachOther) {
  expect_all_hear_all({"cyclonedds", "fastdds", "cyclonedds", "fastdds", "cyclonedds", "fastdds"},
                      domain_of_this_run() + 2, "");
}

}  // namespace
}  // namespace eciton::bus
