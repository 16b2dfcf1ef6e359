// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace sketchsplat {

/// Whether a shell would find a program of this name.
bool has_program(const std::string& name);

/// Runs a program, found as a shell would, and hands on every line that it prints, to stdout or
/// stderr, as it comes. It reads nothing. Returns its exit status; 128 + the signal that ended it.
/// Throws std::runtime_error if no process can be made.
int run_program(const std::string& name, const std::vector<std::string>& arguments,
                const std::function<void(const std::string&)>& line);

}  // namespace sketchsplat
