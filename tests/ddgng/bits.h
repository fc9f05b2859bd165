// SPDX-License-Identifier: BSD-3-Clause
// One number for all bits of a topology after many signals in a moving scene, to compare compilers,
// instruction sets and machines by.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "ddgng/ddgng.h"
#include "room.h"

namespace ddgng {

/// FNV-1a over whatever is added.
class BitHash {
 public:
  void add(const void* bytes, std::size_t num) {
    for (std::size_t i = 0; i < num; ++i) {
      value_ = (value_ ^ static_cast<const std::uint8_t*>(bytes)[i]) * 0x100000001B3ULL;
    }
  }
  template <typename T>
  void add(const std::vector<T>& values) {
    add(values.data(), values.size() * sizeof(T));
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

inline void add_topology(BitHash& hash, const Topology& t) {
  hash.add(t.node_id);
  for (const auto* values : {&t.node_x_m, &t.node_y_m, &t.node_z_m, &t.node_strength,
                             &t.node_error_m2, &t.node_utility_m2}) {
    hash.add(*values);
  }
  hash.add(t.node_class);
  hash.add(t.node_object);
  hash.add(t.node_plane);
  hash.add(t.moments);
  hash.add(t.edges);
  hash.add(t.faces);
  for (const Label& label : t.labels) hash.add(&label.area_m2, sizeof(float));
  for (const Plane& plane : t.planes) hash.add(&plane, sizeof(float) * 4);
  for (const Object& object : t.objects) hash.add(object.center_m.data(), 3 * sizeof(float));
}

/// Frames of a room that the heads walk through (the points move by 5 mm per frame), each of 5000
/// signals; the hash covers every frame's whole topology.
inline std::uint64_t bits_after(int num_signals, int max_nodes = 1000) {
  DdgngParams params;
  params.growing.max_nodes = max_nodes;
  DynamicDensityGng gng(params);
  Room room = RoomBuilder(7).build(60000);
  BitHash hash;
  const int signals_per_frame = params.growing.uniform_signals + params.growing.attention_signals;
  for (int frame = 0; frame * signals_per_frame < num_signals; ++frame) {
    for (float& x_m : room.x_m) x_m -= frame % 200 < 100 ? 0.005F : -0.005F;
    add_topology(hash, gng.update(room.view(static_cast<std::uint64_t>(frame))));
  }
  return hash.value();
}

}  // namespace ddgng
