// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/segmentation.h"

namespace ddgng {
namespace {

/// The three neighbours of a face with the smallest angles to it, ties to the lowest index.
class NearestThree {
 public:
  void offer(int face_index, float cosine) {
    int place = size_;
    while (place > 0 && (cosine > cosine_[place - 1] ||
                         (cosine == cosine_[place - 1] && face_index < face_[place - 1]))) {
      --place;
    }
    if (place == 3) return;
    if (size_ < 3) ++size_;
    for (int i = size_ - 1; i > place; --i) {
      face_[i] = face_[i - 1];
      cosine_[i] = cosine_[i - 1];
    }
    face_[place] = face_index;
    cosine_[place] = cosine;
  }
  int size() const { return size_; }
  int face(int i) const { return face_[i]; }
  float cosine(int i) const { return cosine_[i]; }

 private:
  int size_ = 0;
  std::array<int, 3> face_{};
  std::array<float, 3> cosine_{};
};

}  // namespace

Segmentation::Segmentation(const StructureParams& params, int max_faces, int max_sides)
    : cosine_threshold_(static_cast<float>(cosine_of_degrees(params.segment_angle_deg))),
      sets_(max_faces) {
  first_at_side_.reserve(max_sides + 1);
  faces_at_side_.reserve(3 * max_faces);
  label_of_root_.reserve(max_faces);
}

void Segmentation::build(std::span<const std::array<int, 3>> face_sides, int num_sides,
                         Topology& topology) {
  group_by_side(face_sides, num_sides);
  sets_.reset(static_cast<int>(face_sides.size()));
  for (int face = 0; face < static_cast<int>(face_sides.size()); ++face) {
    join_neighbors(face, face_sides[face], topology);
  }
  make_labels(topology);
}

void Segmentation::group_by_side(std::span<const std::array<int, 3>> face_sides, int num_sides) {
  first_at_side_.assign(num_sides + 1, 0);
  for (const auto& sides : face_sides) {
    for (const int side : sides) ++first_at_side_[side];
  }
  int end = 0;
  for (int& place : first_at_side_) place = (end += place);
  faces_at_side_.resize(end);
  for (int face = static_cast<int>(face_sides.size()) - 1; face >= 0; --face) {
    for (const int side : face_sides[face]) faces_at_side_[--first_at_side_[side]] = face;
  }
}

// Eq. (2): w_ij < theta_seg, as cosines. A surface has at most three connections; where more than
// two surfaces meet at an edge, the three with the smallest angles count.
void Segmentation::join_neighbors(int face, const std::array<int, 3>& sides,
                                  const Topology& topology) {
  NearestThree nearest;
  for (const int side : sides) {
    for (int at = first_at_side_[side]; at < first_at_side_[side + 1]; ++at) {
      const int other = faces_at_side_[at];
      if (other == face) continue;
      nearest.offer(other, topology.faces[face].normal.dot(topology.faces[other].normal));
    }
  }
  for (int i = 0; i < nearest.size(); ++i) {
    if (nearest.cosine(i) > cosine_threshold_) sets_.join(face, nearest.face(i));
  }
}

void Segmentation::make_labels(Topology& topology) {
  topology.labels.clear();
  label_of_root_.assign(topology.faces.size(), -1);
  for (int i = 0; i < static_cast<int>(topology.faces.size()); ++i) {
    Face& face = topology.faces[i];
    const int root = sets_.root(i);
    if (root == i) {
      label_of_root_[i] = static_cast<int>(topology.labels.size());
      topology.labels.emplace_back();
      topology.labels.back().normal.setZero();
    }
    face.label = label_of_root_[root];
    Label& label = topology.labels[face.label];
    label.normal += face.normal;  // T_n
    label.area_m2 += face.area_m2;
    ++label.num_faces;  // L_n
  }
  for (Label& label : topology.labels)
    label.normal /= static_cast<float>(label.num_faces);  // Eq. (3)
}

}  // namespace ddgng
