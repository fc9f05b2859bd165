// SPDX-License-Identifier: BSD-3-Clause
// A word that both sides know (viewer, relay). It keeps curious people on the same network out; it
// is sent in the clear, so whoever may listen to the cable must not be trusted less than the rest.
#pragma once

#include <string>
#include <string_view>

namespace runtime {

/// The first line of a file, at least 16 characters of [0-9A-Za-z_-]; throws std::runtime_error
/// that says how to make one.
std::string read_token(const std::string& path);

/// Takes as long for a wrong token as for the right one.
bool is_same_token(std::string_view given, std::string_view wanted);

}  // namespace runtime
