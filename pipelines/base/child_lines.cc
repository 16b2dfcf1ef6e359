// SPDX-License-Identifier: MIT
#include "pipelines/base/child_lines.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (const std::string& text : texts) out.push_back(const_cast<char*>(text.c_str()));
  out.push_back(nullptr);
  return out;
}

std::vector<std::string> with_our_own(std::vector<std::string> environment) {
  const size_t given = environment.size();
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry, name = text.substr(0, text.find('=') + 1);
    bool replaced = false;
    for (size_t i = 0; i < given; ++i)
      replaced |= environment[i].compare(0, name.size(), name) == 0;
    if (!replaced) environment.push_back(text);
  }
  return environment;
}

// What the child does between fork and exec: nothing that takes a lock.
[[noreturn]] void become(const char* path, char* const* argv, char* const* envp, int out,
                         pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int null = open("/dev/null", O_RDONLY);
  if (getppid() != parent || null < 0) _exit(127);
  dup2(null, 0);
  dup2(out, 1);
  dup2(out, 2);
  execve(path, argv, envp);
  _exit(127);
}

// Until the other end is closed. A bar that is drawn over itself ends its lines by \r.
void read_lines(int fd, const std::function<void(const std::string&)>& line) {
  std::string text;
  char bytes[4096];
  for (ssize_t n; (n = read(fd, bytes, sizeof bytes)) > 0 || (n < 0 && errno == EINTR);)
    for (ssize_t i = 0; i < n; ++i) {
      if (bytes[i] != '\n' && bytes[i] != '\r') {
        text += bytes[i];
      } else {
        line(text);
        text.clear();
      }
    }
  if (!text.empty()) line(text);
}

}  // namespace

std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (fs::path(folder.empty() ? "." : folder) / name).string();
    std::error_code none;
    if (fs::is_regular_file(file, none) && access(file.c_str(), X_OK) == 0) return file;
  }
  return "";
}

int run_program(const std::string& path, const std::vector<std::string>& arguments,
                const std::vector<std::string>& environment,
                const std::function<void(const std::string&)>& line) {
  std::vector<std::string> words = {path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const std::vector<std::string> variables = with_our_own(environment);
  const std::vector<char*> argv = pointers(words), envp = pointers(variables);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe can be made");
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0) throw std::runtime_error("no process can be made");
  if (pid == 0) become(path.c_str(), argv.data(), envp.data(), ends[1], parent);
  close(ends[1]);
  read_lines(ends[0], line);
  close(ends[0]);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace sketchsplat
