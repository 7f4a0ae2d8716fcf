// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "oort/geometry/point_cloud.hpp"

namespace oort {

/// A list of clouds that never change once they are in it. Copies of the list share them, so that a snapshot of a map,
/// or the second copy that global SLAM works on, costs a pointer per cloud.
class PointClouds {
 public:
  using Shared = std::shared_ptr<const PointCloud>;

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = PointCloud;
    using difference_type = std::ptrdiff_t;
    using pointer = const PointCloud*;
    using reference = const PointCloud&;

    explicit Iterator(std::vector<Shared>::const_iterator place) : place_(place) {}
    reference operator*() const { return **place_; }
    pointer operator->() const { return place_->get(); }
    Iterator& operator++() {
      ++place_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return place_ == other.place_; }
    bool operator!=(const Iterator& other) const { return place_ != other.place_; }

   private:
    std::vector<Shared>::const_iterator place_;
  };

  PointClouds() = default;
  PointClouds(std::vector<PointCloud> clouds) {  // NOLINT(google-explicit-constructor): a list is a list
    for (PointCloud& cloud : clouds) push_back(std::move(cloud));
  }

  void push_back(PointCloud cloud) { clouds_.push_back(std::make_shared<const PointCloud>(std::move(cloud))); }
  void push_back(Shared cloud) { clouds_.push_back(std::move(cloud)); }
  void set(std::size_t k, PointCloud cloud) { clouds_[k] = std::make_shared<const PointCloud>(std::move(cloud)); }

  void set(std::size_t k, Shared cloud) { clouds_[k] = std::move(cloud); }

  std::size_t size() const { return clouds_.size(); }
  bool empty() const { return clouds_.empty(); }
  const PointCloud& operator[](std::size_t k) const { return *clouds_[k]; }
  const PointCloud& back() const { return *clouds_.back(); }
  const Shared& shared(std::size_t k) const { return clouds_[k]; }
  Iterator begin() const { return Iterator(clouds_.begin()); }
  Iterator end() const { return Iterator(clouds_.end()); }

 private:
  std::vector<Shared> clouds_;
};

}  // namespace oort
