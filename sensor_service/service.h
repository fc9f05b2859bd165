// SPDX-License-Identifier: BSD-3-Clause
// sensor_service: depth frames, inertial samples and poses in, point clouds out. All of the
// geometry is in tof/.
#pragma once

#include "runtime/service.h"

namespace sensor_service {

runtime::ServiceDescription description();

}  // namespace sensor_service
