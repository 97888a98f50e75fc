#include "base/memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

// The first touch of a page of 4 KiB costs as much as copying several: memory comes in pages of 2 MiB where the system
// has them.
#ifdef GUMSHOE_LARGE_PAGES
namespace {
constexpr std::size_t small_page = 4096, large_page = 2 << 20;
}

/// Blocks of two large pages or more fill whole ones. What is given back needs no change: free takes both kinds.
void* operator new(std::size_t bytes) {
  const bool large = bytes >= 2 * large_page;
  if (large) bytes = (bytes + std::min(large_page - 1, SIZE_MAX - bytes)) / large_page * large_page;
  for (;;) {
    if (void* const block = large ? std::aligned_alloc(large_page, bytes) : std::malloc(std::max<std::size_t>(bytes, 1))) {
      if (large) madvise(block, bytes, MADV_HUGEPAGE); // advice: refusal is no error
      return block;
    }
    const std::new_handler retry = std::get_new_handler();
    if (!retry) throw std::bad_alloc();
    retry();
  }
}
#endif

namespace gumshoe {

void require_memory(std::size_t bytes) {
  ::operator delete(::operator new(bytes)); // called as functions: not optimised away, as a new-expression may be
}

void prefer_large_pages_of_heap() {
#ifdef GUMSHOE_LARGE_PAGES
  constexpr std::size_t wanted = 2 * large_page; // what a small run needs
  void* (*volatile const allocate)(std::size_t) = std::malloc; // a block without a use would be optimised away
  // The C library takes from its heap what is no larger than the largest block that was given back.
  std::free(allocate(wanted + 2 * small_page));
  // Its notes before and behind a block must not lie on the large pages, which nothing may have touched yet.
  const auto top = reinterpret_cast<std::uintptr_t>(sbrk(0));
  const std::uintptr_t begin = (top + small_page + large_page - 1) / large_page * large_page;
  if (sbrk(static_cast<std::intptr_t>(begin - small_page - top)) != reinterpret_cast<void*>(top)) return;
  void* const block = allocate(wanted + small_page);
  const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
  if (end >= begin + wanted) madvise(reinterpret_cast<void*>(begin), wanted, MADV_HUGEPAGE);
  std::free(block);
#endif
}

} // namespace gumshoe
