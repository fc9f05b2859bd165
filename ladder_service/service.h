// SPDX-License-Identifier: BSD-3-Clause
// ladder_service: newest topology in, rungs and affordances out. All of the algorithm is in
// ladder/.
#pragma once

#include "runtime/service.h"

namespace ladder_service {

runtime::ServiceDescription description();

}  // namespace ladder_service
