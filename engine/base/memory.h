#pragma once
/// Memory asked for before it is needed, and in large pages.
#include <cstddef>

namespace gumshoe {

/// Throws std::bad_alloc unless so many bytes can be allocated now; keeps none. Called before libraries that end the
/// process where they get no memory (udunits2's parser, toml++'s errors, HDF5's cache of a file, the JSON library's
/// destructors).
void require_memory(std::size_t bytes);

/// Lets the heap begin with large pages: the first touch of a small one costs as much as copying several. Larger blocks
/// of `operator new` have them anyway. The system may decline. Called before the first thread starts.
void prefer_large_pages_of_heap();

} // namespace gumshoe
