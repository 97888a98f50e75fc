#include "base/memory.h"

#include <new>

namespace gumshoe {

void require_memory(std::size_t bytes) {
  ::operator delete(::operator new(bytes)); // called as functions: not optimised away, as a new-expression may be
}

} // namespace gumshoe
