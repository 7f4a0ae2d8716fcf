// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstring>
#include <random>
#include <vector>

#include "oort/graph/block_cholesky.hpp"

namespace oort {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;

/// A positive definite matrix with blocks at a chain's pairs and some others, in a BlockCholesky and as it is.
class RandomMatrix {
 public:
  RandomMatrix(int size, int others, unsigned seed) : dense(Eigen::MatrixXd::Zero(3 * size, 3 * size)), random_(seed) {
    std::vector<BlockPair> pairs;
    for (int k = 1; k < size; ++k) pairs.push_back(k % 2 == 0 ? BlockPair{k - 1, k} : BlockPair{k, k - 1});
    std::uniform_int_distribution<int> index(0, size - 1);
    while (static_cast<int>(pairs.size()) < size - 1 + others) {
      const BlockPair pair = {index(random_), index(random_)};
      if (pair.i != pair.j) pairs.push_back(pair);
    }
    pairs.push_back({pairs[0].j, pairs[0].i});  // the first once more, the other way
    sparse.analyze(static_cast<std::size_t>(size), pairs);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const Eigen::Matrix3d block = random_block();
      sparse.add_pair(p, block);
      dense.block<3, 3>(3 * pairs[p].i, 3 * pairs[p].j) += block;
      dense.block<3, 3>(3 * pairs[p].j, 3 * pairs[p].i) += block.transpose();
    }
    for (int k = 0; k < size; ++k) {  // a dominant diagonal
      const Eigen::Matrix3d block = (1.0 + dense.middleRows(3 * k, 3).cwiseAbs().sum()) * Eigen::Matrix3d::Identity();
      sparse.add_diagonal(k, block);
      dense.block<3, 3>(3 * k, 3 * k) += block;
    }
  }

  Eigen::Matrix3d random_block() {
    Eigen::Matrix3d block;
    for (int k = 0; k < 9; ++k) block(k / 3, k % 3) = std::uniform_real_distribution<double>(-1.0, 1.0)(random_);
    return block;
  }

  Eigen::MatrixXd dense;
  BlockCholesky sparse;

 private:
  std::mt19937 random_;
};

Vectors vectors_of(const Eigen::VectorXd& b) {
  Vectors vectors;
  for (Eigen::Index k = 0; k < b.size(); k += 3) vectors.emplace_back(b.segment<3>(k));
  return vectors;
}

TEST(BlockCholesky, SolvesAsADenseSolverDoes) {
  for (const int size : {1, 2, 7, 60}) {
    RandomMatrix matrix(size > 2 ? size : 2, size > 2 ? size : 0, static_cast<unsigned>(size));
    const Eigen::Index rows = matrix.dense.rows();
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(rows, -1.0, 2.0);
    const Eigen::VectorXd damping = Eigen::VectorXd::LinSpaced(rows, 0.0, 1.0);
    ASSERT_TRUE(matrix.sparse.factorize(vectors_of(damping)));
    Vectors x = vectors_of(b);
    matrix.sparse.solve(x);
    const Eigen::MatrixXd damped = matrix.dense + Eigen::MatrixXd(damping.asDiagonal());
    const Vectors expected = vectors_of(damped.ldlt().solve(b));
    for (std::size_t k = 0; k < x.size(); ++k) EXPECT_LT((x[k] - expected[k]).norm(), 1e-12);
  }
}

TEST(BlockCholesky, FactorisesAgainAfterTheMatrixChanged) {
  RandomMatrix matrix(20, 10, 3);
  const Vectors none(20, Eigen::Vector3d::Zero());
  ASSERT_TRUE(matrix.sparse.factorize(none));
  matrix.sparse.add_diagonal(4, Eigen::Matrix3d::Identity());
  matrix.dense.block<3, 3>(12, 12) += Eigen::Matrix3d::Identity();
  ASSERT_TRUE(matrix.sparse.factorize(none));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(60);
  Vectors x = vectors_of(b);
  matrix.sparse.solve(x);
  const Vectors expected = vectors_of(matrix.dense.ldlt().solve(b));
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_LT((x[k] - expected[k]).norm(), 1e-12);
}

TEST(BlockCholesky, RefusesWhatIsNotPositiveDefinite) {
  RandomMatrix matrix(20, 10, 3);
  const Vectors none(20, Eigen::Vector3d::Zero());
  matrix.sparse.add_diagonal(7, -1e3 * Eigen::Matrix3d::Identity());
  EXPECT_FALSE(matrix.sparse.factorize(none));
  matrix.sparse.set_zero();
  EXPECT_FALSE(matrix.sparse.factorize(none));
  EXPECT_TRUE(matrix.sparse.factorize(Vectors(20, Eigen::Vector3d::Ones())));
}

TEST(BlockCholesky, SameMatrixGivesTheSameBits) {
  RandomMatrix first(50, 60, 9), second(50, 60, 9);
  const Vectors damping(50, Eigen::Vector3d::Constant(0.1));
  ASSERT_TRUE(first.sparse.factorize(damping) && second.sparse.factorize(damping));
  Vectors x(50, Eigen::Vector3d::Ones()), y = x;
  first.sparse.solve(x);
  second.sparse.solve(y);
  EXPECT_EQ(0, std::memcmp(x.data(), y.data(), x.size() * sizeof(Eigen::Vector3d)));
}

TEST(BlockCholesky, AChainFillsNothing) {
  BlockCholesky chain;
  std::vector<BlockPair> pairs;
  for (int k = 1; k < 100; ++k) pairs.push_back({k - 1, k});
  chain.analyze(100, pairs);
  EXPECT_EQ(chain.fill(), 99U);
}

}  // namespace
}  // namespace oort
