// SPDX-License-Identifier: BSD-3-Clause
// The smallest use of the installed library: points on a floor become nodes.
#include <cstdint>
#include <cstdio>
#include <vector>

#include <base/rng.h>
#include <ddgng/ddgng.h>

int main() {
  base::Rng rng(1);
  std::vector<float> x_m, y_m, z_m;
  for (int i = 0; i < 10000; ++i) {
    x_m.push_back(static_cast<float>(rng.uniform()));
    y_m.push_back(static_cast<float>(rng.uniform()));
    z_m.push_back(0.0F);
  }
  const std::vector<std::uint8_t> head(x_m.size(), 0);
  ddgng::CloudView cloud;
  cloud.x_m = x_m;
  cloud.y_m = y_m;
  cloud.z_m = z_m;
  cloud.head = head;
  cloud.head_valid[0] = true;

  ddgng::DynamicDensityGng gng(ddgng::DdgngParams{});
  const ddgng::Topology& topology = gng.update(cloud);
  std::printf("%d nodes, %zu edges\n", topology.num_nodes(), topology.edges.size());
  return topology.num_nodes() > 50 && topology.edges.size() > 50 ? 0 : 1;
}
