#include "analysis/target.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/combine.h"
#include "analysis/gum.h"
#include "analysis/outputs.h"
#include "analysis/reach.h"
#include "analysis/rounding.h"
#include "analysis/trial.h"
#include "base/special_values.h"
#include "base/units.h"

namespace gumshoe::analysis {

namespace {

constexpr double largest_scale = 100, tolerance = 1e-3;

/// The largest scale s in [0, 100] with U(s) <= wanted, where U^2 is nearly linear in s^2: Illinois steps in s^2 within
/// a bracket. NaN: not even the smallest U reaches it; infinite: it does not matter. `dip`: where U is least, if that
/// is known to lie above 0 (correlated inputs).
template <class Function>
double largest_allowed(const Function& u, double at_1, double at_0, double wanted, double dip) {
  struct Tried {
    double x, f; // s^2, U^2 - wanted^2
  };
  const auto excess = [&](double value) { return value * value - wanted * wanted; };
  const auto at = [&](double x) { return Tried{x, excess(u(std::sqrt(x)))}; };
  Tried low{0, excess(at_0)}, high{1, excess(at_1)};
  if (low.f > 0 && dip > 0) {
    low = at(dip * dip);
    if (low.x > high.x) high = low;
  }
  if (high.f <= 0) { // the target is met already: how much more would do?
    constexpr double most = largest_scale * largest_scale;
    while (high.f <= 0) {
      const double slope = (high.f - low.f) / (high.x - low.x);
      low = high;
      if (low.x >= most) return infinity;
      const double guess = slope > 0 ? low.x - 1.05 * low.f / slope : most;
      high = at(std::clamp(guess, low.x * 1.02, most));
    }
  }
  if (low.f > 0) return nan;
  for (int step = 0; step < 60 && high.x - low.x > 2 * tolerance * high.x; ++step) {
    double x = std::isfinite(high.f) ? (low.x * high.f - high.x * low.f) / (high.f - low.f) : 0.5 * (low.x + high.x);
    // A little to either side, so that the bracket closes from both.
    const double margin = 0.4 * tolerance * high.x;
    if (step > 0) x += step % 2 == 0 ? -margin : margin;
    if (step % 5 == 4) x = 0.5 * (low.x + high.x);
    const Tried p = at(std::clamp(x, low.x + 0.25 * tolerance * high.x, high.x - 0.25 * tolerance * high.x));
    (p.f <= 0 ? low : high) = p;
  }
  return std::sqrt(low.x);
}

/// The law of propagation as a function of the scale of one quantity.
class Law {
public:
  Law(const Budget& b, const propagation::Experiment& e, double p) : budget_(b), correlations_(e.plan()), p_(p) {
    for (const auto& r : variates_reaching(e, b.output.reading)) variates_.push_back(r.variate);
  }
  bool applicable() const { return budget_.applicable && budget_.combined_standard_uncertainty > 0; }
  double signed_contribution(std::size_t i) const {
    const Contribution& c = budget_.contributions[i];
    return c.differentiable && c.standard_uncertainty > 0 ? c.sensitivity * c.standard_uncertainty : 0;
  }
  double own_variance(const std::string& quantity) const {
    double sum = 0;
    for (std::size_t i = 0; i < variates_.size(); ++i)
      if (budget_.contributions[i].quantity == quantity) sum += std::pow(signed_contribution(i), 2);
    return sum;
  }
  double share(const std::string& quantity) const {
    return own_variance(quantity) / std::pow(budget_.combined_standard_uncertainty, 2);
  }
  CombinedVariance combined(const std::string& quantity, double scale) {
    std::vector<Term> terms;
    for (std::size_t i = 0; i < variates_.size(); ++i) {
      const Contribution& c = budget_.contributions[i];
      terms.push_back(
          {variates_[i], (c.quantity == quantity ? scale : 1) * signed_contribution(i), c.degrees_of_freedom});
    }
    return combine(terms, correlations_);
  }
  double expanded_uncertainty(const std::string& quantity, double scale) {
    return expand(combined(quantity, scale), p_).expanded_uncertainty;
  }
  /// 2 sum over own i and others j of c_i c_j u_i u_j r_ij, from the variance at three scales.
  double cross(const std::string& quantity) {
    const double none = combined(quantity, 0).total(), once = combined(quantity, 1).total(),
                 twice = combined(quantity, 2).total();
    return 2 * (once - none) - 0.5 * (twice - none);
  }
  /// Where U is least: the vertex of the quadratic, which lies above 0 only if inputs are correlated.
  double dip(const std::string& quantity) {
    const double own = own_variance(quantity);
    return own > 0 ? std::clamp(-0.5 * cross(quantity) / own, 0.0, largest_scale) : 0;
  }

private:
  const Budget& budget_;
  quantities::Correlations correlations_;
  double p_;
  std::vector<std::size_t> variates_;
};

class Study {
public:
  Study(const propagation::Experiment& e, const scenario::Target& target, std::size_t output, const Summary& summary,
        const Budget& budget, int threads)
      : target_(target), law_(budget, e, e.scenario().analysis.coverage_probability), trial_(e, output, threads),
        ones_(trial_.experiment().plan().variates.size(), 1.0), stated_(summary.expanded_uncertainty) {
    // The ends of the interval are independent but for what they share in the middle.
    relative_se_ = std::hypot(summary.symmetric.low_se, summary.symmetric.high_se) /
                   (summary.symmetric.high - summary.symmetric.low) *
                   std::sqrt(static_cast<double>(summary.valid) / static_cast<double>(trial_.points()));
    result_.output = e.outputs()[output];
    result_.wanted = target.expanded_uncertainty;
    result_.reached = result_.cost_ratio = nan;
    for (const Contribution& c : budget.contributions) {
      auto row = std::ranges::find_if(result_.rows, [&](const TargetRow& r) { return r.quantity == c.quantity; });
      if (row == result_.rows.end()) row = result_.rows.insert(row, {c.quantity, c.unit, c.si_unit, 0, 0, 0, 0, 0});
      row->present = std::hypot(row->present, c.standard_uncertainty);
      row->allowed = row->allowed_gum = row->cost = row->cheapest = nan;
    }
    for (const auto& [quantity, cost] : target.costs)
      for (TargetRow& row : result_.rows)
        if (row.quantity == quantity) row.cost = cost;
  }

  TargetResult result() {
    const double tried = trial_.expanded_uncertainty(ones_);
    if (stated_ > 0 && tried > 0 && std::isfinite(tried)) per_tried_ = stated_ / tried;
    result_.present = per_tried_ * tried;
    for (TargetRow& row : result_.rows) one(row);
    cheapest();
    say();
    return result_;
  }

private:
  /// U of a trial, of the same kind as the stated one.
  double expanded(const std::vector<double>& scale) { return per_tried_ * trial_.expanded_uncertainty(scale); }

  /// Scales of the variates when each quantity has its own.
  std::vector<double> scales(const std::vector<double>& of_row) const {
    auto scale = ones_;
    const auto& e = trial_.experiment();
    for (const std::size_t v : trial_.reaching())
      for (std::size_t r = 0; r < result_.rows.size(); ++r)
        if (e.scenario().quantities[e.plan().variates[v].quantity].name == result_.rows[r].quantity)
          scale[v] = of_row[r];
    return scale;
  }

  void one(TargetRow& row) {
    const auto index = static_cast<std::size_t>(&row - result_.rows.data());
    const auto u = [&](double s) {
      std::vector<double> of_row(result_.rows.size(), 1.0);
      of_row[index] = s;
      return expanded(scales(of_row));
    };
    const double without = u(0);
    drop_.push_back(result_.present * result_.present - without * without);
    const double dip = law_.applicable() ? law_.dip(row.quantity) : 0;
    row.allowed = row.present * largest_allowed(u, result_.present, without, target_.expanded_uncertainty, dip);
    // U^2 is nearly linear in the square of the scale: its error divides by what of U^2 the quantity may have.
    const double wanted = result_.wanted * result_.wanted, room = std::fabs(wanted - without * without);
    if (const double error = relative_se_ * wanted / room; std::isfinite(row.allowed) && error > 0.01)
      uncertain_.push_back(fmt::format("{} {:.2g} %", row.quantity, 100 * error));
    if (!law_.applicable()) return;
    const auto by_law = [&](double s) { return law_.expanded_uncertainty(row.quantity, s); };
    row.allowed_gum = row.present * largest_allowed(by_law, by_law(1), by_law(0), target_.expanded_uncertainty, dip);
  }

  void cheapest() {
    std::vector<double> shape(result_.rows.size(), 1.0);
    std::vector<bool> moves(result_.rows.size(), false);
    double now = 0;
    for (std::size_t r = 0; r < result_.rows.size(); ++r) {
      TargetRow& row = result_.rows[r];
      if (std::isnan(row.cost)) continue;
      now += row.cost;
      row.cheapest = row.present;
      double q = law_.applicable() ? law_.share(row.quantity) : 0;
      if (!(q > 0)) q = drop_[r] / (result_.present * result_.present);
      if (!(q > 1e-6)) continue; // it does not matter: no reason to pay more, nor less
      moves[r] = true;
      shape[r] = std::cbrt(row.cost / q);
    }
    if (std::ranges::none_of(moves, [](bool m) { return m; })) {
      if (now > 0) no_cheapest("no quantity with a cost matters");
      return;
    }
    const auto of_row = [&](double common) {
      std::vector<double> s(shape.size(), 1.0);
      for (std::size_t r = 0; r < s.size(); ++r)
        if (moves[r]) s[r] = common * shape[r];
      return s;
    };
    // The common factor that the linear law would take, as the unit of the search.
    double variance = 0, moved = 0;
    for (std::size_t r = 0; r < shape.size(); ++r)
      if (moves[r]) variance += drop_[r], moved += drop_[r] * shape[r] * shape[r];
    const double wanted = target_.expanded_uncertainty, rest = result_.present * result_.present - variance;
    double unit = std::sqrt(std::max(wanted * wanted - rest, 0.01 * wanted * wanted) / std::max(moved, 1e-300));
    if (!std::isfinite(unit) || !(unit > 0)) unit = 1;
    const auto u = [&](double s) { return expanded(scales(of_row(s * unit))); };
    const double common = unit * largest_allowed(u, u(1), u(0), wanted, 0);
    if (std::isnan(common)) return no_cheapest("the quantities without a cost alone exceed the target");
    if (std::isinf(common)) return no_cheapest("no limit, because the quantities with a cost hardly matter");
    double then = 0;
    const auto s = of_row(common);
    for (std::size_t r = 0; r < s.size(); ++r) {
      TargetRow& row = result_.rows[r];
      if (std::isnan(row.cost)) continue;
      row.cheapest = s[r] * row.present;
      then += row.cost / s[r];
    }
    result_.reached = expanded(scales(s));
    result_.cost_ratio = then / now;
  }

  void no_cheapest(const std::string& why) {
    why_not_ = why;
    for (TargetRow& row : result_.rows) row.cheapest = nan;
  }

  void say() {
    const auto& o = result_.output;
    const auto width = [&](double x) { return units::from_si(x, o.unit, o.si_unit, units::Kind::difference); };
    const std::string unit = units::suffix(o.unit);
    const int digits = decimals_for(width(0.5 * std::min(result_.present, result_.wanted)));
    result_.statement = fmt::format(
        "{}: wanted U = {}{}, at present U = {}{}{}. Each allowed standard "
        "uncertainty stands alone, the others as they are; found with common random numbers, with a relative "
        "standard error of at most {}",
        o.name, fixed(width(result_.wanted), digits), unit, fixed(width(result_.present), digits), unit,
        std::isfinite(stated_) ? "" : " (half the interval about the mean; the result states no U)",
        uncertain_.empty() ? "1 %" : fmt::format("{}", fmt::join(uncertain_, ", ")));
    if (!std::isnan(result_.reached))
      result_.statement += fmt::format(". Cheapest combination: U = {}{} at {:.3g} times the present cost, the cost of "
                                       "a quantity being inversely proportional to its standard uncertainty",
                                       fixed(width(result_.reached), digits), unit, result_.cost_ratio);
    else if (!why_not_.empty())
      result_.statement += ". No cheapest combination: " + why_not_;
    result_.statement += fmt::format(". {} model runs of {} points each.", trial_.runs(), trial_.points());
  }

  const scenario::Target& target_;
  Law law_;
  Trial trial_;
  std::vector<double> ones_;
  double stated_, per_tried_ = 1; ///< U of the result, NaN if none is stated; U for a unit of a trial's
  std::vector<double> drop_; ///< by row: how much U^2 falls without the quantity
  TargetResult result_;
  std::string why_not_;
  double relative_se_ = 0;             ///< of U of a trial
  std::vector<std::string> uncertain_; ///< quantities whose allowed u is known to no better than 1 %
};

} // namespace

std::vector<TargetResult> target_uncertainties(const propagation::Experiment& e, const std::vector<Summary>& summaries,
                                               const std::vector<Budget>& budgets, int threads) {
  std::vector<TargetResult> results;
  for (const auto& target : e.scenario().analysis.targets)
    for (const std::size_t o : outputs_named(e, target.measurand, target.labels))
      results.push_back(Study(e, target, o, summaries[o], budgets[o], threads).result());
  return results;
}

} // namespace gumshoe::analysis
