// Contact wrenches of a chain of N: the recursion that flies, and the general solvers beside it.
#include <memory>
#include <vector>

#include "benchmarks/micro/chain_solvers.hpp"
#include "benchmarks/micro/workload.hpp"

namespace eciton::bench {
namespace {

Step recursion(std::size_t n) {
  auto members = std::make_shared<std::vector<estimation::MemberWrench>>(made_up_chain(n, 7));
  auto contacts = std::make_shared<std::vector<estimation::MemberContact>>(n);
  return [members, contacts] {
    estimation::solve_contacts(*members, *contacts);
    return contacts->front().contact_W.force.x();
  };
}

template <class Solver>
Step solver(std::size_t n) {
  auto members = std::make_shared<std::vector<estimation::MemberWrench>>(made_up_chain(n, 7));
  auto made = std::make_shared<Solver>(n);
  return [members, made] { return made->solve(*members)[0]; };
}

}  // namespace

std::vector<Workload> contact_workloads() {
  struct Way {
    const char* name;
    Step (*make)(std::size_t);
    std::size_t n_max;  // dense QR grows with the cube: a second at 256
  };
  constexpr Way ways[] = {{"recursion", recursion, 1024},
                          {"dense_qr", solver<DenseQr>, 128},
                          {"band_cholesky", solver<BandCholesky>, 1024},
                          {"block_cholesky", solver<BlockCholesky>, 1024},
                          {"sparse_cholesky", solver<SparseCholesky>, 1024},
                          {"sparse_qr", solver<SparseQr>, 1024}};
  std::vector<Workload> list;
  for (const Way& way : ways) {
    for (std::size_t n = 2; n <= way.n_max; n *= 2) {
      const bool hot = way.make == recursion && (n == 2 || n == 8);
      list.push_back({std::string("contact_wrench/") + way.name + "/" + std::to_string(n),
                      [make = way.make, n] { return make(n); }, hot});
    }
  }
  return list;
}

}  // namespace eciton::bench
