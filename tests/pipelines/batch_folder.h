// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>

#include "tests/pipelines/program.h"

namespace sketchsplat {

/// All files and folders below a folder, with their contents; without .batch, which may differ.
inline std::map<std::string, std::string> tree_of(const fs::path& folder) {
  std::map<std::string, std::string> tree;
  for (auto entry = fs::recursive_directory_iterator(folder);
       entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->path().filename() == ".batch") {
      entry.disable_recursion_pending();
      continue;
    }
    const std::string name = entry->path().lexically_relative(folder).string();
    tree[name] = entry->is_directory() ? "(folder)" : text_of_file(entry->path());
  }
  return tree;
}

/// What differs between two trees, in words; empty if nothing does.
inline std::string difference(const fs::path& a, const fs::path& b) {
  const auto left = tree_of(a), right = tree_of(b);
  std::string text;
  for (const auto& [name, bytes] : left)
    if (!right.count(name))
      text += "only in " + a.string() + ": " + name + "\n";
    else if (right.at(name) != bytes)
      text += "differs: " + name + "\n";
  for (const auto& [name, bytes] : right)
    if (!left.count(name)) text += "only in " + b.string() + ": " + name + "\n";
  return text;
}

/// A run of the program that goes on while a test does something else.
class Running {
 public:
  Running(const std::vector<std::string>& arguments, const std::string& err) {
    std::vector<char*> argv = {const_cast<char*>(SKETCHSPLAT_BINARY)};
    for (const std::string& text : arguments) argv.push_back(const_cast<char*>(text.c_str()));
    argv.push_back(nullptr);
    std::fflush(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      if (!std::freopen("/dev/null", "w", stdout) || !std::freopen(err.c_str(), "w", stderr))
        _exit(99);
      execv(argv[0], argv.data());
      _exit(99);
    }
  }
  ~Running() {
    if (pid_ <= 0) return;
    send(SIGKILL);
    wait();
  }
  pid_t pid() const { return pid_; }
  void send(int signal) const { ::kill(pid_, signal); }
  bool ended() {
    if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
    return pid_ < 0;
  }
  /// Its status as waitpid tells it.
  int wait() {
    if (pid_ > 0) waitpid(pid_, &status_, 0);
    pid_ = -1;
    return status_;
  }
  std::vector<pid_t> children() const {
    const std::string id = std::to_string(pid_);
    std::ifstream in("/proc/" + id + "/task/" + id + "/children");
    return {std::istream_iterator<pid_t>(in), std::istream_iterator<pid_t>()};
  }

 private:
  pid_t pid_ = -1;
  int status_ = 0;
};

}  // namespace sketchsplat
