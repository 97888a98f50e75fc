#include "propagation/parallel.h"

#include "base/interrupt.h"
#include "base/progress.h"
#include "propagation/threads.h"

namespace gumshoe::propagation {

void parallel_for(std::size_t n, int threads, const std::function<void(std::size_t)>& body) {
  progress::Loop loop(n);
  const auto step = [&](std::size_t i) {
    stop_if_interrupted();
    body(i);
    loop.step();
  };
  if (n > 1 && threads != 1) return each(n, thread_count(threads), step);
  for (std::size_t i = 0; i < n; ++i) step(i);
}

} // namespace gumshoe::propagation
