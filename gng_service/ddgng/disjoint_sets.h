// SPDX-License-Identifier: BSD-3-Clause
// Union-find. The root of a set is its smallest member, so the result does not depend on the order
// of joining.
#pragma once

#include <numeric>
#include <utility>
#include <vector>

namespace ddgng {

class DisjointSets {
 public:
  explicit DisjointSets(int max_size) { parent_.reserve(max_size); }

  /// size sets of one member each.
  void reset(int size) {
    parent_.resize(size);
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int root(int member) {
    while (parent_[member] != member) {
      parent_[member] = parent_[parent_[member]];
      member = parent_[member];
    }
    return member;
  }

  void join(int a, int b) {
    int low = root(a);
    int high = root(b);
    if (low > high) std::swap(low, high);
    parent_[high] = low;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace ddgng
