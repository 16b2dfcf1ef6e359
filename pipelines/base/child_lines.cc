// SPDX-License-Identifier: MIT
#include "pipelines/base/child_lines.h"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace sketchsplat {
namespace {

// One word of a shell's command, whatever it holds.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

int exit_status(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

bool has_program(const std::string& name) {
  return std::system(("command -v " + quoted(name) + " >/dev/null 2>&1").c_str()) == 0;
}

int run_program(const std::string& name, const std::vector<std::string>& arguments,
                const std::function<void(const std::string&)>& line) {
  std::string command = "exec " + quoted(name);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  FILE* pipe = popen((command + " 2>&1 </dev/null").c_str(), "re");
  if (!pipe) throw std::runtime_error("no process can be made");
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) {
    if (c != '\n' && c != '\r') {  // a bar that is drawn over itself ends its lines by \r
      text += char(c);
      continue;
    }
    line(text);
    text.clear();
  }
  if (!text.empty()) line(text);
  return exit_status(pclose(pipe));
}

}  // namespace sketchsplat
