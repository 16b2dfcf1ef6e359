// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sketchsplat {

/// A scene of a batch.
struct BatchScene {
  std::string name;    ///< of its result below the output folder; may have folders
  std::string folder;  ///< as `reconstruct` takes it
};

/// Which scenes a batch is made of.
struct SceneSearch {
  std::vector<std::string> roots;  ///< every scene folder in and below them
  std::vector<std::string> list;   ///< scene folders, there or not
  std::vector<std::string> match;  ///< globs of names or of their last parts; empty: all
  std::string format;              ///< of scene_formats(); empty: any
  std::string out;                 ///< the output folder: not looked into
};

/// The scenes by name, each once. Folders are recognised as `reconstruct` does; below a scene, and
/// in folders whose names begin with a dot, there are no others. Symbolic links are followed.
///
/// A name is the folder's path from the one root; with several roots, a root that is a scene, or a
/// list, from the folder that they have in common.
///
/// Folders that cannot be read add to `warnings`. Throws InputError (a root is no folder, or there
/// is no scene at all), UsageError (a scene lies in another; a result would overwrite its scene).
std::vector<BatchScene> find_scene_folders(const SceneSearch& search,
                                           std::vector<std::string>* warnings);

/// The folders in a file, one a line; empty lines and those that begin with # do not count. "-":
/// standard input. Throws InputError.
std::vector<std::string> read_scene_list(const std::string& path);

/// Whether a scene belongs to a shard (1 ... shards): decided by its name alone, so that shards
/// need not know one another.
bool in_shard(const std::string& name, int shard, int shards);

}  // namespace sketchsplat
