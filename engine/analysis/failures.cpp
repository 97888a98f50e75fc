#include "analysis/failures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "base/status_meaning.h"
#include "base/units.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

namespace {

/// The range of n draws that are unrelated to an input holds less than half of all draws with a probability of
/// (n + 1) / 2^n: 2e-5 for 20.
constexpr std::size_t least_failures = 20;
constexpr double narrow = 0.5;
constexpr std::size_t most_failed = 2000, most_drawn = 16384, most_inputs = 3;

/// Values of the inputs that vary, [input][sample], SI.
using Drawn = std::vector<std::vector<double>>;

struct Input {
  std::size_t column = 0;
  std::string name;
};

std::vector<Input> varying(const quantities::SamplePlan& plan) {
  std::vector<Input> inputs;
  for (std::size_t c = 0; c < plan.columns.size(); ++c) {
    if (plan.columns[c].variates.empty()) continue;
    const std::string& name = plan.variates[plan.columns[c].variates.front()].name;
    inputs.push_back({c, name.substr(0, name.find(": "))}); // without the component
  }
  return inputs;
}

class Draws {
public:
  explicit Draws(const propagation::Experiment& e)
      : plan_(e.plan()), inputs_(varying(e.plan())), draw_(propagation::variate_draws(e)) {}

  const std::vector<Input>& inputs() const { return inputs_; }
  void add(std::uint64_t first, std::size_t count, Drawn& drawn) const {
    drawn.resize(inputs_.size());
    std::vector<double> values(plan_.variates.size() * count), one(plan_.variates.size());
    draw_(first, count, values.data());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t v = 0; v < one.size(); ++v) one[v] = values[v * count + i];
      for (std::size_t k = 0; k < inputs_.size(); ++k) drawn[k].push_back(plan_.value(inputs_[k].column, one.data()));
    }
  }

private:
  const quantities::SamplePlan& plan_;
  std::vector<Input> inputs_;
  std::function<void(std::uint64_t, std::size_t, double*)> draw_;
};

/// Share of samples, estimated from the first ones; where none of n lies there, the upper 95 % confidence limit 3 / n.
std::string share_text(std::size_t inside, std::size_t drawn) {
  const double percent = 100.0 / static_cast<double>(drawn);
  return inside > 0 ? fmt::format("about {:.2g} %", percent * static_cast<double>(inside))
                    : fmt::format("less than {:.1g} %", percent * 3);
}

/// "1 to 1.00001": two digits of the range's width, and four digits at least.
std::string range_text(double low, double high) {
  if (!(high > low)) return fmt::format("{:.4g}", low);
  const double largest = std::max(std::abs(low), std::abs(high));
  const int digits = std::clamp(static_cast<int>(std::ceil(std::log10(largest / (high - low)))) + 2, 4, 15);
  return fmt::format("{:.{}g} to {:.{}g}", low, digits, high, digits);
}

/// "; a is 1 to 2 mm in them, as in 3 % of all samples"; empty if no input's range is narrow.
std::string where(const propagation::Experiment& e, const Draws& draws, const Drawn& all,
                  const std::vector<std::uint64_t>& failed) {
  if (failed.size() < least_failures) return {};
  Drawn there;
  for (const std::uint64_t sample : failed) draws.add(sample, 1, there);
  std::multimap<std::size_t, std::string> found; // by the number of samples in the range
  for (std::size_t k = 0; k < there.size(); ++k) {
    const auto [low, high] = std::ranges::minmax(there[k]);
    const auto is_inside = [low = low, high = high](double x) { return x >= low && x <= high; };
    const auto inside = static_cast<std::size_t>(std::ranges::count_if(all[k], is_inside));
    if (static_cast<double>(inside) >= narrow * static_cast<double>(all[k].size())) continue;
    const Input& input = draws.inputs()[k];
    const auto& q = e.scenario().quantities[e.plan().columns[input.column].quantity];
    const auto shown = [&](double x) { return units::from_si(x, q.unit, q.si_unit); };
    found.emplace(inside, fmt::format("; {} is {}{} in them, as in {} of all samples", input.name,
                                      range_text(shown(low), shown(high)), units::suffix(q.unit),
                                      share_text(inside, all[k].size())));
  }
  std::string text;
  std::size_t named = 0;
  for (const auto& [inside, words] : found)
    if (named++ < most_inputs) text += words;
  return text;
}

} // namespace

Failures failures_of(const propagation::Experiment& e, const Samples& samples) {
  Failures failures;
  std::map<std::uint8_t, std::uint64_t> counts;
  std::map<std::uint8_t, std::vector<std::uint64_t>> failed; // the first of each reason
  std::vector<std::uint8_t> room(std::min(samples.size, std::size_t{1} << 16));
  for (std::size_t first = 0; first < samples.size; first += room.size()) {
    const auto status = std::span(room).first(std::min(room.size(), samples.size - first));
    samples.status(first, status);
    if (std::reduce(status.begin(), status.end(), std::uint8_t{0}, std::bit_or()) == 0)
      continue; // none failed: in one pass
    for (std::size_t i = 0; i < status.size(); ++i) {
      if (status[i] == 0) continue;
      ++counts[status[i]];
      if (auto& some = failed[status[i]]; some.size() < most_failed) some.push_back(first + i);
    }
  }
  if (counts.empty()) return failures;
  const Draws draws(e);
  Drawn all;
  draws.add(0, std::min(most_drawn, samples.size), all);
  for (const auto& [reason, count] : counts) {
    failures.samples += count;
    const std::uint64_t first = failed[reason].front();
    failures.reasons.push_back(
        fmt::format("{}: {} samples, the first is sample {} (gumshoe replay FILE --sample {}); {}{}",
                    status_name(static_cast<Status>(reason)), count, first, first,
                    status_meaning(static_cast<Status>(reason)), where(e, draws, all, failed[reason])));
  }
  return failures;
}

} // namespace gumshoe::analysis
