#include "base/memory.h"

#include <sys/mman.h>

#include <cstdint>
#include <new>

namespace gumshoe {

void require_memory(std::size_t bytes) {
  ::operator delete(::operator new(bytes)); // called as functions: not optimised away, as a new-expression may be
}

void prefer_large_pages(void* memory, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = 4096;
  constexpr std::size_t worth_it = 4 << 20; // two large pages
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (bytes >= worth_it && end > begin)
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE); // advice: refusal is no error
#else
  static_cast<void>(memory), static_cast<void>(bytes);
#endif
}

} // namespace gumshoe
