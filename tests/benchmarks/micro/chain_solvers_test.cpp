// All ways to solve for a chain's contact wrenches come to the same: else their times say nothing.
#include "benchmarks/micro/chain_solvers.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace eciton::bench {
namespace {

Eigen::VectorXd recursion(const std::vector<estimation::MemberWrench>& members) {
  std::vector<estimation::MemberContact> contacts(members.size());
  EXPECT_TRUE(estimation::solve_contacts(members, contacts).complete);
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * members.size() - 6));
  for (std::size_t k = 0; k + 1 < members.size(); ++k) {
    out.segment<6>(static_cast<Eigen::Index>(6 * k)) << contacts[k].contact_W.force, contacts[k].contact_W.moment;
  }
  return out;
}

template <class Solver>
class ChainSolverTest : public testing::Test {};
using Solvers = testing::Types<DenseQr, BandCholesky, BlockCholesky, SparseCholesky, SparseQr>;
TYPED_TEST_SUITE(ChainSolverTest, Solvers);

TYPED_TEST(ChainSolverTest, AgreesWithTheRecursionForChainsOfAnyLength) {
  for (const std::size_t n : {2u, 3u, 8u, 33u}) {
    TypeParam solver(n);
    for (const unsigned seed : {1u, 2u}) {  // used again: nothing of the first chain is left
      const auto members = made_up_chain(n, seed);
      const Eigen::VectorXd expected = recursion(members);
      EXPECT_GT(expected.norm(), 1);
      EXPECT_LT((solver.solve(members) - expected).norm(), 1e-8 * expected.norm()) << n;
    }
  }
}

TYPED_TEST(ChainSolverTest, WouldNotAgreeOnAnotherChain) {
  TypeParam solver(8);
  EXPECT_GT((solver.solve(made_up_chain(8, 1)) - recursion(made_up_chain(8, 2))).norm(), 1);
}

TEST(SolveContactsTest, HoldsBeyondTheServicesLargestChainAndOverwritesWhatWasThere) {
  const auto members = made_up_chain(40, 3);
  std::vector<estimation::MemberContact> used(40);
  for (auto& contact : used) contact.contact_W.force.setConstant(9);
  estimation::solve_contacts(members, used);
  EXPECT_EQ(used.back().contact_W.force.norm(), 0);
  // The same as the service's own on the lengths that it knows.
  const auto few = made_up_chain(16, 3);
  const estimation::ContactWrenches whole = estimation::contact_wrenches(few);
  std::vector<estimation::MemberContact> parts(16);
  estimation::solve_contacts(few, parts);
  for (std::size_t k = 0; k < 16; ++k) EXPECT_EQ(whole.members[k].contact_W.force, parts[k].contact_W.force);
}

}  // namespace
}  // namespace eciton::bench
