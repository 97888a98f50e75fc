#include "analysis/stopping.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "analysis/summary.h"
#include "analysis/tolerance.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

constexpr std::uint64_t endless = std::numeric_limits<std::uint64_t>::max();

double variance(const std::vector<double>& x) { return x.size() < 2 ? nan : moments(x).variance; }

/// Standard uncertainty of all blocks together, from their means and standard deviations; blocks are equally long
/// except for failed samples.
double pooled_uncertainty(const std::vector<double>& mean, const std::vector<double>& u) {
  double within = 0;
  for (const double v : u) within += v * v / static_cast<double>(u.size());
  return std::sqrt(within + (mean.size() > 1 ? variance(mean) : 0));
}

} // namespace

StoppingRules::StoppingRules(std::vector<propagation::Output> outputs, double coverage_probability, int digits,
                             double share)
    : outputs_(std::move(outputs)), p_(coverage_probability), share_(share), digits_(digits),
      block_(std::max<std::uint64_t>(static_cast<std::uint64_t>(std::ceil(100 / (1 - coverage_probability))), 10'000)),
      figures_(outputs_.size()) {}

void StoppingRules::add(std::size_t output, std::span<const double> values) {
  std::vector<double> valid;
  for (const double v : values)
    if (!std::isnan(v)) valid.push_back(v);
  const Moments m = moments(valid);
  const Ends ends = valid.size() < 2 ? Ends{nan, nan} : symmetric_ends(valid, p_);
  Figures& f = figures_[output];
  f.mean.push_back(m.mean);
  f.u.push_back(std::sqrt(m.variance));
  f.low.push_back(ends.low);
  f.high.push_back(ends.high);
  if (output + 1 == outputs_.size()) {
    ++blocks_;
    look();
  }
}

void StoppingRules::look() {
  bool settled = blocks_ >= 2;
  std::uint64_t asked = first_stage;
  const double h = static_cast<double>(blocks_);
  for (std::size_t o = 0; o < outputs_.size(); ++o) {
    Figures& f = figures_[o];
    const double u = pooled_uncertainty(f.mean, f.u);
    if (u == 0) { // a constant is known at once
      f.tolerance = nan;
      continue;
    }
    const double delta = f.tolerance = std::isfinite(u) ? share_ * numerical_tolerance(u, digits_, outputs_[o]) : nan;
    for (const auto* figure : {&f.mean, &f.u, &f.low, &f.high}) {
      const double s2 = variance(*figure);
      if (!(4 * s2 / h <= delta * delta)) settled = false; // NaN is not settled
      if (blocks_ != first_stage) continue;
      const double t = quantile(boost::math::students_t(static_cast<double>(first_stage - 1)), 0.975);
      const double needed = std::ceil(t * t * s2 / (delta * delta));
      asked = std::max(asked, needed < 1e15 ? static_cast<std::uint64_t>(needed) : endless); // NaN: without end
    }
  }
  settled_ = settled;
  if (settled && jcgm_ == 0) jcgm_ = blocks_;
  if (blocks_ == first_stage) stein_ = asked;
}

std::vector<double> StoppingRules::tolerances() const {
  std::vector<double> out;
  for (const Figures& f : figures_) out.push_back(f.tolerance);
  return out;
}

namespace {

/// Where the run must go next, in blocks: as far as is known to be needed.
std::uint64_t next_goal(const StoppingRules& rules, bool stein, bool validation, std::uint64_t most) {
  const std::uint64_t done = rules.blocks();
  if (done < StoppingRules::first_stage) return std::min(StoppingRules::first_stage, most);
  const std::uint64_t needed = stein ? rules.stein_blocks() : rules.jcgm_blocks();
  if (needed > done || (needed > 0 && (rules.settled() || !validation))) return std::min(needed, most);
  return std::min(done + std::max<std::uint64_t>(4, done / 4), most); // the printed rule: a few more, and look again
}

} // namespace

/// Share of delta that a validation run aims at. Clause 8 needs a fifth; the margin covers that blocks and ranks estimate
/// the same standard errors differently.
constexpr double validation_share = 0.15;

StoppingRecord run_adaptively(const propagation::Experiment& e, propagation::SampleStore& store,
                              propagation::RunSettings settings, bool& stopped) {
  const auto& options = e.scenario().run.adaptive;
  StoppingRules rules(e.outputs(), e.scenario().analysis.coverage_probability, options.digits,
                      options.validation ? validation_share : 1.0);
  const std::uint64_t block = rules.block(), most = std::max<std::uint64_t>(2, options.most / block);
  const bool stein = options.rule == scenario::StoppingRule::stein;
  stopped = false;
  for (;;) {
    const std::uint64_t goal = next_goal(rules, stein, options.validation, most);
    if (rules.blocks() >= goal) break;
    if (store.samples_done() / block > rules.blocks()) { // one block after another, however far was run ahead
      const std::uint64_t at = rules.blocks() * block;
      for (std::size_t o = 0; o < e.outputs().size(); ++o) rules.add(o, store.read(o, at, block));
      continue;
    }
    // Blocks of samples start at multiples of their size: from such a one to the end of the last one.
    settings.first = store.samples_done() / propagation::block_samples * propagation::block_samples;
    if (settings.first != store.samples_done()) store.resize(settings.first);
    settings.last =
        (goal * block + propagation::block_samples - 1) / propagation::block_samples * propagation::block_samples;
    if (store.samples() < settings.last) store.resize(settings.last);
    propagation::propagate(e, store, settings);
    if (store.samples_done() < settings.last) {
      stopped = true;
      return {};
    }
  }
  StoppingRecord r;
  r.rule = name(options.rule);
  r.digits = options.digits;
  r.block = block;
  r.jcgm_trials = rules.jcgm_blocks() * block;
  r.stein_trials = rules.stein_blocks() == endless ? 0 : rules.stein_blocks() * block;
  const std::uint64_t needed = stein ? rules.stein_blocks() : rules.jcgm_blocks();
  r.reached = needed > 0 && needed <= most && (rules.settled() || !options.validation);
  r.trials = std::min(r.reached && !options.validation ? needed : most, rules.blocks()) * block;
  r.tolerance = rules.tolerances();
  store.resize(r.trials);
  const bool further = r.reached && r.trials > needed * block; // needed: by the rule alone
  r.statement = fmt::format("adaptive run, {} significant digits of u: {} trials by the {} rule{}; the rule of JCGM "
                            "101 7.9 {}, the two-stage "
                            "rule {}",
                            r.digits, r.trials, stein ? "two-stage (Stein)" : "JCGM 101 7.9",
                            !r.reached ? fmt::format(", which was not satisfied at max_samples = {}", options.most)
                            : further  ? ", and on until all of them satisfy JCGM 101 7.9, as a validation asks"
                                       : "",
                            r.jcgm_trials > 0 ? fmt::format("stops at {}", r.jcgm_trials) : "has not stopped by then",
                            r.stein_trials > 0 ? fmt::format("asks for {}", r.stein_trials) : "can give no number");
  return r;
}

} // namespace gumshoe::analysis
