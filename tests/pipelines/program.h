// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "datasets/readers/scene.h"
#include "pipelines/command/cli.h"

namespace sketchsplat {

namespace fs = std::filesystem;

struct Outcome {
  int status;
  std::string out, err;
};

inline std::string text_of_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline int count_lines(const std::string& text) {
  return int(std::count(text.begin(), text.end(), '\n'));
}

/// The built program and a folder of its own for each test.
class Program : public testing::Test {
 protected:
  Program() : folder_(fs::temp_directory_path() / ("sketchsplat." + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Program() override { fs::remove_all(folder_); }

  Outcome run(const std::string& arguments) const { return run_in(folder_, arguments); }

  static Outcome run_in(const fs::path& folder, const std::string& arguments) {
    const std::string id = std::to_string(getpid());  // the folder may be everybody's
    const std::string out = (folder / ("stdout." + id)).string();
    const std::string err = (folder / ("stderr." + id)).string();
    const std::string command = std::string("'") + SKETCHSPLAT_BINARY + "' " + arguments + " >'" +
                                out + "' 2>'" + err + "' </dev/null";
    const int status = std::system(command.c_str());
    const Outcome outcome = {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of_file(out),
                             text_of_file(err)};
    fs::remove(out);
    fs::remove(err);
    return outcome;
  }

  // Two views of a white square on black.
  std::string scene() const {
    const fs::path scene = folder_ / "scene";
    fs::create_directories(scene / "color");
    Image<float> image(64, 48, 0.0f);
    for (int y = 12; y < 36; ++y)
      for (int x = 16; x < 48; ++x) image.at(x, y) = 1;
    std::ofstream json(scene / "meta_data.json");
    json << R"({"camera_model": "OPENCV", "height": 48, "width": 64, "frames": [)";
    for (int k = 0; k < 2; ++k) {
      const std::string name = std::to_string(k) + "_colors.png";
      write_png((scene / "color" / name).string(), image);
      json << (k ? "," : "") << R"({"rgb_path": ")" << name << R"(", "camtoworld": [[1,0,0,)" << k
           << R"(],[0,1,0,0],[0,0,1,-4],[0,0,0,1]],)"
           << R"("intrinsics": [[90,0,31.5],[0,90,23.5],[0,0,1]]})";
    }
    json << "]}";
    return scene.string();
  }

  std::string in_folder(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

}  // namespace sketchsplat
