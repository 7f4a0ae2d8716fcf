// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace oort {

void BlockCholesky::analyze(std::size_t size, const std::vector<BlockPair>& pairs) {
  order(size, pairs);
  place_blocks(pairs);
  find_pattern();
}

void BlockCholesky::order(std::size_t size, const std::vector<BlockPair>& pairs) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * pairs.size() + size);
  for (std::size_t k = 0; k < size; ++k) entries.emplace_back(static_cast<int>(k), static_cast<int>(k), 1.0);
  for (const BlockPair& pair : pairs) {
    entries.emplace_back(pair.i, pair.j, 1.0);
    entries.emplace_back(pair.j, pair.i, 1.0);
  }
  const auto n = static_cast<Eigen::Index>(size);
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation(n);
  if (size > 0) Eigen::AMDOrdering<int>()(pattern, permutation);
  order_.assign(permutation.indices().data(), permutation.indices().data() + size);
  position_.resize(size);
  for (std::size_t k = 0; k < size; ++k) position_[static_cast<std::size_t>(order_[k])] = static_cast<int>(k);
}

void BlockCholesky::place_blocks(const std::vector<BlockPair>& pairs) {
  std::vector<std::vector<int>> rows(size());
  const auto place = [this](const BlockPair& pair) {
    return std::minmax(position_[static_cast<std::size_t>(pair.i)], position_[static_cast<std::size_t>(pair.j)]);
  };
  for (const BlockPair& pair : pairs) {
    const auto [column, row] = place(pair);
    rows[static_cast<std::size_t>(row)].push_back(column);
  }
  row_begin_.assign(1, 0);
  columns_.clear();
  for (std::vector<int>& row : rows) {
    std::sort(row.begin(), row.end());
    columns_.insert(columns_.end(), row.begin(), std::unique(row.begin(), row.end()));
    row_begin_.push_back(columns_.size());
  }
  slots_.clear();
  for (const BlockPair& pair : pairs) {
    const auto [column, row] = place(pair);
    const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(row_begin_[static_cast<std::size_t>(row)]);
    const auto end = columns_.begin() + static_cast<std::ptrdiff_t>(row_begin_[static_cast<std::size_t>(row) + 1]);
    const auto found = std::lower_bound(begin, end, column);
    slots_.push_back(
        {static_cast<std::size_t>(found - columns_.begin()), column == position_[static_cast<std::size_t>(pair.i)]});
  }
  left_.resize(columns_.size());
  diagonal_.resize(size());
  set_zero();
}

void BlockCholesky::find_pattern() {
  const int n = static_cast<int>(size());
  parent_.assign(size(), -1);
  std::vector<int> ancestor(size(), -1);
  for (int row = 0; row < n; ++row) {
    for (std::size_t p = row_begin_[row]; p < row_begin_[row + 1]; ++p) {
      for (int k = columns_[p]; k != -1 && k < row;) {
        const int next = ancestor[k];
        ancestor[k] = row;
        if (next == -1) parent_[k] = row;
        k = next;
      }
    }
  }
  mark_.assign(size(), -1);
  std::vector<std::size_t> count(size(), 0);
  std::vector<int> stack(size());
  for (int row = 0; row < n; ++row) {
    for (int top = reach(row, stack); top < n; ++top) ++count[stack[top]];
  }
  products_ = 0;
  for (const std::size_t blocks : count) products_ += blocks * (blocks + 1) / 2;
  L_begin_.assign(1, 0);
  for (const std::size_t blocks : count) L_begin_.push_back(L_begin_.back() + blocks);
  L_end_.resize(size());
  L_rows_.resize(L_begin_.back());
  L_.resize(L_begin_.back());
  L_diagonal_inverse_.resize(size());
  row_.assign(size(), Eigen::Matrix3d::Zero());
}

/// Writes the columns of L that are not zero in this row into the end of the stack, each before those that depend on
/// it, and returns where they begin.
int BlockCholesky::reach(int row, std::vector<int>& stack) {
  int top = static_cast<int>(stack.size());
  mark_[row] = row;
  for (std::size_t p = row_begin_[row]; p < row_begin_[row + 1]; ++p) {
    int length = 0;  // of the path up the tree, kept in the unused front of the stack
    for (int k = columns_[p]; mark_[k] != row; k = parent_[k]) {
      stack[length++] = k;
      mark_[k] = row;
    }
    while (length > 0) stack[--top] = stack[--length];
  }
  return top;
}

void BlockCholesky::set_zero() {
  std::fill(left_.begin(), left_.end(), Eigen::Matrix3d::Zero());
  std::fill(diagonal_.begin(), diagonal_.end(), Eigen::Matrix3d::Zero());
}

void BlockCholesky::add_pair(std::size_t pair, const Eigen::Matrix3d& H_ij) {
  const Slot& slot = slots_[pair];
  if (slot.transposed) {
    left_[slot.place] += H_ij.transpose();
  } else {
    left_[slot.place] += H_ij;
  }
}

bool BlockCholesky::factorize(const std::vector<Eigen::Vector3d>& damping) {
  const int n = static_cast<int>(size());
  std::fill(mark_.begin(), mark_.end(), -1);
  std::fill(row_.begin(), row_.end(), Eigen::Matrix3d::Zero());
  std::copy(L_begin_.begin(), L_begin_.end() - 1, L_end_.begin());
  std::vector<int> stack(size());
  for (int row = 0; row < n; ++row) {
    // row_ becomes this row of L, transposed: L(0:row, 0:row) row_ = H(0:row, row)
    for (std::size_t p = row_begin_[row]; p < row_begin_[row + 1]; ++p) row_[columns_[p]] = left_[p].transpose();
    Eigen::Matrix3d rest = diagonal_[row];
    rest.diagonal() += damping[static_cast<std::size_t>(order_[row])];
    for (int top = reach(row, stack); top < n; ++top) {
      const int column = stack[top];
      const Eigen::Matrix3d block = L_diagonal_inverse_[column] * row_[column];
      row_[column].setZero();
      for (std::size_t p = L_begin_[column]; p < L_end_[column]; ++p) row_[L_rows_[p]].noalias() -= L_[p] * block;
      rest.noalias() -= block.transpose() * block;
      L_rows_[L_end_[column]] = row;
      L_[L_end_[column]] = block.transpose();
      ++L_end_[column];
    }
    const Eigen::LLT<Eigen::Matrix3d> cholesky(rest);
    if (cholesky.info() != Eigen::Success) return false;
    L_diagonal_inverse_[row] = cholesky.matrixL().solve(Eigen::Matrix3d::Identity());
    if (!L_diagonal_inverse_[row].allFinite()) return false;
  }
  return true;
}

void BlockCholesky::solve(std::vector<Eigen::Vector3d>& b) const {
  std::vector<Eigen::Vector3d> y(size());
  for (std::size_t k = 0; k < size(); ++k) y[k] = b[order_[k]];
  for (std::size_t k = 0; k < size(); ++k) {
    y[k] = (L_diagonal_inverse_[k] * y[k]).eval();
    for (std::size_t p = L_begin_[k]; p < L_begin_[k + 1]; ++p) y[L_rows_[p]].noalias() -= L_[p] * y[k];
  }
  for (std::size_t k = size(); k-- > 0;) {
    for (std::size_t p = L_begin_[k]; p < L_begin_[k + 1]; ++p) y[k].noalias() -= L_[p].transpose() * y[L_rows_[p]];
    y[k] = (L_diagonal_inverse_[k].transpose() * y[k]).eval();
  }
  for (std::size_t k = 0; k < size(); ++k) b[order_[k]] = y[k];
}

}  // namespace oort
