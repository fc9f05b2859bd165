// SPDX-License-Identifier: BSD-3-Clause
// Dynamic density growing neural gas (Algorithm 1 of Saputra et al., IROS 2019): one call per point
// cloud turns the previous frame's topology into this frame's. The output depends on the parameters
// and the sequence of clouds alone, bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ddgng/attention.h"
#include "ddgng/cloud.h"
#include "ddgng/growing.h"
#include "ddgng/moments.h"
#include "ddgng/params.h"
#include "ddgng/sampler.h"
#include "ddgng/snapshot.h"
#include "ddgng/structure.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace ddgng {

struct DdgngParams {
  GrowingParams growing;
  StructureParams structure;
  int max_points = 153216;  ///< of one cloud, >= 1; the default is four full heads
};

/// "" or the violated relation in words, naming the field.
std::string check(const DdgngParams& params);

class DynamicDensityGng {
 public:
  /// check(params) must be "". Reserves all memory.
  explicit DynamicDensityGng(const DdgngParams& params);

  /// One frame. cloud.size() <= max_points. An empty cloud leaves the nodes as they are. The result
  /// is valid until the next call.
  const Topology& update(const CloudView& cloud);
  const Topology& topology() const { return topology_; }

  /// Forgets everything, as after construction: a new recording begins.
  void reset();

  const Growing::Counts& counts() const { return growing_.counts(); }
  /// Points in the suspected area of the last frame.
  std::size_t num_suspected_points() const { return num_suspected_points_; }

 private:
  bool start(const CloudView& cloud);
  void boot(const CloudView& cloud);
  std::span<const std::uint32_t> attend(const CloudView& cloud);
  void learn(std::span<const Signal> signals, int max_plane_nodes);
  void insertion_round(int round, int max_plane_nodes);
  void insert(Growing::Weighting weighting);
  bool suspected(int slot) const;
  void set_strengths();
  void build_topology(const CloudView& cloud);

  DdgngParams params_;
  Sampler sampler_;
  Growing growing_;
  Moments moments_;
  Snapshot snapshot_;
  StructureBuilder structure_;
  Attention attention_;
  Topology topology_;
  bool steered_ = false;  ///< the suspected area holds points
  std::size_t num_suspected_points_ = 0;
};

}  // namespace ddgng
