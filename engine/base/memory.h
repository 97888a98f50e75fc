#pragma once
/// Memory asked for before it is needed.
#include <cstddef>

namespace gumshoe {

/// Throws std::bad_alloc unless so many bytes can be allocated now; keeps none. Called before libraries that end the
/// process where they get no memory (udunits2's parser, HDF5's cache of a file, the JSON library's destructors).
void require_memory(std::size_t bytes);

} // namespace gumshoe
