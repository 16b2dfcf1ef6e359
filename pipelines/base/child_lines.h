// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace sketchsplat {

/// Path of a program that a shell would find by its name; empty if there is none.
std::string find_program(const std::string& name);

/// Runs a program and hands on every line that it prints, to stdout or stderr, as it comes. It
/// reads nothing and dies with its parent. `environment`: "NAME=value" beside our own. Returns its
/// exit status; 128 + the signal that ended it. Throws std::runtime_error if no process can be
/// made.
int run_program(const std::string& path, const std::vector<std::string>& arguments,
                const std::vector<std::string>& environment,
                const std::function<void(const std::string&)>& line);

}  // namespace sketchsplat
