// malloc and its like for the program that links this, in front of those of the C library.
#include <malloc.h>

#include <cerrno>
#include <cstddef>

#include "tests/allocation_guard/allocation_guard.hpp"

namespace eciton::testing {

bool AllocationGuard::available() {
#ifdef ECITON_SANITIZED
  return false;
#else
  return true;
#endif
}

}  // namespace eciton::testing

#ifndef ECITON_SANITIZED

extern "C" {

void* __libc_malloc(std::size_t size);
void __libc_free(void* memory);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

#define ECITON_RECORD() ::eciton::testing::AllocationGuard::record(__builtin_return_address(0))

void* malloc(std::size_t size) {
  ECITON_RECORD();
  return __libc_malloc(size);
}
void free(void* memory) {
  if (memory != nullptr) ECITON_RECORD();
  __libc_free(memory);
}
void* calloc(std::size_t count, std::size_t size) {
  ECITON_RECORD();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ECITON_RECORD();
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ECITON_RECORD();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ECITON_RECORD();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ECITON_RECORD();
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}

}  // extern "C"

#endif
