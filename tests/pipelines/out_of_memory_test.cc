// SPDX-License-Identifier: MIT
// Wherever memory runs out in a run of the program, it says one line and ends with a status that is
// documented; what lies in the folder of results then is whole. SKETCHSPLAT_MEMORY_STRIDE=1 tries
// every request for memory instead of some hundred of them, which takes hours.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "pipelines/command/cli.h"
#include "tests/datasets/temp_folder.h"
#include "tests/pipelines/failing_memory.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using test::FailingMemory;

// Ceres (BlockJacobianWriter) and the JSON library step on null pointers where they get no memory,
// and Clp (~ClpModel) frees twice what it copies: known, rare, and not ours. Nor are threads that a
// child waits for in vain: CHOLMOD has some of its own, which do not live on in a fork.
constexpr int kMostCrashes = 5;           // of some hundred places
constexpr unsigned kLongestSeconds = 10;  // of a child, then it is ended by SIGALRM

const std::string kNullPointer = "signal 11: ", kFreedTwice = "signal 6: free(): double free";

bool is_theirs(const std::string& end) {
  return end == kNullPointer || end.rfind(kFreedTwice, 0) == 0 || end.rfind("signal 14: ", 0) == 0;
}

// What the children of a test are told; a function without state asks for it.
struct Plan {
  long every = 0, from = 0;    // requests that fork a child in which they fail
  long single = 0, until = 0;  // requests that fail in this process
  bool is_child = false;
  std::string folder;  // of the children
  std::map<std::string, long> ends;
  std::vector<std::string> broken;
} plan;

int run_program(std::vector<const char*> argv) {
  argv.insert(argv.begin(), "sketchsplat");
  return run_command_line(int(argv.size()), argv.data(), all_verbs());
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void say_into(const char* path) {
  const int to = ::open(path, O_CREAT | O_TRUNC | O_WRONLY, 0600);
  ::dup2(to, STDERR_FILENO);
  ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
}

// How a child ended: its status, or its signal, and what it said.
std::string end_of(int status, const std::string& said) {
  if (WIFSIGNALED(status)) return "signal " + std::to_string(WTERMSIG(status)) + ": " + said;
  return std::to_string(WEXITSTATUS(status)) + ": " + said;
}

bool is_clean(std::string end) {
  // Ceres logs that CHOLMOD finds no memory before the program does.
  end = std::regex_replace(end, std::regex("(WARNING: Logging before|[WE][0-9]{8} )[^\n]*\n"), "");
  // Somebody did without that memory: Ceres, say, where CHOLMOD finds none, and tells its log.
  if (end.rfind("0: ", 0) == 0) return true;
  // The runtime of OpenMP does as it likes.
  if (end.rfind("1: \nlibgomp: Out of memory", 0) == 0) return true;
  const std::set<std::string> documented = {"1", "3", "5"};
  return documented.count(end.substr(0, end.find(':'))) == 1 && end.find(": sketchsplat: ") == 1 &&
         std::count(end.begin(), end.end(), '\n') == 1;
}

void note(long number, const std::string& end) {
  ++plan.ends[end];
  if (!is_clean(end) && !is_theirs(end))
    plan.broken.push_back("request " + std::to_string(number) + ": " + end);
}

// As a process in which this request fails; the caller goes on. Not once it writes: the two would
// share files.
bool fail_in_a_child(long number, size_t) {
  if (number < plan.from || (number - plan.from) % plan.every != 0) return false;
  const int before = errno;
  if (::access("out/sketch.json", F_OK) == 0) {
    plan.from = std::numeric_limits<long>::max();
    return false;
  }
  const std::string place = plan.folder + "/" + std::to_string(number);
  fs::create_directories(place + "/out");
  const pid_t child = ::fork();
  if (child == 0) {
    if (::chdir(place.c_str()) != 0) ::_exit(99);
    say_into("said");
    ::alarm(kLongestSeconds);
    plan.from = std::numeric_limits<long>::max();  // no children of its own
    plan.is_child = true;
    return true;
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  note(number, end_of(status, text_of(place + "/said")));
  fs::remove_all(place);
  errno = before;
  return false;
}

// Small requests that fail alone are for the test with one thread.
bool fail_here(long number, size_t bytes) {
  return number >= plan.single && number <= plan.until && bytes >= 1024;
}

bool never(long, size_t) { return false; }

class OutOfMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (!FailingMemory::possible()) GTEST_SKIP() << "memory cannot be made to fail here";
    plan = Plan();
    scene_ = temporary_.path() + "/scene";
    plan.folder = temporary_.path() + "/children";
    fs::create_directories(plan.folder);
    ASSERT_EQ(in_a_child("made",
                         [&] {
                           return run_program({"synthesize", "l-bracket", "--views", "8",
                                               "--resolution", "160", "--outputs", "none",
                                               "--quiet", "--out", scene_.c_str()});
                         }),
              "0: ");
  }

  // A process of its own, in a folder of its own: this one shall never have had threads.
  template <typename Act>
  std::string in_a_child(const std::string& name, const Act& act) {
    const std::string place = temporary_.path() + "/" + name;
    fs::create_directories(place);
    const pid_t child = ::fork();
    if (child == 0) {
      if (::chdir(place.c_str()) != 0) ::_exit(99);
      say_into("said");
      ::_exit(act());
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return end_of(status, text_of(place + "/said"));
  }

  int reconstruct(const char* threads, FailingMemory::Fails fails) const {
    const char* const argv[] = {"sketchsplat", "reconstruct",    scene_.c_str(), "--out", "out",
                                "--quiet",     "--reproducible", "--threads",    threads};
    const std::vector<Verb> verbs = all_verbs();
    FailingMemory::begin(fails);
    const int status = run_command_line(int(std::size(argv)), argv, verbs);
    FailingMemory::end();
    return status;
  }

  // Runs to the end, and says how often it asked for memory.
  long requests() {
    const std::string end = in_a_child("whole", [&] {
      const int status = reconstruct("1", never);
      std::ofstream("requests") << FailingMemory::asked();
      return status;
    });
    EXPECT_EQ(end, "0: ");
    return std::atol(text_of(temporary_.path() + "/whole/requests").c_str());
  }

  // What is there is whole, as a run that has all the memory writes it.
  void expect_whole_files(const std::string& name) const {
    const std::string whole = temporary_.path() + "/whole/out/",
                      here = temporary_.path() + "/" + name + "/out/";
    if (!fs::exists(here)) return;
    for (const fs::directory_entry& entry : fs::directory_iterator(here)) {
      const std::string file = entry.path().filename().string();
      if (file.find(".part") != std::string::npos) continue;  // nobody takes it for a result
      EXPECT_TRUE(fs::exists(whole + file)) << name << ": " << file;
      EXPECT_TRUE(text_of(here + file) == text_of(whole + file)) << name << ": " << file;
    }
  }

  const TempFolder temporary_;
  std::string scene_;
};

long stride_for(long requests, long tries) {
  const char* const wanted = std::getenv("SKETCHSPLAT_MEMORY_STRIDE");
  return wanted ? std::max(1L, std::atol(wanted)) : std::max(1L, requests / tries);
}

long crashes() {
  long sum = 0;
  for (const auto& [end, times] : plan.ends)
    if (end == kNullPointer || end.rfind(kFreedTwice, 0) == 0) sum += times;
  return sum;
}

std::string report() {
  std::ostringstream out;
  for (const auto& [end, times] : plan.ends) out << times << " x " << end << "\n";
  return out.str();
}

TEST_F(OutOfMemory, EndsEveryPhaseInOneLine) {
  const long all = requests();
  ASSERT_GT(all, 10000);
  plan.every = stride_for(all, 150);
  plan.from = 1 + plan.every / 2;
  const std::string end = in_a_child("phases", [&] {
    const int status = reconstruct("1", fail_in_a_child);
    if (plan.is_child) return status;
    std::ofstream("ends") << report();
    std::ofstream("crashes") << (plan.every > 1000 ? crashes() : 0);
    std::ofstream broken("broken");
    for (const std::string& line : plan.broken) broken << line;
    return status;
  });
  EXPECT_EQ(end, "0: ");
  std::cout << all << " requests; " << text_of(temporary_.path() + "/phases/ends");
  EXPECT_EQ(text_of(temporary_.path() + "/phases/broken"), "");
  EXPECT_LE(std::atol(text_of(temporary_.path() + "/phases/crashes").c_str()), kMostCrashes);
}

TEST_F(OutOfMemory, LeavesWholeFilesWithSeveralThreads) {
  const long all = requests();
  const long tries = 12;
  for (long k = 0; k < tries; ++k) {
    // Half of them in what is written in the end; for good, as memory that is short stays short.
    plan.single = k % 2 ? all - all * k / (3 * tries) : 1 + all * k / tries;
    plan.until = k % 4 < 2 ? plan.single + all / 50 : std::numeric_limits<long>::max();
    const std::string name = "threads" + std::to_string(k);
    const std::string end = in_a_child(name, [&] { return reconstruct("2", fail_here); });
    EXPECT_TRUE(is_clean(end)) << plan.single << " of " << all << ": " << end;
    expect_whole_files(name);
  }
}

}  // namespace
}  // namespace sketchsplat
