// SPDX-License-Identifier: MIT
// What `kill -9` of workers and of the batch itself can do: nothing. By default small; with
// SKETCHSPLAT_BATCH_SCENES=1000 and SKETCHSPLAT_BATCH_KILLS=50 what is claimed in docs/batch.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include "tests/pipelines/batch_folder.h"
#include "tests/support/sanitizer.h"

namespace sketchsplat {
namespace {

using Clock = std::chrono::steady_clock;

int number_from(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

// Peak resident memory of a running process [MB].
double peak_of(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; in >> word;) {
    double kib = 0;
    if (word == "VmHWM:" && in >> kib) return kib * 1024 / 1e6;
  }
  return 0;
}

class BatchKills : public Program {
 protected:
  // Boxes, plates and flanges, each of its own seed; made once, in a folder that may be given.
  void make_scenes(int count) {
    const char* given = std::getenv("SKETCHSPLAT_BATCH_FOLDER");
    scenes_ = given ? fs::path(given) : folder_ / "scenes";
    const std::vector<std::string> parts = {"box", "l-bracket", "plate-holes"};
    for (int i = 0; i < count; ++i) {
      const fs::path scene = scenes_ / ("s" + std::to_string(i));
      if (fs::exists(scene / "meta_data.json")) continue;
      run("synthesize " + parts[i % parts.size()] +
          " --views 12 --resolution 160 --outputs none --quiet --threads 1 --seed " +
          std::to_string(i) + " --out " + scene.string());
    }
  }
  std::vector<std::string> command(const std::string& out) const {
    return {"batch",    scenes_.string(), "--out",     in_folder(out),
            "--preset", "fast",           "--retries", "1"};
  }

  fs::path scenes_;
};

TEST_F(BatchKills, LoseNothing) {
  const int scenes = number_from("SKETCHSPLAT_BATCH_SCENES", 12);
  const int kills = number_from("SKETCHSPLAT_BATCH_KILLS", 6);
  make_scenes(scenes);
  const auto began = Clock::now();
  double peak = 0;
  {
    Running whole(command("whole"), in_folder("err"));
    while (!whole.ended()) {
      peak = std::max(peak, peak_of(whole.pid()));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const int status = whole.wait();
    ASSERT_TRUE(WIFEXITED(status) &&
                (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == kSomeFailed))
        << text_of_file(folder_ / "err");
  }
  const double seconds = seconds_since(began);
  std::printf("%d scenes in %.1f s, coordinator's peak %.1f MB\n", scenes, seconds, peak);
  EXPECT_LT(peak, test::kSanitized ? 600 : 60) << "MB, however many scenes";

  std::mt19937 random(7);
  int workers_killed = 0, batches_killed = 0, starts = 0;
  bool done = false;
  const double pause = 0.4 * seconds / kills;  // more kills than asked for before all is done
  while (!done) {
    ++starts;
    Running batch(command("results"), in_folder("err"));
    while (!batch.ended()) {
      std::this_thread::sleep_for(
          std::chrono::duration<double>(std::uniform_real_distribution<>(0, 2 * pause)(random)));
      if (batch.ended() || workers_killed + batches_killed >= kills) continue;
      const std::vector<pid_t> workers = batch.children();
      if (random() % 2 == 0) {
        batch.send(SIGKILL);
        ++batches_killed;
      } else if (!workers.empty() && kill(workers[random() % workers.size()], SIGKILL) == 0) {
        ++workers_killed;
      }
    }
    const int status = batch.wait();
    done = WIFEXITED(status);  // by itself
  }
  // A scene that was killed more often than it is tried again is done by the next start.
  run("batch " + scenes_.string() + " --preset fast -q --out " + in_folder("results"));
  std::printf("%d kills of workers, %d of the batch, %d starts\n", workers_killed, batches_killed,
              starts);
  EXPECT_EQ(difference(folder_ / "whole", folder_ / "results"), "");
  EXPECT_GE(workers_killed + batches_killed, kills / 2);
}

}  // namespace
}  // namespace sketchsplat
