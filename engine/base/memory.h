#pragma once
/// Memory asked for before it is needed, and in large pages.
#include <cstddef>

namespace gumshoe {

/// Throws std::bad_alloc unless so many bytes can be allocated now; keeps none. Called before libraries that end the
/// process where they get no memory (udunits2's parser, HDF5's cache of a file, the JSON library's destructors).
void require_memory(std::size_t bytes);

/// Asks the system for large pages where it has not yet given any: the first touch of a page of 4 KiB costs as much as
/// copying several. It may decline. For fresh memory that will be written from end to end.
void prefer_large_pages(void* memory, std::size_t bytes);

} // namespace gumshoe
