// SPDX-License-Identifier: BSD-3-Clause
// Between messages and the library's structures: no arithmetic beyond copying.
#pragma once

#include "ladder/estimate.h"
#include "ladder/node_cloud.h"
#include "ladder_msgs/ladder_t.hpp"
#include "ladder_msgs/topology_t.hpp"

namespace ladder_service {

void to_node_cloud(const ladder_msgs::topology_t& message, ladder::NodeCloud& cloud);

/// Fills everything but seq.
void to_message(const ladder::LadderEstimate& estimate, const ladder_msgs::topology_t& topology,
                ladder_msgs::ladder_t& message);

}  // namespace ladder_service
