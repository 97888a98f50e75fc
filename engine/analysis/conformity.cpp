#include "analysis/conformity.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/binomial.hpp>
#include <fmt/format.h>

#include "analysis/complete.h"
#include "analysis/leaves.h"
#include "analysis/outputs.h"
#include "analysis/rounding.h"
#include "base/special_values.h"
#include "base/units.h"

namespace gumshoe::analysis {

namespace {

constexpr std::size_t most_deviations = 200'000; ///< of the integrals over the process

/// Closed; an absent limit is infinite.
struct Range {
  double low, high;
  bool contains(double x) const { return x >= low && x <= high; }
};

/// What is known before measuring.
class Prior {
public:
  explicit Prior(const scenario::ConformityTest& t) : distribution_(*t.process), value_(t.process_value) {}
  double mean() const { return value_ + distribution_.mean(); }
  double u() const { return std::sqrt(distribution_.variance()); }
  double density(double x) const { return distribution_.density(x - value_); }
  double below_or_at(double x) const {
    return x == infinity ? 1 : x == -infinity ? 0 : distribution_.probability(x - value_);
  }
  double below(double x) const {
    return x == infinity ? 1 : x == -infinity ? 0 : distribution_.probability(std::nextafter(x - value_, -infinity));
  }
  double within(Range r) const { return r.high >= r.low ? std::max(0.0, below_or_at(r.high) - below(r.low)) : 0; }

private:
  quantities::Distribution distribution_;
  double value_;
};

struct Mean {
  double value, se;
};

Mean mean_of(const std::vector<double>& x) {
  const double n = static_cast<double>(x.size());
  const double mean = sum_of(x.size(), [&](std::size_t i) { return x[i]; }) / n;
  const double square = sum_of(x.size(), [&](std::size_t i) { return (x[i] - mean) * (x[i] - mean); });
  return {mean, std::sqrt(square / (n - 1) / n)};
}

/// Sums of the samples' weights.
struct Weights {
  double total = 0, squares = 0, within = 0;
  void operator+=(const Weights& o) { total += o.total, squares += o.squares, within += o.within; }
};

/// Samples weighted by the prior's density: self-normalised, standard error by the delta method.
void posterior(ConformityResult& r, const Column& y, const Prior& prior, Range tolerance, int threads) {
  const Weights sums = leaf_sum<Weights>(y, threads, [&](std::span<const double> leaf) {
    Weights some;
    for (const double v : leaf) {
      const double weight = prior.density(v);
      some += {weight, weight * weight, tolerance.contains(v) ? weight : 0};
    }
    return some;
  });
  const double total = sums.total;
  constexpr double least = 100; // effective samples
  if (!(total > 0) || !std::isfinite(total) || total * total < least * sums.squares) {
    r.posterior_conformance = r.posterior_conformance_se = nan;
    return;
  }
  const double p = sums.within / total;
  const double spread = leaf_sum<double>(y, threads, [&](std::span<const double> leaf) {
    double some = 0;
    for (const double v : leaf) {
      const double d = prior.density(v) * ((tolerance.contains(v) ? 1.0 : 0.0) - p);
      some += d * d;
    }
    return some;
  });
  r.posterior_conformance = p;
  r.posterior_conformance_se = std::sqrt(spread) / total;
}

/// Over the deviations d: the prior's share that is (not) within tolerance while eta - d is (not) accepted.
void global_risks(ConformityResult& r, std::span<const double> y, double estimate, const Prior& prior, Range tolerance,
                  Range acceptance) {
  const std::size_t n = y.size();
  const double conforming = prior.within(tolerance);
  std::vector<double> consumer(n), producer(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double d = y[i] - estimate;
    const Range accepted{acceptance.low + d, acceptance.high + d};
    const double both = prior.within({std::max(accepted.low, tolerance.low), std::min(accepted.high, tolerance.high)});
    consumer[i] = std::max(0.0, prior.within(accepted) - both);
    producer[i] = std::max(0.0, conforming - both);
  }
  const Mean c = mean_of(consumer), p = mean_of(producer);
  r.process_mean = prior.mean();
  r.process_u = prior.u();
  r.process_conformance = conforming;
  r.global_consumer_risk = c.value;
  r.global_consumer_risk_se = c.se;
  r.global_producer_risk = p.value;
  r.global_producer_risk_se = p.se;
}

/// Distance from the estimate that at most 5 % of the samples exceed on either side: 1.65 u of a normal law, where no u
/// exists. Of the first samples, which are enough.
double one_sided_uncertainty(const Column& y, double estimate) {
  Room room;
  const auto some = y.read(0, std::min(most_deviations, y.size()), room);
  std::vector<double> values(some.begin(), some.end());
  if (values.empty()) return nan;
  const auto quantile = [&](double p) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
  };
  return std::max(estimate - quantile(0.05), quantile(0.95) - estimate);
}

/// The smallest probability that n independent samples resolve: none seen, it is below at 95 % confidence.
double least_probability(std::size_t n) { return std::min(1.0, 3 / static_cast<double>(n)); }

const char* said(const std::string& rule) {
  return rule == "simple_acceptance" ? "simple acceptance (JCGM 106, 8.2)"
         : rule == "iso_14253_1"     ? "ISO 14253-1"
         : rule == "ilac_g8"         ? "ILAC-G8, guard band w = U"
                                     : "";
}

std::string words(const ConformityResult& r, double expanded_uncertainty, std::size_t samples, std::uint64_t failed) {
  const auto& o = r.output;
  const auto decimals = [&](double x) {
    return x != 0 ? decimals_for(units::from_si(std::fabs(x), o.unit, o.si_unit, units::Kind::difference)) : 0;
  };
  const int digits = std::max({0, decimals(0.5 * expanded_uncertainty), decimals(r.guard_band)});
  const std::string unit = units::suffix(o.unit);
  const auto shown = [&](double x) { return fixed(units::from_si(x, o.unit, o.si_unit), digits) + unit; };
  const auto range = [&](double low, double high) {
    return std::isnan(low)    ? "at most " + shown(high)
           : std::isnan(high) ? "at least " + shown(low)
                              : "from " + shown(low) + " to " + shown(high);
  };
  const auto percent = [&](double p) { return probability_text(p, r.least_risk); };
  std::string text = fmt::format("{}: tolerance {}. ", o.name, range(r.lower, r.upper));
  if (const std::string rule = said(r.rule); !rule.empty()) text += "Decision rule: " + rule + ". ";
  if (r.guard_band != 0)
    text += fmt::format("Acceptance (the estimate must lie there) {}: guard band w = {}, {}. ",
                        range(r.acceptance_lower, r.acceptance_upper),
                        fixed(units::from_si(r.guard_band, o.unit, o.si_unit, units::Kind::difference), digits) + unit,
                        r.guard_band > 0 ? "inside the tolerance (guarded acceptance)"
                                         : "outside the tolerance (guarded rejection)");
  if (r.acceptance_lower >= r.acceptance_upper) text += "The guard bands leave no room for acceptance. ";
  text += fmt::format("The estimate {} is {}. Conformance probability (that the true value lies within the tolerance, "
                      "given this measurement alone): {}{}.",
                      shown(r.estimate), r.decision(), percent(r.conformance_probability),
                      r.conformance_probability == 1 || r.conformance_probability == 0
                          ? fmt::format(" (all of {} samples agree; 95 % confidence)", samples)
                          : "");
  text += r.accepted ? fmt::format(" Specific consumer's risk (that this accepted item does not conform): {}.",
                                   percent(r.specific_consumer_risk))
                     : fmt::format(" Specific producer's risk (that this rejected item conforms): {}.",
                                   percent(r.specific_producer_risk));
  if (!std::isnan(r.global_consumer_risk)) {
    text += std::isnan(r.posterior_conformance)
                ? " With the process as prior knowledge no conformance probability is stated: measurement and process "
                  "hardly overlap, or the process has no density."
                : fmt::format(" With the process as prior knowledge the conformance probability is {}.",
                              percent(r.posterior_conformance));
    text += fmt::format(" Of items that the process makes, {} conform; global consumer's risk (that an item does not "
                        "conform and is accepted): {}; global producer's risk (that an item conforms and is "
                        "rejected): {}.",
                        probability_text(r.process_conformance, 1e-6), percent(r.global_consumer_risk),
                        percent(r.global_producer_risk));
  }
  return text + failed_text(r, samples, failed);
}

double stated_expanded_uncertainty(const Summary& s) {
  return std::isfinite(s.expanded_uncertainty) ? s.expanded_uncertainty : 0.5 * (s.symmetric.high - s.symmetric.low);
}

} // namespace

std::string failed_text(const ConformityResult& r, std::uint64_t valid, std::uint64_t failed) {
  if (failed == 0) return "";
  const double share = static_cast<double>(failed) / static_cast<double>(failed + valid);
  return fmt::format(" {} failed samples are left out; they could move the conformance probability by {} at most.",
                     failed, probability_text(share, r.least_risk));
}

std::string ConformityResult::decision() const {
  const double to_limit = std::fmin(std::fabs(estimate - acceptance_lower), std::fabs(estimate - acceptance_upper));
  return std::string(accepted ? "accepted" : "rejected") +
         (estimate_se > 0 && to_limit <= 2 * estimate_se
              ? " by chance (an acceptance limit is within twice the estimate's Monte Carlo standard error)"
              : "");
}

ConformityResult assess(const Column& samples, const Known& known, const scenario::ConformityTest& test, int threads) {
  const auto& [estimate, standard_uncertainty, expanded_uncertainty] = known;
  ConformityResult r;
  const Complete valid(
      {samples}, [](double v) { return !std::isnan(v); }, threads);
  const Column y = valid.column(0);
  r.estimate = estimate;
  r.lower = test.lower.value_or(nan);
  r.upper = test.upper.value_or(nan);
  r.rule = name(test.rule);
  r.guard_band = test.guard_band + (test.guard_factor != 0 ? test.guard_factor * expanded_uncertainty : 0);
  if (test.rule == scenario::DecisionRule::ilac_g8) r.guard_band = expanded_uncertainty;
  if (test.rule == scenario::DecisionRule::iso_14253_1)
    r.guard_band =
        std::isfinite(standard_uncertainty) ? 1.65 * standard_uncertainty : one_sided_uncertainty(y, estimate);
  r.acceptance_lower = r.lower + r.guard_band;
  r.acceptance_upper = r.upper - r.guard_band;
  const Range tolerance{test.lower.value_or(-infinity), test.upper.value_or(infinity)};
  const Range acceptance{tolerance.low + r.guard_band, tolerance.high - r.guard_band};
  r.specific_consumer_risk = r.specific_producer_risk = r.process_mean = r.process_u = r.process_conformance =
      r.posterior_conformance = r.posterior_conformance_se = r.global_consumer_risk = r.global_consumer_risk_se =
          r.global_producer_risk = r.global_producer_risk_se = nan;
  if (y.size() == 0) {
    r.conformance_probability = r.conformance_probability_se = nan;
    r.least_risk = 1;
    return r;
  }
  const double n = static_cast<double>(y.size());
  const auto inside = static_cast<double>(leaf_sum<std::ptrdiff_t>(y, threads, [&](std::span<const double> leaf) {
    return std::ranges::count_if(leaf, [&](double v) { return tolerance.contains(v); });
  }));
  r.conformance_probability = inside / n;
  // One sample more on either side: none is not a proof that there is none.
  const double p = (inside + 1) / (n + 2);
  r.conformance_probability_se = std::sqrt(p * (1 - p) / n);
  using Binomial = boost::math::binomial_distribution<double>;
  if (inside > 0) r.conformance_probability_low = Binomial::find_lower_bound_on_p(n, inside, 0.05);
  if (inside < n) r.conformance_probability_high = Binomial::find_upper_bound_on_p(n, inside, 0.05);
  r.least_risk = least_probability(test.process ? std::min(most_deviations, y.size()) : y.size());
  r.accepted = acceptance.contains(estimate);
  (r.accepted ? r.specific_consumer_risk : r.specific_producer_risk) =
      r.accepted ? 1 - r.conformance_probability : r.conformance_probability;
  if (test.process && y.size() > 1) {
    const Prior prior(test);
    posterior(r, y, prior, tolerance, threads);
    Room room;
    global_risks(r, y.read(0, std::min(most_deviations, y.size()), room), estimate, prior, tolerance, acceptance);
  }
  return r;
}

std::vector<ConformityResult> conformity(const propagation::Experiment& e, const ValuesOf& values,
                                         const std::vector<Summary>& summaries, int threads) {
  std::vector<ConformityResult> results;
  for (const auto& test : e.scenario().analysis.conformity)
    for (const std::size_t o : outputs_named(e, test.measurand, test.labels)) {
      const Summary& s = summaries[o];
      const double expanded = stated_expanded_uncertainty(s);
      Room room;
      ConformityResult r = assess(held(values(o), room), {s.estimate, s.standard_uncertainty, expanded}, test, threads);
      r.output = e.outputs()[o];
      r.estimate_se = s.estimate_se;
      if (e.scenario().run.design != scenario::Design::monte_carlo)
        r.estimate_se = r.conformance_probability_se = r.posterior_conformance_se = r.global_consumer_risk_se =
            r.global_producer_risk_se = nan;
      r.statement = words(r, expanded, s.valid, s.failed);
      results.push_back(std::move(r));
    }
  return results;
}

} // namespace gumshoe::analysis
