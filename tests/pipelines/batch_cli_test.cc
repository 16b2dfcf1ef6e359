// SPDX-License-Identifier: MIT
// Folders of scenes, through the program alone.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/mount.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/pipelines/batch_folder.h"
#include "tests/support/sanitizer.h"

namespace sketchsplat {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Batch : public Program {
 protected:
  // Three small scenes with truth, in two groups, for all tests of this file.
  static void SetUpTestSuite() {
    scenes_ = fs::temp_directory_path() / ("sketchsplat_batch." + std::to_string(getpid()));
    fs::create_directories(scenes_ / ".made");
    for (const char* name : {"a/box", "a/ring", "b/box"})
      Program::run_in(scenes_ / ".made",
                      "synthesize box --views 12 --resolution 160 --outputs none --quiet --seed " +
                          std::to_string(name[0] + name[2]) + " --out " +
                          (scenes_ / name).string());
  }
  static void TearDownTestSuite() { fs::remove_all(scenes_); }

  Outcome batch(const std::string& arguments, const std::string& out = "results") const {
    return run("batch " + scenes_.string() + " --preset fast " + arguments + " --out " +
               in_folder(out));
  }
  json summary(const std::string& out = "results") const {
    return json::parse(text_of_file(folder_ / out / "summary.json"));
  }
  std::vector<std::string> states(const std::string& out = "results") const {
    std::vector<std::string> all;
    const json now = summary(out);
    for (const json& s : now["scenes"])
      all.push_back(s["scene"].get<std::string>() + " " + s["state"].get<std::string>());
    return all;
  }
  std::vector<fs::file_time_type> times() const {
    std::vector<fs::file_time_type> all;
    for (const char* name : {"a/box", "a/ring", "b/box"})
      all.push_back(fs::last_write_time(folder_ / "results" / name / "report.json"));
    return all;
  }
  // A root of its own with a good scene and one more.
  std::string root_with(const std::string& name, const std::string& file, const std::string& text) {
    fs::create_directories(folder_ / "root" / name / fs::path(file).parent_path());
    std::ofstream(folder_ / "root" / name / file) << text;
    if (!fs::exists(folder_ / "root" / "good"))
      fs::copy(scenes_ / "a/box", folder_ / "root" / "good", fs::copy_options::recursive);
    return in_folder("root");
  }

  static fs::path scenes_;
};
fs::path Batch::scenes_;

TEST_F(Batch, EverySceneGetsWhatReconstructWritesAndTheFolderASummary) {
  const Outcome o = batch("");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.out, in_folder("results") + ": 3 of 3 scenes done\n" + in_folder("results") +
                       "/index.html: to look at\n");
  EXPECT_THAT(states(), ElementsAre("a/box done", "a/ring done", "b/box done"));
  ASSERT_EQ(run("reconstruct " + (scenes_ / "a/ring").string() +
                " --preset fast --reproducible -q --out " + in_folder("single"))
                .status,
            0);
  EXPECT_EQ(difference(folder_ / "single", folder_ / "results/a/ring"),
            "only in " + in_folder("results/a/ring") + ": batch.json\n");
  const json scene = summary()["scenes"][0];
  EXPECT_EQ(scene["counts"]["views"], 12);
  EXPECT_EQ(scene["format"], "abc-nef");
  EXPECT_GT(scene["scores"]["F5"], 80);
  EXPECT_GT(summary()["mean"]["F5"], 80);
  const std::string csv = text_of_file(folder_ / "results/summary.csv");
  EXPECT_EQ(count_lines(csv), 4);
  EXPECT_THAT(csv, HasSubstr("\na/box,done,,,abc-nef,12,"));
  const std::string page = text_of_file(folder_ / "results/index.html");
  EXPECT_THAT(page, HasSubstr("\"scene\":\"b/box\""));
  EXPECT_THAT(page, Not(HasSubstr("http://www.w3.org/1999"))) << "nothing from elsewhere";
  EXPECT_EQ(count_lines(text_of_file(folder_ / "results/.batch/timings.csv")), 4);
  const Outcome evaluation =
      run("evaluate --pred " + in_folder("results/a") + " --gt " + (scenes_ / "a").string());
  EXPECT_EQ(evaluation.status, 0) << evaluation.err;
  EXPECT_THAT(evaluation.out, AllOf(HasSubstr("box"), HasSubstr("ring"), HasSubstr("mean")));
}

TEST_F(Batch, TheSameTreeForAnyNumberOfJobsThreadsAndShards) {
  ASSERT_EQ(batch("--jobs 1", "one").status, 0);
  ASSERT_EQ(batch("--jobs 3 --threads 2", "two").status, 0);
  EXPECT_EQ(difference(folder_ / "one", folder_ / "two"), "");
  for (const std::string shard : {"2/2", "1/2"}) {
    const std::string part = "part" + shard.substr(0, 1);  // folders of their own, copied together
    for (const std::string& out : {std::string("shards"), part})
      ASSERT_EQ(batch("--shard " + shard, out).status, 0);
    EXPECT_FALSE(fs::exists(folder_ / "shards/summary.csv")) << "others may be at work";
    fs::copy(folder_ / part, folder_ / "merged",
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  for (const char* out : {"shards", "merged"}) {
    EXPECT_EQ(batch("--merge", out).status, 0);
    EXPECT_EQ(difference(folder_ / "one", folder_ / out), "");
  }
}

TEST_F(Batch, AFamilyHasTheSameSiblingsForAnyNumberOfJobsAndWhateverWasDone) {
  const auto siblings = [&](const std::string& scene) {
    const json report = json::parse(text_of_file(folder_ / "two" / scene / "report.json"));
    return report["counts"].value("family_siblings", 0);
  };
  ASSERT_EQ(batch("--family 2 --jobs 1", "one").status, 0);
  ASSERT_EQ(batch("--family 2 --jobs 3", "two").status, 0);
  EXPECT_EQ(difference(folder_ / "one", folder_ / "two"), "");
  EXPECT_EQ(siblings("a/box"), 0);
  EXPECT_EQ(siblings("a/ring"), 0);
  EXPECT_EQ(siblings("b/box"), 2);
  const auto first = fs::last_write_time(folder_ / "two/b/box/report.json");
  ASSERT_EQ(batch("--family 2", "two").status, 0);
  EXPECT_EQ(fs::last_write_time(folder_ / "two/b/box/report.json"), first) << "nothing to do";
  fs::remove_all(folder_ / "two/a/ring");
  ASSERT_EQ(batch("--family 2", "two").status, 0);
  EXPECT_EQ(difference(folder_ / "one", folder_ / "two"), "");
  EXPECT_EQ(batch("--family 2 --shard 1/2", "two").status, 2);
  EXPECT_EQ(batch("--family 2 --like " + in_folder("one/a/box"), "two").status, 2);
}

TEST_F(Batch, WhatIsDoneIsNotDoneAgainUnlessItIsNotWholeOrOfOtherOptionsOrInput) {
  ASSERT_EQ(batch("").status, 0);
  const auto first = times();
  ASSERT_EQ(batch("--threads 2 --jobs 1").status, 0);
  EXPECT_EQ(times(), first);
  fs::resize_file(folder_ / "results/a/ring/sketch.step", 100);
  fs::remove(folder_ / "results/b/box/sketch.obj");
  ASSERT_EQ(batch("").status, 0);
  const auto second = times();
  EXPECT_EQ(second[0], first[0]);
  EXPECT_NE(second[1], first[1]) << "half a file";
  EXPECT_NE(second[2], first[2]) << "a file less";
  ASSERT_EQ(batch("--lift-views 10").status, 0);
  const auto third = times();
  for (int i = 0; i < 3; ++i) EXPECT_NE(third[i], second[i]) << "other options";
  ASSERT_EQ(batch("--lift-views 10 --force").status, 0);
  EXPECT_NE(times()[0], third[0]);
  const auto forced = times();
  std::ofstream(scenes_ / "a/box/meta_data.json", std::ios::app) << "\n";
  ASSERT_EQ(batch("--lift-views 10").status, 0);
  EXPECT_NE(times()[0], forced[0]) << "other input";
  EXPECT_EQ(times()[1], forced[1]);
}

TEST_F(Batch, AFailureCostsOneSceneAndIsTriedAgain) {
  const std::string root = root_with("bad", "meta_data.json", "{");
  const std::string work = "batch " + root + " --preset fast --out " + in_folder("results");
  const Outcome o = run(work);
  EXPECT_EQ(o.status, kSomeFailed);
  EXPECT_THAT(o.err, testing::EndsWith("\nsketchsplat: 1 of 2 scenes failed: bad\n"));
  EXPECT_THAT(o.out, HasSubstr("1 of 2 scenes done"));
  EXPECT_THAT(states(), ElementsAre("bad failed", "good done")) << "failures first";
  EXPECT_EQ(summary()["scenes"][0]["status"], kBadInput);
  EXPECT_THAT(std::string(summary()["scenes"][0]["reason"]), HasSubstr("a JSON file"));
  EXPECT_THAT(text_of_file(folder_ / "results/.batch/scenes/bad/reconstruct.log"),
              HasSubstr("a JSON file"));
  EXPECT_FALSE(fs::exists(folder_ / "results/bad"));
  fs::copy(scenes_ / "b/box", folder_ / "root/bad",
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  const auto before = fs::last_write_time(folder_ / "results/good/report.json");
  EXPECT_EQ(run(work).status, 0) << "somebody has repaired it";
  EXPECT_THAT(states(), ElementsAre("bad done", "good done"));
  EXPECT_EQ(fs::last_write_time(folder_ / "results/good/report.json"), before);
}

TEST_F(Batch, TimeAndMemoryOfASceneAreLimited) {
  EXPECT_EQ(batch("--timeout 0.01").status, kSomeFailed);
  EXPECT_THAT(states(), ElementsAre("a/box failed", "a/ring failed", "b/box failed"));
  EXPECT_EQ(summary()["scenes"][0]["reason"], "took longer than 0.01 s");
  if (test::kSanitized) GTEST_SKIP() << "it takes all addresses";
  EXPECT_EQ(batch("--memory 1").status, kSomeFailed);
  EXPECT_NE(summary()["scenes"][0]["reason"], "took longer than 0.01 s");
  EXPECT_EQ(batch("--memory 4000").status, 0);
}

TEST_F(Batch, ATruthThatIsBrokenCostsTheScoreOnly) {
  const std::string root = root_with("bad", "gt/gt.json", "{");
  fs::copy(scenes_ / "b/box/color", folder_ / "root/bad/color");
  fs::copy(scenes_ / "b/box/meta_data.json", folder_ / "root/bad/meta_data.json");
  ASSERT_EQ(run("batch " + root + " --preset fast -q --out " + in_folder("results")).status, 0);
  const json scene = summary()["scenes"][0];
  EXPECT_EQ(scene["scene"], "bad");
  EXPECT_THAT(std::string(scene["note"]), AllOf(HasSubstr("no score"), HasSubstr("gt.json")));
  EXPECT_TRUE(fs::exists(folder_ / "results/bad/sketch.step"));
}

TEST_F(Batch, SecondBatchOnOneFolderIsRefusedInOneLine) {
  ASSERT_EQ(batch("--match a/box").status, 0);
  const auto held = [&](const std::string& name, int kind) {
    const int file = open((folder_ / "results/.batch" / name).c_str(), O_RDWR | O_CREAT, 0666);
    EXPECT_EQ(flock(file, kind), 0);
    return file;
  };
  int lock = held("lock", LOCK_EX);
  Outcome o = batch("");
  EXPECT_EQ(o.status, kNoOutput);
  EXPECT_EQ(count_lines(o.err), 1) << o.err;
  EXPECT_THAT(o.err,
              AllOf(HasSubstr(in_folder("results")), HasSubstr("another batch at work there")));
  EXPECT_EQ(batch("--shard 1/2").status, kNoOutput);
  close(lock);
  lock = held("lock", LOCK_SH);
  std::ofstream(folder_ / "results/.batch/lock") << "shards of 2";
  EXPECT_EQ(batch("").status, kNoOutput);
  EXPECT_EQ(batch("--merge").status, kNoOutput) << "while a shard is at work";
  EXPECT_EQ(batch("--shard 1/3").status, kNoOutput) << "another number of shards";
  EXPECT_EQ(batch("--shard 1/2").status, 0) << "shards work side by side";
  const int shard = held("lock.1", LOCK_EX);
  EXPECT_EQ(batch("--shard 1/2").status, kNoOutput);
  EXPECT_EQ(batch("--shard 2/2").status, 0);
  close(shard);
  close(lock);
  EXPECT_EQ(batch("--merge").status, 0);
}

TEST_F(Batch, InterruptedItEndsAtOnceOfTheSignalAndGoesOnLater) {
  ASSERT_EQ(batch("--jobs 1", "whole").status, 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    fs::remove_all(folder_ / "results");
    Running batch_run({"batch", scenes_.string(), "--preset", "fast", "--jobs", "1", "--out",
                       in_folder("results")},
                      in_folder("err"));
    while (!batch_run.ended() && !fs::exists(folder_ / "results/a/box"))
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const std::vector<pid_t> workers = batch_run.children();
    const auto began = std::chrono::steady_clock::now();
    batch_run.send(signal);
    const int status = batch_run.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(1));
    ASSERT_TRUE(WIFSIGNALED(status)) << status;
    EXPECT_EQ(WTERMSIG(status), signal);
    for (const pid_t worker : workers) EXPECT_NE(kill(worker, 0), 0) << "a worker is left";
    EXPECT_TRUE(fs::is_empty(folder_ / "results/.batch/running"));
    EXPECT_THAT(text_of_file(folder_ / "err"), HasSubstr("the same command does the rest"));
    EXPECT_THAT(states(), testing::Contains(HasSubstr(" open")));
    ASSERT_EQ(batch("").status, 0);
    EXPECT_EQ(difference(folder_ / "whole", folder_ / "results"), "");
  }
}

TEST_F(Batch, AListedFolderThatIsGoneIsAFailureAndTheOthersAreDone) {
  std::ofstream(folder_ / "list") << (scenes_ / "a/box").string() << "\n"
                                  << (scenes_ / "a/gone").string() << "\n";
  const Outcome o =
      run("batch --list " + in_folder("list") + " --preset fast -q --out " + in_folder("results"));
  EXPECT_EQ(o.status, kSomeFailed);
  EXPECT_EQ(o.err, "sketchsplat: 1 of 2 scenes failed: gone\n");
  EXPECT_THAT(states(), ElementsAre("gone failed", "box done"));
}

TEST_F(Batch, DryRunSaysWhatIsToDoAndWritesNothing) {
  ASSERT_EQ(batch("--match a/box").status, 0);
  const auto before = tree_of(folder_ / "results");
  const Outcome o = batch("--dry-run --json");
  ASSERT_EQ(o.status, 0) << o.err;
  const json plan = json::parse(o.out);
  EXPECT_EQ(plan["scenes"], 3);
  EXPECT_EQ(plan["done"], 1);
  EXPECT_EQ(plan["open"].size(), 2u);
  EXPECT_GT(plan["largest_mb"], 1);
  EXPECT_EQ(tree_of(folder_ / "results"), before);
  EXPECT_THAT(batch("--dry-run", "elsewhere").out, HasSubstr("3 scenes, 0 done, 3 to do"));
  EXPECT_FALSE(fs::exists(folder_ / "elsewhere"));
}

TEST_F(Batch, ResultsOfReconstructAreReplacedButNoOtherFolders) {
  ASSERT_EQ(run("reconstruct " + (scenes_ / "a/box").string() + " --preset fast -q --out " +
                in_folder("results/a/box"))
                .status,
            0);
  fs::create_directories(folder_ / "results/a/ring");
  std::ofstream(folder_ / "results/a/ring/thesis.tex") << "years of work";
  const Outcome o = batch("");
  EXPECT_EQ(o.status, kNoOutput);
  EXPECT_THAT(o.err, HasSubstr("results/a/ring"));
  EXPECT_EQ(text_of_file(folder_ / "results/a/ring/thesis.tex"), "years of work");
  EXPECT_FALSE(fs::exists(folder_ / "results/b/box")) << "said before any work";
  fs::remove_all(folder_ / "results/a/ring");
  ASSERT_EQ(batch("").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "results/a/box/batch.json"));
}

TEST_F(Batch, WrongUsageAndInputAreOneLine) {
  for (const char* arguments : {"--shard 0/2", "--shard 3/2", "--shard 1/2x", "--shard half",
                                "--shard 1/2 --merge", "--lift-views many", "--frobnicate"})
    EXPECT_EQ(batch(arguments).status, kWrongUsage) << arguments;
  EXPECT_EQ(run("batch --out x").status, kWrongUsage) << "no root";
  EXPECT_EQ(run("batch " + scenes_.string() + " --out " + scenes_.string()).status, kWrongUsage);
  for (const std::string& arguments :
       {in_folder("nowhere"), folder_.string(), scenes_.string() + " --match nothing",
        "--list " + in_folder("nowhere")}) {
    const Outcome o = run("batch " + arguments + " --out " + in_folder("results"));
    EXPECT_EQ(o.status, kBadInput) << arguments;
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
  }
  EXPECT_FALSE(fs::exists(folder_ / "results"));
  std::ofstream(folder_ / "file") << "x";
  for (const std::string& out : {in_folder("file"), std::string("/proc/sketchsplat")}) {
    const Outcome o = run("batch " + scenes_.string() + " --out " + out);
    EXPECT_EQ(o.status, kNoOutput) << out;
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
  }
}

TEST_F(Batch, AFullDiskEndsItInOneLineAndLeavesNothingHalfWritten) {
  ASSERT_EQ(batch("", "whole").status, 0);
  fs::create_directories(folder_ / "disk");
  if (mount("none", in_folder("disk").c_str(), "tmpfs", 0, "size=300k") != 0)
    GTEST_SKIP() << "a disk that is full can be made by root only";
  Outcome o = run("batch " + scenes_.string() + " --preset fast -q --jobs 1 --out " +
                  in_folder("disk/out"));
  EXPECT_EQ(o.status, kNoOutput);
  EXPECT_EQ(count_lines(o.err), 1) << o.err;
  EXPECT_THAT(o.err, HasSubstr("No space left on device"));
  for (const auto& [name, bytes] : tree_of(folder_ / "disk/out")) {
    EXPECT_EQ(name.find(".part"), std::string::npos) << name;
    if (bytes != "(folder)") {
      EXPECT_EQ(bytes, text_of_file(folder_ / "whole" / name)) << name;
    }
  }
  umount(in_folder("disk").c_str());
}

}  // namespace
}  // namespace sketchsplat
