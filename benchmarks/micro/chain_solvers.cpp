// The matrix of (9), block by block, and five ways to solve it.
#include "benchmarks/micro/chain_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/robot/chain_disturbance.hpp"

namespace eciton::bench {
namespace {

using estimation::MemberWrench;
using robot::Matrix3;
using robot::Matrix6;
using robot::Vector3;
using robot::Vector6;
using robot::Wrench;
using Members = std::span<const MemberWrench>;
using Index = Eigen::Index;

Index index(std::size_t i) { return static_cast<Index>(i); }

Matrix6 X(const Vector3& a) {
  Matrix6 out = Matrix6::Identity();
  out.bottomLeftCorner<3, 3>() = robot::skew(a);
  return out;
}

Vector3 link(Members members, std::size_t k) {
  return 0.5 * (members[k].port_to_next_W + members[k + 1].port_to_last_W);
}

/// Lever arms of link k from the member before it and from the one behind.
Vector3 before(Members members, std::size_t k) { return link(members, k) - members[k].r_W; }
Vector3 behind(Members members, std::size_t k) { return link(members, k) - members[k + 1].r_W; }

/// External wrenches less what is common to all, about each member's own r.
template <class Use>
void for_each_d(Members members, Use&& use) {
  const robot::ChainDisturbance common(members.size(), [&](std::size_t i) {
    return robot::ChainLoad{members[i].external_W, members[i].r_W, 1};
  });
  for (std::size_t i = 0; i < members.size(); ++i) use(i, members[i].external_W - common.share(members[i].r_W));
}

/// A'd: row k of it is -X(P_k - r_k)' d_k + X(P_k - r_{k+1})' d_{k+1}.
void normal_right_side(Members members, Eigen::VectorXd& out) {
  const auto turned = [](const Vector3& a, const Wrench& d) {  // X(a)' d
    Vector6 v;
    v << d.force - a.cross(d.moment), d.moment;
    return v;
  };
  for_each_d(members, [&](std::size_t i, const Wrench& d) {
    if (i + 1 < members.size()) out.segment<6>(index(6 * i)) = -turned(before(members, i), d);
    if (i > 0) out.segment<6>(index(6 * i) - 6) += turned(behind(members, i - 1), d);
  });
}

/// Blocks (k, k) and (k + 1, k) of A'A.
Matrix6 normal_diagonal(Members members, std::size_t k) {
  const Matrix3 s = robot::skew(before(members, k)), t = robot::skew(behind(members, k));
  Matrix6 out;
  out.topLeftCorner<3, 3>() = 2 * Matrix3::Identity() + s.transpose() * s + t.transpose() * t;
  out.bottomLeftCorner<3, 3>() = s + t;
  out.topRightCorner<3, 3>() = (s + t).transpose();
  out.bottomRightCorner<3, 3>() = 2 * Matrix3::Identity();
  return out;
}
Matrix6 normal_below(Members members, std::size_t k) {  // -X(P_{k+1} - r_{k+1})' X(P_k - r_{k+1})
  const Matrix3 s = robot::skew(before(members, k + 1)), t = robot::skew(behind(members, k));
  Matrix6 out;
  out.topLeftCorner<3, 3>() = -Matrix3::Identity() - s.transpose() * t;
  out.bottomLeftCorner<3, 3>() = -t;
  out.topRightCorner<3, 3>() = -s.transpose();
  out.bottomRightCorner<3, 3>() = -Matrix3::Identity();
  return out;
}

}  // namespace

std::vector<MemberWrench> made_up_chain(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  const auto v = [&](double size) {
    const auto u = [&] { return size * (2 * static_cast<double>(random()) / 4294967296.0 - 1); };
    const double x = u(), y = u(), z = u();
    return Vector3(x, y, z);
  };
  std::vector<MemberWrench> members(n);
  for (std::size_t i = 0; i < n; ++i) {
    members[i].known = true;
    members[i].r_W = Vector3(-0.8 * static_cast<double>(i), 0, 1) + v(0.2);
    members[i].external_W = {{1, 4, -0.5}, {0.02, -0.05, 0.1}};
  }
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Vector3 P = (members[i].r_W + members[i + 1].r_W) / 2 + v(0.05);
    const Wrench contact{v(3), v(0.4)};
    members[i].port_to_next_W = members[i + 1].port_to_last_W = P;
    members[i].external_W -= robot::shift(contact, P - members[i].r_W);
    members[i + 1].external_W += robot::shift(contact, P - members[i + 1].r_W);
  }
  return members;
}

DenseQr::DenseQr(std::size_t n) : A_(index(6 * n), index(6 * n - 6)), d_(index(6 * n)), c_(index(6 * n - 6)) {}

const Eigen::VectorXd& DenseQr::solve(Members members) {
  A_.setZero();
  for_each_d(members, [&](std::size_t i, const Wrench& d) { d_.segment<6>(index(6 * i)) << d.force, d.moment; });
  for (std::size_t k = 0; k + 1 < members.size(); ++k) {
    A_.block<6, 6>(index(6 * k), index(6 * k)) = -X(before(members, k));
    A_.block<6, 6>(index(6 * k + 6), index(6 * k)) = X(behind(members, k));
  }
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(A_);
  c_ = qr.solve(d_);
  return c_;
}

constexpr Index band_width = 11;

BandCholesky::BandCholesky(std::size_t n) : band_(band_width + 1, index(6 * n - 6)), c_(index(6 * n - 6)) {}

const Eigen::VectorXd& BandCholesky::solve(Members members) {
  const std::size_t links = members.size() - 1;
  band_.setZero();
  for (std::size_t k = 0; k < links; ++k) {
    const Matrix6 diagonal = normal_diagonal(members, k);
    for (Index j = 0; j < 6; ++j) {
      for (Index i = j; i < 6; ++i) band_(i - j, index(6 * k) + j) = diagonal(i, j);
    }
    if (k + 1 == links) break;
    const Matrix6 below = normal_below(members, k);
    for (Index j = 0; j < 6; ++j) {
      for (Index i = 0; i < 6; ++i) band_(6 + i - j, index(6 * k) + j) = below(i, j);
    }
  }
  normal_right_side(members, c_);
  factorize();
  substitute();
  return c_;
}

void BandCholesky::factorize() {
  for (Index j = 0; j < band_.cols(); ++j) {
    const Index reach = std::min(band_width, band_.cols() - 1 - j);
    const double pivot = std::sqrt(band_(0, j));
    band_(0, j) = pivot;
    auto column = band_.col(j).segment(1, reach);
    column /= pivot;
    for (Index k = 0; k < reach; ++k) {
      band_.col(j + 1 + k).head(reach - k) -= column[k] * column.tail(reach - k);
    }
  }
}

void BandCholesky::substitute() {
  for (Index j = 0; j < c_.size(); ++j) {
    const Index reach = std::min(band_width, c_.size() - 1 - j);
    c_[j] /= band_(0, j);
    c_.segment(j + 1, reach) -= c_[j] * band_.col(j).segment(1, reach);
  }
  for (Index j = c_.size() - 1; j >= 0; --j) {
    const Index reach = std::min(band_width, c_.size() - 1 - j);
    c_[j] = (c_[j] - band_.col(j).segment(1, reach).dot(c_.segment(j + 1, reach))) / band_(0, j);
  }
}

BlockCholesky::BlockCholesky(std::size_t n) : diagonal_(n - 1), below_(n - 1), c_(index(6 * n - 6)) {}

const Eigen::VectorXd& BlockCholesky::solve(Members members) {
  const std::size_t links = members.size() - 1;
  normal_right_side(members, c_);
  for (std::size_t k = 0; k < links; ++k) {
    auto c = c_.segment<6>(index(6 * k));
    Matrix6 rest = normal_diagonal(members, k);
    if (k > 0) {
      rest.noalias() -= below_[k - 1] * below_[k - 1].transpose();
      c.noalias() -= below_[k - 1] * c_.segment<6>(index(6 * k) - 6);
    }
    diagonal_[k] = rest.llt().matrixL();
    const auto L = diagonal_[k].triangularView<Eigen::Lower>();
    L.solveInPlace(c);
    if (k + 1 == links) break;
    Matrix6 transposed = normal_below(members, k).transpose();
    L.solveInPlace(transposed);
    below_[k] = transposed.transpose();
  }
  for (std::size_t k = links; k-- > 0;) {
    auto c = c_.segment<6>(index(6 * k));
    if (k + 1 < links) c.noalias() -= below_[k].transpose() * c_.segment<6>(index(6 * k) + 6);
    diagonal_[k].transpose().triangularView<Eigen::Upper>().solveInPlace(c);
  }
  return c_;
}

namespace {

/// Lower triangle of A'A by columns: the rest of its diagonal block, then the block below.
void write_normal(Members members, Eigen::SparseMatrix<double>& normal) {
  double* value = normal.valuePtr();
  for (std::size_t k = 0; k + 1 < members.size(); ++k) {
    const bool last = k + 2 == members.size();
    const Matrix6 diagonal = normal_diagonal(members, k);
    const Matrix6 below = last ? Matrix6::Zero() : normal_below(members, k);
    for (Index j = 0; j < 6; ++j) {
      for (Index i = j; i < 6; ++i) *value++ = diagonal(i, j);
      if (last) continue;
      for (Index i = 0; i < 6; ++i) *value++ = below(i, j);
    }
  }
}

/// A by columns; of the skew matrices only what is not always zero.
template <class Write>
void for_each_of_A(Members members, Write&& write) {
  for (std::size_t k = 0; k + 1 < members.size(); ++k) {
    const Matrix3 s = robot::skew(before(members, k)), t = robot::skew(behind(members, k));
    for (Index j = 0; j < 6; ++j) {
      for (const auto& [row, sign, skew] :
           {std::tuple(index(6 * k), -1.0, &s), std::tuple(index(6 * k + 6), 1.0, &t)}) {
        write(row + j, index(6 * k) + j, sign);
        for (Index i = 0; i < 3 && j < 3; ++i) {
          if (i != j) write(row + 3 + i, index(6 * k) + j, sign * (*skew)(i, j));
        }
      }
    }
  }
}

}  // namespace

SparseCholesky::SparseCholesky(std::size_t n) : normal_(index(6 * n - 6), index(6 * n - 6)), c_(index(6 * n - 6)) {
  std::vector<Eigen::Triplet<double>> pattern;
  for (Index j = 0; j < normal_.cols(); ++j) {
    const Index end = std::min(normal_.rows(), j - j % 6 + 12);
    for (Index i = j; i < end; ++i) pattern.emplace_back(static_cast<int>(i), static_cast<int>(j), 1.0);
  }
  normal_.setFromTriplets(pattern.begin(), pattern.end());
  cholesky_.analyzePattern(normal_);
}

const Eigen::VectorXd& SparseCholesky::solve(Members members) {
  write_normal(members, normal_);
  normal_right_side(members, c_);
  cholesky_.factorize(normal_);
  c_ = cholesky_.solve(c_);
  return c_;
}

SparseQr::SparseQr(std::size_t n) : A_(index(6 * n), index(6 * n - 6)), d_(index(6 * n)), c_(index(6 * n - 6)) {
  std::vector<Eigen::Triplet<double>> pattern;
  for_each_of_A(made_up_chain(n, 1), [&](Index i, Index j, double) {
    pattern.emplace_back(static_cast<int>(i), static_cast<int>(j), 1.0);
  });
  A_.setFromTriplets(pattern.begin(), pattern.end());
  A_.makeCompressed();
  qr_.analyzePattern(A_);
}

const Eigen::VectorXd& SparseQr::solve(Members members) {
  double* value = A_.valuePtr();
  for_each_of_A(members, [&](Index, Index, double number) { *value++ = number; });
  for_each_d(members, [&](std::size_t i, const Wrench& d) { d_.segment<6>(index(6 * i)) << d.force, d.moment; });
  qr_.factorize(A_);
  c_ = qr_.solve(d_);
  return c_;
}

}  // namespace eciton::bench
