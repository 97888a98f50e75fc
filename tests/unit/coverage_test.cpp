/// Do the stated Monte Carlo standard errors cover the truth as often as they say? Fixed seeds; with
/// GUMSHOE_LONG_SEED set, fresh ones from there, and more of them (scripts/check --long).
#include "gum_models.h"

#include <cstdlib>

using namespace gum_models;

namespace {

struct Plain {
  static constexpr const char* inputs[] = {"x"};
  static constexpr const char* outputs[] = {"y"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) { y[0] = x[0] + 0.0; }
};

struct Truth {
  const char* name;
  quantities::Component component;
  double mean, u, low, high;
};

} // namespace

TEST_CASE("95 % of intervals of +-1.96 Monte Carlo standard errors hold the truth", "[coverage]") {
  const char* fresh = std::getenv("GUMSHOE_LONG_SEED");
  const std::uint64_t first = fresh ? std::strtoull(fresh, nullptr, 10) : 1;
  const int repetitions = fresh ? 4000 : 500;
  const Truth truths[] = {
      {"normal", normal(1), 0, 1, -1.959963985, 1.959963985},
      {"rectangular", rectangular(1), 0, 1 / std::sqrt(3.0), -0.95, 0.95},
      {"exponential", component(Family::exponential, {1}), 1, 1, -std::log(0.975), -std::log(0.025)},
  };
  for (const Truth& truth : truths) {
    int mean = 0, u = 0, low = 0, high = 0;
    for (int k = 0; k < repetitions; ++k) {
      auto s = scenario_of<Plain>({{0, {truth.component}}}, 20'000);
      s.run.seed = first + static_cast<std::uint64_t>(k);
      const propagation::Experiment e(s);
      Memory memory(1);
      propagation::propagate(e, memory, {});
      const auto m = analysis::summarise(e.outputs()[0], memory.rows[0], 0.95);
      const auto holds = [](double value, double exact, double se) { return std::fabs(value - exact) <= 1.96 * se; };
      mean += holds(m.estimate, truth.mean, m.estimate_se);
      u += holds(m.standard_uncertainty, truth.u, m.standard_uncertainty_se);
      low += holds(m.symmetric.low, truth.low, m.symmetric.low_se);
      high += holds(m.symmetric.high, truth.high, m.symmetric.high_se);
    }
    INFO(truth.name << ", " << repetitions << " runs");
    // Four binomial standard deviations; and one per cent for the standard errors of the ends, which are themselves
    // estimated from some 2 sqrt(n alpha) = 45 ranks (15 %), so that a t with about 22 degrees of freedom would do.
    const double margin = 4 * std::sqrt(0.05 * 0.95 / repetitions), estimated = 0.013;
    CHECK(std::fabs(mean / double(repetitions) - 0.95) < margin);
    CHECK(std::fabs(u / double(repetitions) - 0.95) < margin);
    CHECK(std::fabs(low / double(repetitions) - 0.95) < margin + estimated);
    CHECK(std::fabs(high / double(repetitions) - 0.95) < margin + estimated);
  }
}
