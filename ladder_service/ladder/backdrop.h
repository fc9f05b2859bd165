// SPDX-License-Identifier: BSD-3-Clause
// What stands behind a bar, as the heads see it: decides what becomes of the pixels on its edges.
#pragma once

#include <Eigen/Core>

#include "ladder/axis.h"
#include "ladder/node_cloud.h"

namespace ladder {

/// A stretch of a bar and from where it is seen.
struct SeenStretch {
  Axis axis;
  double from_m = 0.0;
  double to_m = 0.0;
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();
};

/// Share of the stretch behind which the rays go on to something that is seen, 0..1.
double backed_share(const NodeCloud& cloud, const SeenStretch& bar);

}  // namespace ladder
