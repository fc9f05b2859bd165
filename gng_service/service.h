// SPDX-License-Identifier: BSD-3-Clause
// gng_service: newest cloud in, topology out. All of the algorithm is in ddgng/.
#pragma once

#include "runtime/service.h"

namespace gng_service {

runtime::ServiceDescription description();

}  // namespace gng_service
