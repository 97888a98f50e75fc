#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "quantities/cells.h"
#include "quantities/copula.h"
#include "scenario/context.h"
#include "scenario/earlier.h"

namespace gumshoe::scenario {
namespace {

using quantities::Component;
using Share = EarlierOutput::Share;

/// Of the samples that succeeded in both: the standard normal quantiles of their ranks, correlated.
double correlation_of_scores(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<std::size_t> both;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (!std::isnan(a[i]) && !std::isnan(b[i])) both.push_back(i);
  const std::size_t n = both.size(), padded = (n + 7) / 8 * 8;
  if (n < 2) return 0;
  std::vector<double> quantiles(padded, 0.5);
  for (std::size_t i = 0; i < n; ++i) quantiles[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  const quantities::QuantileFunction normal({quantities::Family::normal, {0, 1}, {}, {}});
  normal(quantiles.data(), quantiles.data(), padded);
  const auto scores = [&](const std::vector<double>& values) {
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[both[i]]; });
    std::vector<double> out(n);
    for (std::size_t i = 0; i < n; ++i) out[order[i]] = quantiles[i];
    return out;
  };
  const std::vector<double> x = scores(a), y = scores(b);
  const double r =
      std::inner_product(x.begin(), x.end(), y.begin(), 0.0) / std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
  return std::clamp(r, -1.0, 1.0);
}

/// Pearson's, of the samples that succeeded in both.
double correlation_of_samples(const std::vector<double>& a, const std::vector<double>& b) {
  double n = 0, mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (std::isnan(a[i]) || std::isnan(b[i])) continue;
    n += 1;
    const double da = a[i] - mean_a, db = b[i] - mean_b;
    mean_a += da / n, mean_b += db / n;
    aa += da * (a[i] - mean_a), bb += db * (b[i] - mean_b), ab += da * (b[i] - mean_b);
  }
  return aa > 0 && bb > 0 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : 0;
}

/// A draw of the scenario, as a correlation names it.
struct Draw {
  std::string name; ///< "laser_z", "laser_z.seat", "laser_z[rod = rod 1]"
  std::string quantity;
  std::string component; ///< as budgets name it: "rod_length[rod 1]: seat"
  const Component* stated = nullptr;
  const EarlierOutput* output = nullptr; ///< null: the scenario's own
};

std::vector<Draw> draws_of(const std::vector<quantities::InputQuantity>& quantities, const EarlierResults& results) {
  std::vector<Draw> out;
  for (const auto& q : quantities)
    for (const auto& entry : q.entries)
      for (const Component& c : entry.components) {
        auto labels = entry.labels;
        std::ranges::sort(labels); // as draws are named
        const std::string place = labels.empty() ? q.name : fmt::format("{}[{}]", q.name, quantities::text_of(labels));
        const bool several = entry.components.size() > 1;
        const std::string budget = several ? fmt::format("{}: {}", place, c.name) : place;
        out.push_back({several && labels.empty() ? fmt::format("{}.{}", q.name, c.name) : budget, q.name, budget, &c,
                       c.earlier ? &results.output(*c.earlier) : nullptr});
      }
  return out;
}

class Ties {
public:
  Ties(std::vector<Draw> draws, const Node& document, Context& context)
      : draws_(std::move(draws)), document_(document), context_(context), set_(draws_.size()) {
    std::iota(set_.begin(), set_.end(), 0);
  }

  std::vector<quantities::Correlation> find() {
    const std::size_t n = draws_.size();
    std::vector<Coefficient> r(n * n);
    for (std::size_t i = 0; i < n; ++i) {
      r[i * n + i] = {1, 1};
      if (!draws_[i].output) continue;
      check_same(draws_[i]);
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i || (draws_[j].output && j > i)) continue;
        const Coefficient tied = draws_[j].output ? between(draws_[i], draws_[j]) : with_own(draws_[i], draws_[j]);
        if (tied.of_draws == 0) continue;
        r[i * n + j] = r[j * n + i] = tied;
        join(i, j);
      }
    }
    std::vector<quantities::Correlation> out;
    for (std::size_t first = 0; first < n; ++first) {
      std::vector<std::size_t> members;
      for (std::size_t i = 0; i < n; ++i)
        if (root(i) == first) members.push_back(i);
      if (members.size() < 2) continue;
      quantities::Correlation c;
      for (const std::size_t i : members) {
        c.quantities.push_back(draws_[i].name);
        for (const std::size_t j : members) {
          c.matrix.push_back(r[i * n + j].of_draws);
          c.law.push_back(r[i * n + j].of_law);
        }
      }
      c.together = ranks_together(members);
      if (!c.together.empty()) c.law = law_together(members);
      context_.note(fmt::format("{}: {}", fmt::join(c.quantities, ", "),
                                c.together.empty() ? "tied as their results are, by a Gaussian copula"
                                                   : "drawn together, as their run drew them"));
      out.push_back(std::move(c));
    }
    return out;
  }

private:
  struct Coefficient {
    double of_draws = 0; ///< of the copula
    double of_law = 0;   ///< of the law of propagation
  };

  /// By output of one file with samples: the rank of its value, sample by sample, where none of them failed. Empty if
  /// the members are not all of that kind.
  std::vector<std::vector<std::uint32_t>> ranks_together(const std::vector<std::size_t>& members) const {
    std::vector<const std::vector<double>*> samples;
    for (const std::size_t i : members) {
      const Draw& d = draws_[i];
      if (!d.output || d.stated->distribution.family != quantities::Family::empirical ||
          d.stated->earlier->file != draws_[members[0]].stated->earlier->file)
        return {};
      samples.push_back(&d.output->samples);
    }
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < samples[0]->size(); ++row)
      if (std::ranges::all_of(samples, [&](const auto* s) { return row < s->size() && !std::isnan((*s)[row]); }))
        rows.push_back(row);
    if (rows.empty()) return {};
    std::vector<std::vector<std::uint32_t>> out;
    for (const auto* s : samples) {
      std::vector<std::size_t> order; // as the distribution sorts its values
      for (std::size_t row = 0; row < s->size(); ++row)
        if (!std::isnan((*s)[row])) order.push_back(row);
      std::ranges::stable_sort(order, {}, [&](std::size_t row) { return (*s)[row]; });
      std::vector<std::uint32_t> rank(s->size());
      for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<std::uint32_t>(k);
      out.emplace_back();
      for (const std::size_t row : rows) out.back().push_back(rank[row]);
    }
    return out;
  }

  /// Sum of the products c_i u_i c_j u_j of the components that both budgets have; NaN where one has no derivative.
  static double product(const Draw& a, const Draw& b) {
    double sum = 0;
    for (const Share& s : a.output->shares)
      for (const Share& t : b.output->shares)
        if (s.component == t.component) sum += s.contribution * t.contribution;
    return sum;
  }
  /// Whether the law of propagation has a u of it that is not that of its samples: a t counts by its scale.
  static bool by_scale(const Draw& d) { return std::isfinite(d.output->degrees_of_freedom); }

  /// Whether its contributions add up to u: the first order suffices, and no correlation takes part.
  static bool accounted(const Draw& d) {
    const double u = d.output->standard_uncertainty;
    double variance = 0;
    for (const Share& s : d.output->shares) variance += std::pow(s.contribution * (by_scale(d) ? 1 : s.spread), 2);
    // A u of samples has a standard error of 1 / sqrt(2 n).
    const double apart =
        by_scale(d) ? 1e-6 : 0.01 + 4 * std::sqrt(2 / static_cast<double>(std::max<std::uint64_t>(d.output->drawn, 1)));
    return std::abs(variance - u * u) <= apart * u * u; // not if it is NaN
  }

  /// Whether it is a t with these degrees of freedom in all its components, such as estimates that share one s: the
  /// samples then have the coefficients of the scales, and every sum has these degrees of freedom.
  static bool one_scale(const Draw& d, double degrees_of_freedom) {
    return degrees_of_freedom > 2 && std::ranges::all_of(d.output->shares, [&](const Share& s) {
             const double t = degrees_of_freedom / (degrees_of_freedom - 2); // variance over scale squared
             return s.contribution == 0 || std::abs(s.spread * s.spread - t) <= 1e-6 * t;
           });
  }

  /// Coefficient of two budgets that account for u.
  static double by_budgets(const Draw& a, const Draw& b) {
    const double both = std::sqrt(product(a, a) * product(b, b));
    return both > 0 ? std::clamp(product(a, b) / both, -1.0, 1.0) : 0;
  }

  /// Coefficients that the law of propagation takes for outputs that are drawn together; empty: those of the samples.
  /// Samples weigh a component that is a t by its variance, and u weighs it by its scale.
  std::vector<double> law_together(const std::vector<std::size_t>& members) {
    const auto all = [&](const auto& is) {
      return std::ranges::all_of(members, [&](std::size_t i) { return is(draws_[i]); });
    };
    const double freedom = draws_[members[0]].output->degrees_of_freedom;
    if (all([](const Draw& d) { return !by_scale(d); })) return {};
    if (all([&](const Draw& d) { return d.output->degrees_of_freedom == freedom && one_scale(d, freedom); })) return {};
    const bool known = all(accounted);
    std::vector<double> out;
    for (const std::size_t i : members)
      for (const std::size_t j : members)
        out.push_back(i == j  ? 1
                      : known ? by_budgets(draws_[i], draws_[j])
                              : correlation_of_samples(draws_[i].output->samples, draws_[j].output->samples));
    if (known) return out;
    std::vector<std::string> names;
    for (const std::size_t i : members) names.push_back(draws_[i].name);
    context_.note(fmt::format("{}: the law of propagation takes the correlation of their samples, in which quantities "
                              "of few degrees of freedom weigh more than in u (their budgets do not account for u)",
                              fmt::join(names, ", ")));
    return out;
  }

  std::size_t root(std::size_t i) const {
    while (set_[i] != i) i = set_[i];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    const auto [low, high] = std::minmax({root(i), root(j)});
    set_[high] = low;
  }
  static bool names(const Draw& d, const std::string& quantity) {
    return std::ranges::find(d.stated->earlier->same, quantity) != d.stated->earlier->same.end();
  }
  static double u_of(const Draw& d) { return d.stated->distribution.standard_uncertainty(); }

  /// By covariances: of the draws and of the uncertainties.
  static Coefficient coefficient(const Draw& a, const Draw& b, double of_draws, double of_law) {
    const auto &x = a.stated->distribution, &y = b.stated->distribution;
    const double variances = x.variance() * y.variance();
    Coefficient out;
    out.of_law = std::clamp(of_law / (u_of(a) * u_of(b)), -1.0, 1.0);
    if (!std::isfinite(variances)) { // of a t with few degrees of freedom: its scale
      out.of_draws = out.of_law;
      return out;
    }
    out.of_draws = std::clamp(of_draws / std::sqrt(variances), -1.0, 1.0);
    try {
      using quantities::Correlation;
      out.of_draws = quantities::copula_coefficient(Correlation::Kind::pearson, out.of_draws, x, y, a.name);
    } catch (const InputError&) { // beyond what two such shapes can have: as near as they come
    }
    return out;
  }

  Coefficient between(const Draw& a, const Draw& b) {
    const bool one_file = a.stated->earlier->file == b.stated->earlier->file;
    if (one_file && !a.output->samples.empty() && !b.output->samples.empty()) {
      const double scores = correlation_of_scores(a.output->samples, b.output->samples);
      if ((by_scale(a) || by_scale(b)) && accounted(a) && accounted(b)) return {scores, by_budgets(a, b)};
      return {scores, quantities::pearson_coefficient(scores, a.stated->distribution, b.stated->distribution)};
    }
    double covariance = 0, of_draws = 0;
    for (const Share& s : a.output->shares)
      for (const Share& t : b.output->shares) {
        if (s.component != t.component) continue;
        if (one_file || (names(a, s.quantity) && names(b, s.quantity))) {
          if (const double both = s.contribution * t.contribution; !std::isnan(both)) {
            covariance += both;
            of_draws += both * s.spread * t.spread;
          }
        } else if (s.evaluation == 'B' && t.evaluation == 'B' && s.u > 0 && s.u == t.u &&
                   s.distribution == t.distribution) {
          context_.note(
              fmt::format("{} and {}: treated as independent, although the budgets of both list '{}' alike. If "
                          "it is one error, such as that of one certificate, add same = [\"{}\"] to both",
                          a.name, b.name, s.component, s.quantity));
        }
      }
    return coefficient(a, b, of_draws, covariance);
  }

  Coefficient with_own(const Draw& a, const Draw& own) {
    if (!names(a, own.quantity)) return {};
    for (const Share& s : a.output->shares) {
      if (s.component != own.component || std::isnan(s.contribution)) continue;
      if (std::abs(s.u - u_of(own)) > 1e-6 * s.u) {
        context_.problems.add(place(a),
                              fmt::format("{}: '{}' has u = {:.6g} here and {:.6g} in {} (SI)", a.name, own.component,
                                          u_of(own), s.u, a.stated->earlier->file),
                              "one error has one uncertainty", "state it alike, or leave it out of same");
        return {};
      }
      return coefficient(a, own, s.contribution * s.spread * std::sqrt(own.stated->distribution.variance()),
                         s.contribution * u_of(own));
    }
    return {};
  }

  /// Another output of the same file that has this error in its budget, and does not name it; none: null.
  const Draw* silent_about(const Draw& a, const std::string& quantity) const {
    const auto silent = std::ranges::find_if(draws_, [&](const Draw& d) {
      return d.output && d.stated != a.stated && d.stated->earlier->file == a.stated->earlier->file &&
             !names(d, quantity) &&
             std::ranges::find(d.output->shares, quantity, &Share::quantity) != d.output->shares.end();
    });
    return silent == draws_.end() ? nullptr : &*silent;
  }

  /// Every name in `same` is in the budget, and in another result or in the scenario as well; and all outputs of one
  /// file that have the error name it.
  void check_same(const Draw& a) {
    std::set<std::string> known;
    for (const Share& s : a.output->shares) known.insert(s.quantity);
    for (const std::string& name : a.stated->earlier->same) {
      const bool elsewhere = std::ranges::any_of(draws_, [&](const Draw& d) {
        if (d.stated == a.stated) return false;
        return d.output ? names(d, name) : d.quantity == name;
      });
      if (!known.contains(name))
        context_.problems.add(
            place(a), fmt::format("{}: same: '{}' is not in the budget of {}", a.name, name, a.stated->earlier->output),
            "", did_you_mean(name, {known.begin(), known.end()}));
      else if (!elsewhere)
        context_.problems.add(place(a), fmt::format("{}: same: nothing else here has '{}'", a.name, name),
                              "an error is shared by two",
                              "name it in same of the other result too, or state it as a quantity");
      else if (const Draw* other = silent_about(a, name))
        context_.problems.add(
            place(*other),
            fmt::format("{} is of the same run as {}, and '{}' is in the budget of both", other->name, a.name, name),
            "one error cannot be shared by one of them alone",
            fmt::format("add same = [\"{}\"] to {}", name, other->name));
    }
  }

  const Node& place(const Draw& d) const {
    const Node* table = find_member(document_, "quantities");
    const Node* q = table ? find_member(*table, d.quantity) : nullptr;
    return q ? *q : document_;
  }

  std::vector<Draw> draws_;
  const Node& document_;
  Context& context_;
  std::vector<std::size_t> set_; ///< union-find: what is tied has one root
};

} // namespace

std::vector<quantities::Correlation> tie_results(const std::vector<quantities::InputQuantity>& quantities,
                                                 const Node& document, Context& context) {
  std::vector<Draw> draws = draws_of(quantities, context.earlier);
  if (std::ranges::none_of(draws, [](const Draw& d) { return d.output != nullptr; })) return {};
  return Ties(std::move(draws), document, context).find();
}

} // namespace gumshoe::scenario
