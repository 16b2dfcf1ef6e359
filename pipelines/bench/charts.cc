// SPDX-License-Identifier: MIT
#include "pipelines/bench/charts.h"

#include <unistd.h>

#include <cstdio>

#include "pipelines/base/plugin_path.h"

namespace sketchsplat {
namespace {

std::string quoted(const std::string& text) {
  std::string all = "'";
  for (const char c : text) all += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return all + "'";
}

}  // namespace

void write_charts(const std::string& out, Progress* progress) {
  // Debian's, whose packages are what a user is told to install; others where there is none.
  const std::string python =
      access("/usr/bin/python3", X_OK) == 0 ? "/usr/bin/python3 " : "python3 ";
  const std::string script = plugin_path("charts.py", SKETCHSPLAT_EVAL_FOLDER);
  const std::string command = python + quoted(script) + " " + quoted(out);
  std::string said;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  char part[256];
  while (pipe && std::fgets(part, sizeof part, pipe)) said += part;
  const bool done = pipe && pclose(pipe) == 0;
  while (!said.empty() && said.back() == '\n') said.pop_back();
  if (done)
    progress->info(said);
  else
    progress->warn(
        "no charts: " + command +
        " makes them (packages python3, python3-matplotlib): " + said.substr(said.rfind('\n') + 1));
}

}  // namespace sketchsplat
