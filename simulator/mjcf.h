// SPDX-License-Identifier: BSD-3-Clause
// A scene as MuJoCo's XML, and XML as a model.
#pragma once

#include <span>
#include <string>

#include <mujoco/mujoco.h>

#include "simulator/scene.h"

namespace simulator {

/// The scene's solids; brightness travels as the geom's grey value, the collision class is 2
/// against 1 (the robot). `include` names a file to be included, e.g. the robot; "" = none.
std::string to_mjcf(const Scene& scene, const std::string& include = "");

/// Name of the geom that a solid becomes.
std::string solid_name(std::size_t index);

struct MjcfFile {
  std::string name;
  std::string text;
};

/// Compiles the first file; the others may be included by it. The caller frees the model. Throws
/// std::runtime_error with MuJoCo's message.
mjModel* compile_mjcf(std::span<const MjcfFile> files);

}  // namespace simulator
