// SPDX-License-Identifier: MIT
#include "pipelines/base/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  AtomicFile() : folder_(fs::temp_directory_path() / ("atomic_file." + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~AtomicFile() override { fs::remove_all(folder_); }

  std::string text(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  int files() const {
    return int(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(AtomicFile, ReplacesTheOlderFile) {
  write_atomically(folder_ / "a", [](std::ostream& out) { out << "old"; });
  write_atomically(folder_ / "a", [](std::ostream& out) { out << "new"; });
  EXPECT_EQ(text("a"), "new");
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFile, LeavesNothingHalfWrittenWhenTheWriterThrows) {
  write_atomically(folder_ / "a", [](std::ostream& out) { out << "old"; });
  const auto broken = [](std::ostream& out) {
    out << "half" << std::flush;
    throw std::runtime_error("in the middle");
  };
  EXPECT_THROW(write_atomically(folder_ / "a", broken), std::runtime_error);
  EXPECT_EQ(text("a"), "old");
  EXPECT_THROW(write_atomically(folder_ / "b", broken), std::runtime_error);
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFile, FailedStreamIsAnOutputError) {
  EXPECT_THROW(
      write_atomically(folder_ / "a", [](std::ostream& out) { out.setstate(std::ios::failbit); }),
      OutputError);
  EXPECT_EQ(files(), 0);
}

TEST_F(AtomicFile, FullDiskIsAnOutputError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const fs::path link = folder_ / ("a.part" + std::to_string(getpid()));
  fs::create_symlink("/dev/full", link);
  EXPECT_THROW(write_atomically(folder_ / "a", [](std::ostream& out) { out << "text"; }),
               OutputError);
  EXPECT_EQ(files(), 0);
}

TEST_F(AtomicFile, PlaceThatCannotBeWrittenIsNamed) {
  std::ofstream(folder_ / "file") << "x";
  const auto nothing = [](std::ostream&) {};
  for (const fs::path& path : {folder_ / "missing" / "a", folder_ / "file" / "a", folder_}) {
    try {
      write_atomically(path, nothing);
      FAIL() << path;
    } catch (const OutputError& e) {
      EXPECT_THAT(e.what(), testing::StartsWith(path.string() + ": "));
    }
  }
}

TEST_F(AtomicFile, FolderIsMadeWithItsParentsAndLeftEmpty) {
  prepare_output_folder(folder_ / "a" / "b");
  EXPECT_TRUE(fs::is_empty(folder_ / "a" / "b"));
  EXPECT_NO_THROW(prepare_output_folder(folder_ / "a" / "b")) << "again";
}

TEST_F(AtomicFile, FolderInPlaceOfAFileIsRefused) {
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THROW(prepare_output_folder(folder_ / "file"), OutputError);
  EXPECT_THROW(prepare_output_folder(folder_ / "file" / "below"), OutputError);
  EXPECT_THROW(prepare_output_folder("/proc/sketchsplat"), OutputError);
  EXPECT_THROW(prepare_output_folder(""), OutputError);
  EXPECT_THROW(prepare_output_folder(folder_ / std::string(300, 'a')), OutputError);
}

}  // namespace
}  // namespace sketchsplat
