// SPDX-License-Identifier: MIT
#include "pipelines/cameras/find_cameras.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

#include "datasets/readers/colmap_model.h"
#include "datasets/readers/frame.h"
#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/child_lines.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

// A pair takes some 0.3 s of a core: all pairs of 60 photographs ten minutes, of 200 two hours.
constexpr int kMostForAllPairs = 60;
constexpr int kNeighbours = 6;  // on either side, of larger sets
constexpr int kFewestImages = 3;

struct Photographs {
  std::string folder;              // absolute
  std::vector<std::string> names;  // below it
  bool one_size = true;
  std::string list;  // a line for each: size of the file, its time, name
};

// Whether a file, by its path from the root on, lies in one of the folders below `root`.
bool lies_in(const fs::path& path, const std::vector<std::string>& folders, const fs::path& root) {
  for (const std::string& folder : folders) {
    std::error_code none;
    const fs::path real = fs::weakly_canonical(folder, none);
    const fs::path below = path.lexically_relative(real);
    if (real != root && !below.empty() && *below.begin() != "..") return true;
  }
  return false;
}

Photographs list_photographs(const std::string& folder, const std::vector<std::string>& others,
                             const RunLog& log) {
  std::error_code none;
  if (!fs::is_directory(folder, none))
    throw InputError(folder, "a folder of photographs",
                     fs::exists(folder, none) ? "a file" : "nothing");
  Photographs out;
  out.folder = fs::canonical(folder).string();
  std::ostringstream list;
  std::optional<ImageSize> first;
  for (const std::string& name : list_images(out.folder, true)) {
    const fs::path path = fs::path(out.folder) / name;
    if (lies_in(path, others, out.folder)) continue;
    ImageSize size;
    try {
      size = read_image_size(path.string());
    } catch (const InputError& e) {
      log.warn("photograph " + name + " is left out: " + e.what());
      continue;
    }
    if (!first) first = size;
    out.one_size &= size.width == first->width && size.height == first->height;
    out.names.push_back(name);
    list << fs::file_size(path, none) << ' '
         << fs::last_write_time(path, none).time_since_epoch().count() << ' ' << name << '\n';
  }
  if (int(out.names.size()) < kFewestImages)
    throw InputError(folder, "at least three photographs that can be read",
                     std::to_string(out.names.size()));
  out.list = list.str();
  return out;
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool has_model(const std::string& folder) {
  return has_colmap_model(folder + "/sparse/0");  // COLMAP counts from 0
}

void make_link(const std::string& target, const std::string& link) {
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(link, error))) fs::remove(link, error);
  fs::create_directory_symlink(target, link, error);
  if (error) throw OutputError(link, error.message());
}

/// COLMAP's commands, one after another, into one log.
class Colmap {
 public:
  Colmap(const std::string& folder, int threads)
      : folder_(folder),
        threads_(std::to_string(threads > 0 ? threads : -1)) {
    if (!has_program("colmap"))
      throw InputError("colmap",
                       "the program that finds cameras, of the package colmap (apt-get install "
                       "colmap), on the PATH",
                       "none");
    log_.open(log_path(), std::ios::trunc);
    if (!log_) throw OutputError(log_path(), "no file that can be made");
    // Version 4 calls the groups of these options by other names.
    bool renamed = false;
    run({"feature_extractor", "--help"}, [&](const std::string& line) {
      renamed |= line.find("FeatureExtraction.use_gpu") != std::string::npos;
    });
    extraction_ = renamed ? "--FeatureExtraction." : "--SiftExtraction.";
    matching_ = renamed ? "--FeatureMatching." : "--SiftMatching.";
  }

  std::string log_path() const { return folder_ + "/colmap.log"; }
  std::string database() const { return folder_ + "/database.db"; }

  /// Masks are not handed on, even where there are some: what stands around the object keeps still
  /// with it and has the texture that plain CAD parts lack, so that poses are better with it.
  void extract(const Photographs& photographs, Stage* stage) {
    const std::string names = folder_ + "/names.txt";
    write_atomically(names, [&](std::ostream& out) {
      for (const std::string& name : photographs.names) out << name << '\n';
    });
    std::vector<std::string> arguments = {"feature_extractor",
                                          "--database_path",
                                          database(),
                                          "--image_path",
                                          photographs.folder,
                                          "--image_list_path",
                                          names,
                                          extraction_ + "use_gpu",
                                          "0",
                                          extraction_ + "num_threads",
                                          threads_};
    // Photographs of one size are most likely of one camera, and together they tell its lens;
    // a single one tells no more than one term.
    const std::vector<std::string> camera =
        photographs.one_size
            ? std::vector<std::string>{"--ImageReader.single_camera", "1",
                                       "--ImageReader.camera_model", "OPENCV"}
            : std::vector<std::string>{"--ImageReader.camera_model", "SIMPLE_RADIAL"};
    arguments.insert(arguments.end(), camera.begin(), camera.end());
    must_run(arguments, counter("Processed file", int(photographs.names.size()), stage));
  }

  void match_all() {
    must_run({"exhaustive_matcher", "--database_path", database(), matching_ + "use_gpu", "0",
              matching_ + "num_threads", threads_});
  }

  void match_pairs(const std::vector<std::pair<std::string, std::string>>& pairs) {
    const std::string list = folder_ + "/pairs.txt";
    write_atomically(list, [&](std::ostream& out) {
      for (const auto& [a, b] : pairs) out << a << ' ' << b << '\n';
    });
    must_run({"matches_importer", "--database_path", database(), "--match_list_path", list,
              "--match_type", "pairs", matching_ + "use_gpu", "0", matching_ + "num_threads",
              threads_});
  }

  /// Into sparse/0 and so on. Ends badly if it finds nothing to start from, so that the result
  /// alone tells.
  void map(const Photographs& photographs, Stage* stage) {
    fs::create_directories(folder_ + "/sparse");
    run({"mapper", "--database_path", database(), "--image_path", photographs.folder,
         "--output_path", folder_ + "/sparse", "--Mapper.num_threads", threads_},
        counter("Registering image", int(photographs.names.size()), stage));
  }

 private:
  using OnLine = std::function<void(const std::string&)>;

  static OnLine counter(const std::string& words, int most, Stage* stage) {
    return [words, most, stage, count = 0](const std::string& line) mutable {
      if (line.find(words) != std::string::npos && count++ < most) stage->step();
    };
  }

  int run(const std::vector<std::string>& arguments, const OnLine& on_line) {
    std::vector<std::string> words = {"QT_QPA_PLATFORM=offscreen", "colmap"};  // needs no display
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_program("env", words, [&](const std::string& line) {
      log_ << line << std::endl;
      if (!line.empty()) last_words_ = line;
      if (on_line) on_line(line);
    });
  }

  void must_run(const std::vector<std::string>& arguments, const OnLine& on_line = nullptr) {
    last_words_.clear();
    const int status = run(arguments, on_line);
    if (status == 0) return;
    throw InputError("colmap " + arguments[0], "it to end well",
                     "exit status " + std::to_string(status) + " (" + last_words_ + "; " +
                         log_path() + " has all it said)");
  }

  std::string folder_, threads_, extraction_, matching_, last_words_;
  std::ofstream log_;
};

/// Pairs of larger sets. COLMAP's own ways to choose them need a vocabulary to download or GPS, or
/// take the photographs for a film that never comes back. People walk around an object in the order
/// of the names, and come back: neighbours on the circle, and some at distances that double.
std::vector<std::pair<std::string, std::string>> choose_pairs(
    const std::vector<std::string>& names) {
  const int n = int(names.size());
  std::set<std::pair<int, int>> pairs;
  const auto add = [&](int i, int step) {
    const int j = (i + step) % n;
    pairs.insert({std::min(i, j), std::max(i, j)});
  };
  for (int i = 0; i < n; ++i) {
    for (int step = 1; step <= kNeighbours; ++step) add(i, step);
    for (int step = 2 * kNeighbours; step <= n / 2; step *= 2) add(i, step);
  }
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& [i, j] : pairs) out.push_back({names[i], names[j]});
  return out;
}

void match(const Photographs& photographs, Colmap* colmap, const RunLog& log) {
  const int n = int(photographs.names.size());
  Stage stage("colmap matches", log);
  // A list of pairs has blanks between its names.
  const bool blanks = std::any_of(
      photographs.names.begin(), photographs.names.end(),
      [](const std::string& name) { return name.find_first_of(" \t") != std::string::npos; });
  if (n <= kMostForAllPairs || blanks) {
    colmap->match_all();
    stage.result("all pairs of " + std::to_string(n) + " photographs");
    return;
  }
  const auto pairs = choose_pairs(photographs.names);
  colmap->match_pairs(pairs);
  stage.result(std::to_string(pairs.size()) + " pairs of " + std::to_string(n) + " photographs");
}

}  // namespace

void find_cameras(const std::string& images, const std::vector<std::string>& others,
                  const std::string& folder, int threads, const RunLog& log) {
  const Photographs photographs = list_photographs(images, others, log);
  prepare_output_folder(folder);
  make_link(photographs.folder, folder + "/images");
  const std::string list = folder + "/photographs.txt";
  if (text_of(list) == photographs.list && has_model(folder)) {
    log.note("cameras of an earlier run are used: " + folder + "/sparse");
    return;
  }
  std::error_code ignored;
  for (const char* old : {"photographs.txt", "database.db", "sparse"})
    fs::remove_all(fs::path(folder) / old, ignored);
  Colmap colmap(folder, threads);
  {
    Stage stage("colmap features", log, int(photographs.names.size()));
    colmap.extract(photographs, &stage);
  }
  match(photographs, &colmap, log);
  {
    Stage stage("colmap cameras", log, int(photographs.names.size()));
    colmap.map(photographs, &stage);
    if (!has_model(folder))
      throw TooLittleError(
          images +
          ": expected photographs from which COLMAP finds cameras, found none to start "
          "from; take more of them, in steps of 10 degrees, with something printed under or "
          "around the object (" +
          colmap.log_path() + " has all it said)");
    stage.result(folder + "/sparse");
  }
  write_atomically(list, [&](std::ostream& out) { out << photographs.list; });
}

}  // namespace sketchsplat
