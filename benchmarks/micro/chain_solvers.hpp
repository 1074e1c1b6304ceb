// Contact wrenches of a chain as the general solvers find them, to be held against the recursion: (9) of
// LEGION, A c = d in the least-squares sense, d less the consistent common disturbance. Each is given its
// best case: memory and patterns are made once, the matrix is written in place, its structure is made use of.
//
// Not among them: leaving out the last member's equations, which the consistent disturbance makes redundant,
// leaves a block triangular system, and to solve that forward is the recursion.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseQR>
#include <span>
#include <vector>

#include "services/estimation/contact_wrench.hpp"

namespace eciton::bench {

/// A bent chain of `n` members whose links hold random wrenches, in a common wind. The same seed, the same chain.
std::vector<estimation::MemberWrench> made_up_chain(std::size_t n, unsigned seed);

/// Solves for the contact wrenches of members 0 to n-2 on the next, six numbers each: force, moment.
class ChainSolver {
 public:
  virtual ~ChainSolver() = default;
  virtual const Eigen::VectorXd& solve(std::span<const estimation::MemberWrench> members) = 0;
};

/// The yardstick of all: Householder QR of the whole matrix.
class DenseQr final : public ChainSolver {
 public:
  explicit DenseQr(std::size_t n);
  const Eigen::VectorXd& solve(std::span<const estimation::MemberWrench> members) override;

 private:
  Eigen::MatrixXd A_;
  Eigen::VectorXd d_, c_;
};

/// Cholesky of the normal equations as a symmetric band, number by number, as LAPACK's dpbsv.
class BandCholesky final : public ChainSolver {
 public:
  explicit BandCholesky(std::size_t n);
  const Eigen::VectorXd& solve(std::span<const estimation::MemberWrench> members) override;

 private:
  void factorize();
  void substitute();
  Eigen::MatrixXd band_;  // band_(i - j, j) = (A'A)(i, j), i >= j
  Eigen::VectorXd c_;
};

/// The same in blocks of 6 x 6 of fixed size: what a compiler can make the most of.
class BlockCholesky final : public ChainSolver {
 public:
  explicit BlockCholesky(std::size_t n);
  const Eigen::VectorXd& solve(std::span<const estimation::MemberWrench> members) override;

 private:
  std::vector<robot::Matrix6> diagonal_, below_;
  Eigen::VectorXd c_;
};

/// Sparse Cholesky of the normal equations, in the order of the chain.
class SparseCholesky final : public ChainSolver {
 public:
  explicit SparseCholesky(std::size_t n);
  const Eigen::VectorXd& solve(std::span<const estimation::MemberWrench> members) override;

 private:
  Eigen::SparseMatrix<double> normal_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> cholesky_;
  Eigen::VectorXd c_;
};

/// Sparse QR of the matrix itself, in the order of the chain: any other fills in.
class SparseQr final : public ChainSolver {
 public:
  explicit SparseQr(std::size_t n);
  const Eigen::VectorXd& solve(std::span<const estimation::MemberWrench> members) override;

 private:
  Eigen::SparseMatrix<double> A_;
  Eigen::SparseQR<Eigen::SparseMatrix<double>, Eigen::NaturalOrdering<int>> qr_;
  Eigen::VectorXd d_, c_;
};

}  // namespace eciton::bench
