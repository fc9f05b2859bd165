// SPDX-License-Identifier: BSD-3-Clause
// Replaces the global operator new, and malloc where it can, of the program that links this.
#include "tests/support/allocation_counter.h"

#include <atomic>
#include <cstdlib>
#include <new>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LADDER_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LADDER_SANITIZED 1
#endif
#if defined(__GLIBC__) && !defined(LADDER_SANITIZED)
#define LADDER_COUNTS_MALLOC 1
#else
#define LADDER_COUNTS_MALLOC 0
#endif

namespace {

std::atomic<std::size_t> total_number{0};
std::atomic<std::size_t> total_bytes{0};

void count(std::size_t bytes) {
  ++total_number;
  total_bytes += bytes;
}

void* or_throw(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* counted(std::size_t bytes) {
  if (!LADDER_COUNTS_MALLOC) count(bytes);
  return or_throw(std::malloc(bytes == 0 ? 1 : bytes));
}

void* counted(std::size_t bytes, std::align_val_t alignment) {
  count(bytes);
  const auto align = static_cast<std::size_t>(alignment);
  return or_throw(std::aligned_alloc(align, (bytes + align - 1) / align * align));
}

}  // namespace

std::size_t test_support::num_allocations() {
  return total_number;
}
std::size_t test_support::allocated_bytes() {
  return total_bytes;
}
bool test_support::counts_malloc() {
  return LADDER_COUNTS_MALLOC;
}

#if LADDER_COUNTS_MALLOC
extern "C" void* __libc_malloc(std::size_t bytes);  // NOLINT(bugprone-reserved-identifier)
extern "C" void* malloc(std::size_t bytes) {
  count(bytes);
  return __libc_malloc(bytes);
}
#endif

// Not inlined: the compiler would see free() meet a pointer of operator new and warn.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  return counted(bytes);
}
[[gnu::noinline]] void* operator new[](std::size_t bytes) {
  return counted(bytes);
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, alignment);
}
[[gnu::noinline]] void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, alignment);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
