// SPDX-License-Identifier: BSD-3-Clause
// Between messages and the library's structures: no arithmetic beyond copying.
#pragma once

#include "ddgng/cloud.h"
#include "ddgng/topology.h"
#include "ladder_msgs/point_cloud_t.hpp"
#include "ladder_msgs/topology_t.hpp"

namespace gng_service {

/// The view is valid as long as the message.
ddgng::CloudView to_cloud_view(const ladder_msgs::point_cloud_t& message, float time_step_s);

/// Fills everything but seq.
void to_message(const ddgng::Topology& topology, const ladder_msgs::point_cloud_t& cloud,
                ladder_msgs::topology_t& message);

}  // namespace gng_service
