#include "propagation/work.h"

#include "base/interrupt.h"
#include "base/progress.h"
#include "propagation/in_order.h"

namespace gumshoe::propagation {

namespace {

struct None {};
using Values = std::vector<double>;

} // namespace

std::size_t Workers::size() const { return static_cast<std::size_t>(thread_count(threads)) + elsewhere.size(); }

void Workers::run(const Work& work, std::uint64_t first, std::uint64_t last, const TakeUnits& take) const {
  if (known && known(work, take)) return;
  const std::uint64_t fair = (last - first + size() - 1) / size();
  const Blocks blocks{first, last, std::clamp<std::uint64_t>(fair, 1, work.together)};
  std::vector<std::function<Values(std::uint64_t, std::uint64_t)>> others;
  for (const DoUnits& other : elsewhere)
    others.push_back([&](std::uint64_t from, std::uint64_t to) { return other(work, from, to); });
  progress::Loop loop((last - first + blocks.step - 1) / blocks.step);
  const std::uint64_t done = in_order<None>(
      blocks, threads, others, &interrupted(),
      [&](std::uint64_t from, std::uint64_t to, None&) {
        Values values((to - from) * work.values);
        work.compute(from, to, values.data());
        return values;
      },
      [&](const Values& values, std::uint64_t from, std::uint64_t to) {
        take(from, to, values.data());
        loop.step();
      });
  if (done < last) throw Interrupted();
}

std::vector<double> Workers::values(const Work& work) const {
  Values all(work.units * work.values);
  run(work, [&](std::uint64_t first, std::uint64_t last, const double* values) {
    std::copy_n(values, (last - first) * work.values, &all[first * work.values]);
  });
  return all;
}

} // namespace gumshoe::propagation
