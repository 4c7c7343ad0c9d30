#pragma once

// Counts every allocation of the program that includes this, once, in its only source file: it replaces
// malloc, because Eigen's storage does not come from operator new, which ends in malloc as well.

#include <cstddef>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TOUCHSTONE_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define TOUCHSTONE_SANITIZED
#endif

namespace {
long allocations = 0;  // NOLINT(misc-definitions-in-headers): one source file includes this

#ifdef TOUCHSTONE_SANITIZED
constexpr bool kAllocationsAreCounted = false;  // the sanitizer owns malloc
#else
constexpr bool kAllocationsAreCounted = true;
#endif
}  // namespace

#ifndef TOUCHSTONE_SANITIZED
// NOLINTBEGIN(misc-definitions-in-headers, bugprone-reserved-identifier): see above; the names are glibc's
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t n);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
// NOLINTEND(misc-definitions-in-headers, bugprone-reserved-identifier)
#endif
