// SPDX-License-Identifier: MIT
#include "datasets/types/parallel.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace sketchsplat {
namespace {

class Parallel : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { omp_set_num_threads(GetParam()); }
  void TearDown() override { omp_set_num_threads(before_); }

 private:
  const int before_ = omp_get_max_threads();
};

TEST_P(Parallel, DoesEverythingOnce) {
  for (const int n : {0, 1, 7, 1000})
    for (const int chunk : {1, 16, 5000}) {
      std::vector<int> done(n, 0);
      parallel_for(n, chunk, [&](int i) { ++done[i]; });
      EXPECT_EQ(done, std::vector<int>(n, 1)) << chunk;
    }
  std::vector<int> done(1000, 0);
  parallel_for(1000, [&](int i) { ++done[i]; });
  EXPECT_EQ(done, std::vector<int>(1000, 1));
}

TEST_P(Parallel, HandsOverTheFirstExceptionInTheOrderOfTheLoop) {
  for (int round = 0; round < 50; ++round) {
    std::vector<int> done(300, 0);
    try {
      parallel_for(300, 1, [&](int i) {
        if (i % 100 == 37) throw std::runtime_error(std::to_string(i));
        ++done[i];
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), "37");
    }
    for (int i = 0; i < 37; ++i) ASSERT_EQ(done[i], 1) << i;
  }
}

TEST_P(Parallel, KeepsTheTypeOfTheException) {
  EXPECT_THROW(parallel_for(9, 1, [](int) { throw std::bad_alloc(); }), std::bad_alloc);
}

TEST_P(Parallel, HandsOverThroughLoopsWithinLoops) {
  EXPECT_THROW(parallel_for(5, 1,
                            [](int i) {
                              parallel_for(9, 1, [i](int k) {
                                if (i == 3 && k == 8) throw std::bad_alloc();
                              });
                            }),
               std::bad_alloc);
}

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 3, 16));

}  // namespace
}  // namespace sketchsplat
