// SPDX-License-Identifier: MIT
#include "tests/pipelines/failing_memory.h"

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SKETCHSPLAT_FAILING_MEMORY 1
#endif

namespace {

using Fails = sketchsplat::test::FailingMemory::Fails;
std::atomic<Fails> fails = nullptr;
std::atomic<long> count = 0;
thread_local bool inside = false;

#ifdef SKETCHSPLAT_FAILING_MEMORY
bool fail_now(size_t bytes) {
  const Fails ask = fails.load(std::memory_order_relaxed);
  if (!ask || inside) return false;
  inside = true;
  const bool failed = ask(++count, bytes);
  inside = false;
  if (failed) errno = ENOMEM;
  return failed;
}
#endif

}  // namespace

#ifdef SKETCHSPLAT_FAILING_MEMORY
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) { return fail_now(size) ? nullptr : __libc_malloc(size); }
void* calloc(size_t n, size_t size) {
  return fail_now(n * size) ? nullptr : __libc_calloc(n, size);
}
void* realloc(void* old, size_t size) {
  return fail_now(size) ? nullptr : __libc_realloc(old, size);
}
void* memalign(size_t alignment, size_t size) {
  return fail_now(size) ? nullptr : __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** out, size_t alignment, size_t size) {
  void* const got = memalign(alignment, size);
  if (!got) return ENOMEM;
  *out = got;
  return 0;
}
}
#endif

namespace sketchsplat::test {

bool FailingMemory::possible() {
#ifdef SKETCHSPLAT_FAILING_MEMORY
  return true;
#else
  return false;
#endif
}

long FailingMemory::asked() { return count; }

void FailingMemory::begin(Fails ask) {
  count = 0;
  fails = ask;
}

void FailingMemory::end() { fails = nullptr; }

}  // namespace sketchsplat::test
