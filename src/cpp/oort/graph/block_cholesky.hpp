// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
// Internal to the optimiser.
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace oort {

/// Two variables whose block of the matrix is not zero.
struct BlockPair {
  int i = 0;
  int j = 0;
};

/// Sparse Cholesky factorisation H = L L^T of a symmetric positive definite matrix of 3 x 3 blocks, one row of blocks
/// for each pose: up-looking, along the elimination tree (Davis 2006, "Direct Methods for Sparse Linear Systems",
/// chapter 4, with blocks for numbers), in an approximate minimum degree order.
/// One thread; the same matrix gives the same bits.
class BlockCholesky {
 public:
  /// Finds the order and the pattern of L. Pairs may repeat, in either direction; i != j.
  void analyze(std::size_t size, const std::vector<BlockPair>& pairs);

  std::size_t size() const { return order_.size(); }
  /// Blocks below the diagonal of L.
  std::size_t fill() const { return L_rows_.size(); }
  /// Products of blocks in one factorisation.
  std::size_t products() const { return products_; }

  /// The matrix to factorise. Adding goes on until set_zero.
  void set_zero();
  void add_diagonal(int i, const Eigen::Matrix3d& block) { diagonal_[position_of(i)] += block; }
  /// Adds H_ij (and H_ji, its transpose) to the pair that stood at this place of the argument of analyze.
  void add_pair(std::size_t pair, const Eigen::Matrix3d& H_ij);
  /// The diagonal of the matrix, three numbers for variable i.
  Eigen::Vector3d diagonal(int i) const { return diagonal_[position_of(i)].diagonal(); }

  /// Factorises the matrix with `damping` (one number for each number of the diagonal, by variable) added to the
  /// diagonal. False if that is not positive definite.
  bool factorize(const std::vector<Eigen::Vector3d>& damping);
  /// Overwrites b by the solution of the last factorised matrix times x = b.
  void solve(std::vector<Eigen::Vector3d>& b) const;

 private:
  /// Where a pair's block is stored, and whether as its transpose.
  struct Slot {
    std::size_t place = 0;
    bool transposed = false;
  };

  std::size_t position_of(int i) const { return static_cast<std::size_t>(position_[static_cast<std::size_t>(i)]); }
  void order(std::size_t size, const std::vector<BlockPair>& pairs);
  void place_blocks(const std::vector<BlockPair>& pairs);
  void find_pattern();
  int reach(int row, std::vector<int>& stack);

  std::vector<int> order_;     // the variable in each row
  std::vector<int> position_;  // its inverse
  // The matrix: blocks left of the diagonal row by row, each row's columns rising.
  std::vector<std::size_t> row_begin_;
  std::vector<int> columns_;
  std::vector<Eigen::Matrix3d> left_, diagonal_;
  std::vector<Slot> slots_;
  // L: columns of blocks below the diagonal, rows rising; of the diagonal blocks the inverses.
  std::vector<int> parent_;  // the elimination tree; -1 for a root
  std::vector<std::size_t> L_begin_, L_end_;
  std::vector<int> L_rows_;
  std::vector<Eigen::Matrix3d> L_, L_diagonal_inverse_;
  std::size_t products_ = 0;
  // Work space.
  std::vector<int> mark_;
  std::vector<Eigen::Matrix3d> row_;
};

}  // namespace oort
