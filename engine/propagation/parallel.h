#pragma once
/// Work on several threads.
#include <cstddef>
#include <functional>

namespace gumshoe::propagation {

/// Calls body(i) for i in [0, n) on `threads` threads (0: all processors), in any order. Throws Interrupted after a signal.
void parallel_for(std::size_t n, int threads, const std::function<void(std::size_t)>& body);

} // namespace gumshoe::propagation
