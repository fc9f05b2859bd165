// SPDX-License-Identifier: BSD-3-Clause
// The devices that the configuration names, as sources. Not LCM: that is the service's own.
#pragma once

#include <memory>
#include <vector>

#include "sources/frame_source.h"
#include "sources/params.h"
#include "sources/ready_set.h"

namespace sources {

/// In the order in which they are to be polled: the inertial unit, then the heads. Empty with
/// Kind::kLcm. `ready` outlives them. Nothing is opened yet.
std::vector<std::unique_ptr<FrameSource>> make_device_sources(const SourceParams& params,
                                                              ReadySet& ready);

}  // namespace sources
