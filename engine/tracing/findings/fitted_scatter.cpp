#include "tracing/findings/fitted_scatter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tracing/criteria.h"
#include "tracing/noise/sparse_columns.h"

namespace gumshoe::tracing {
namespace {

/// A draw of unit variance for each group (and indication), as declared ones are.
void add_draws(Design& d, const Component& one, double ratio) {
  const std::size_t k = d.indications, groups = one.group->groups.size();
  const Index first = d.random.cols();
  d.random.conservativeResize(index(d.reading.size()), first + index(groups * k));
  d.random.rightCols(index(groups * k)).setZero();
  for (std::size_t row = 0; row < d.reading.size(); ++row)
    if (const std::size_t i = row % k; one.indication < 0 || i == index(one.indication))
      d.random(index(row), first + index(one.group->group[d.reading[row]] * k + i)) = ratio * d.reference[i];
  d.bent.resize(index(d.random.cols()), -1);
  d.random_names.resize(index(d.random.cols()));
}

class Likelihood {
public:
  Likelihood(const TraceContext& c, const JointFit& fit) : fit_(fit), rows_(c.fitter.rows()) {
    use_ = independent(fit.design, rows_);
    const Whitened plain(fit.design, rows_, use_, {});
    data_ = plain.winsorised(plain.take(fit.residual));
  }

  const JointFit& fit() const { return fit_; }

  struct At {
    double criterion = 0, variance = 1;
  };
  /// @param ratio  standard deviation of each component over that of a reading; 0: there is none
  At at(const std::vector<Component>& components, const std::vector<double>& ratio) const {
    Design design = fit_.design;
    CovarianceModel model{fit_.covariance_model.correlation, -1, 0, -1};
    for (std::size_t i = 0; i < components.size(); ++i) {
      if (!(ratio[i] > 0)) continue;
      if (model.scatter < 0 && components[i].index >= 0)
        model = {model.correlation, components[i].index, ratio[i], components[i].indication};
      else
        add_draws(design, components[i], ratio[i]);
    }
    const Whitened w(design, rows_, use_, model);
    const double left = w.squares(data_)[0], freedom = static_cast<double>(w.degrees_of_freedom());
    return {freedom * std::log(left) + w.log_determinant(), left / freedom};
  }

  /// Degrees of freedom of each component, and of the readings about them: what constants of its groups explain beyond
  /// the fit and the components before it. Nested groups follow those in which they lie.
  std::vector<double> freedoms(const std::vector<Component>& components) const {
    SparseColumns columns(fit_.design, rows_);
    for (const Index j : use_) columns.add(fit_.design.fixed.col(j));
    std::vector<std::size_t> ends{columns.count()};
    for (const Component& one : components) {
      std::vector<std::size_t> by_place;
      for (std::size_t i = 0; i < fit_.design.reading.size(); i += fit_.design.indications)
        by_place.push_back(one.group->group[fit_.design.reading[i]]);
      columns.add_constants(by_place);
      ends.push_back(columns.count());
    }
    const auto left_out = explained_by_earlier(columns.rows(), columns.count());
    std::vector<double> out;
    double known = static_cast<double>(use_.size());
    for (std::size_t i = 0; i < components.size(); ++i) {
      const auto skipped = std::ranges::count_if(
          left_out, [&](std::size_t column) { return column >= ends[i] && column < ends[i + 1]; });
      const double left = static_cast<double>(ends[i + 1] - ends[i]) - static_cast<double>(skipped);
      known += left;
      out.push_back(components[i].indication < 0 ? left : left / static_cast<double>(fit_.design.indications));
    }
    // Successive readings that resemble each other tell of their variance as so many independent ones do.
    const double square = std::pow(fit_.covariance_model.correlation, 2);
    out.push_back((static_cast<double>(rows_.size()) - known) * (1 - square) / (1 + square));
    return out;
  }

private:
  const JointFit& fit_;
  const std::vector<Index>& rows_;
  std::vector<Index> use_;
  Matrix data_;
};

/// Sizes of components that are most likely together, one after the other.
class Sizes {
public:
  explicit Sizes(const Likelihood& likelihood) : likelihood_(likelihood) {}

  std::vector<Component> components;
  std::vector<double> ratio; ///< to the noise of a reading

  Likelihood::At here() const { return likelihood_.at(components, ratio); }

  /// 2 ln L that a further component gains at the best of the ratios tried, all others as they are.
  std::pair<double, double> gain(const Component& one) const {
    std::vector<Component> with = components;
    std::vector<double> sizes = ratio;
    with.push_back(one);
    sizes.push_back(0);
    std::pair<double, double> out{0, 0};
    const double without = here().criterion;
    for (const double x : criteria.scatter_ratios) {
      if (!admitted(one, x)) continue;
      sizes.back() = x;
      if (const double g = without - likelihood_.at(with, sizes).criterion; g > out.first) out = {g, x};
    }
    return out;
  }

  /// 2 ln L that one of them adds to the others, these as large as is most likely without it.
  double adds(std::size_t i) const {
    Sizes others = *this;
    others.components.erase(others.components.begin() + static_cast<std::ptrdiff_t>(i));
    others.ratio.erase(others.ratio.begin() + static_cast<std::ptrdiff_t>(i));
    others.settle();
    return others.here().criterion - here().criterion;
  }

  void settle() {
    for (int sweep = 0; sweep < (components.size() > 1 ? criteria.most_scatter_sweeps : 1); ++sweep)
      for (std::size_t i = 0; i < components.size(); ++i) ratio[i] = best(i);
  }

private:
  /// The most likely ratio of one, by golden section in ln about the best of those tried.
  double best(std::size_t i) const {
    const auto at = [&](double step) {
      std::vector<double> sizes = ratio;
      sizes[i] = criteria.scatter_low * std::pow(criteria.scatter_span, step / criteria.scatter_steps);
      return likelihood_.at(components, sizes).criterion;
    };
    constexpr int coarse = 4;
    int middle = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= criteria.scatter_steps; step += coarse)
      if (const double x = at(step); x < least) least = x, middle = step;
    double low = std::max(0, middle - coarse), high = std::min(criteria.scatter_steps, middle + coarse);
    constexpr double golden = 0.6180339887498949, fine = 0.01;
    double left = high - golden * (high - low), right = low + golden * (high - low);
    for (double a = at(left), b = at(right); high - low > fine;)
      if (a < b) {
        high = right, right = left, b = a;
        a = at(left = high - golden * (high - low));
      } else {
        low = left, left = right, a = b;
        b = at(right = low + golden * (high - low));
      }
    return criteria.scatter_low * std::pow(criteria.scatter_span, (low + high) / 2 / criteria.scatter_steps);
  }

  /// What comes back with the conditions is no scatter: the fit leaves out such models.
  bool admitted(const Component& one, double tried) const {
    const auto& models = likelihood_.fit().design.covariance_models;
    return one.index < 0 || models.empty() || std::ranges::any_of(models, [&](const CovarianceModel& m) {
             return m.scatter == one.index && m.ratio == tried && m.indication == one.indication;
           });
  }

  const Likelihood& likelihood_;
};

/// Groups of one label that are fitted.
std::size_t fitted_groups(const TraceContext& c, const Grouping& label) {
  std::set<std::size_t> out;
  for (const Index row : c.fitter.rows())
    out.insert(label.group[c.observations.sequence[index(row) / c.observations.indications]]);
  return out.size();
}

/// Set-up steps that were repeated too seldom to be searched for scatter: new readings show it nevertheless.
std::vector<Component> seldom_repeated(const TraceContext& c) {
  std::vector<Component> out;
  const Observations& o = c.observations;
  for (const auto& labels : c.experiment.scenario().trace.redone.value_or(std::vector<std::vector<std::string>>{}))
    for (const Grouping& g : o.labels)
      if (g.labels == labels && g.groups.size() < criteria.stated_replicates &&
          fitted_groups(c, g) >= criteria.least_scatter_groups)
        out.push_back({.group = &g});
  return out;
}

/// What the fit uses without insisting on it, as noise of each reading: its variance, and degrees of freedom by Welch
/// and Satterthwaite's formula, of the means of groups and of readings about them.
void add_not_insisted(const Likelihood& likelihood, const JointFit& fit, const Component& one, FittedScatter& out) {
  Sizes alone(likelihood);
  alone.components = {one};
  alone.ratio = {fit.covariance_model.ratio};
  alone.settle();
  const double square = alone.ratio[0] * alone.ratio[0];
  const auto freedom = likelihood.freedoms(alone.components);
  const double share = (freedom[0] + 1) / (freedom[0] + 1 + freedom[1]), // of a reading in the mean of its group
      of_means = square + share, of_readings = 1 - share;
  out.variance = alone.here().variance * (1 + square);
  if (freedom[0] > 0 && freedom[1] > 0)
    out.freedom =
        (1 + square) * (1 + square) / (of_means * of_means / freedom[0] + of_readings * of_readings / freedom[1]);
}

} // namespace

FittedScatter fitted_scatter(const TraceContext& c, const JointFit& fit, const std::vector<SearchFinding>& findings) {
  std::vector<Component> possible = seldom_repeated(c);
  for (std::size_t g = 0; g < fit.design.scatter.size(); ++g) {
    const int number = static_cast<int>(g);
    const bool used = fit.covariance_model.scatter == number;
    possible.push_back({&c.observations.replicate_groups[g], number,
                        std::ranges::any_of(findings,
                                            [&](const SearchFinding& f) {
                                              return f.finding.kind == Kind::scatter && f.component == number;
                                            }),
                        used ? fit.covariance_model.indication : -1});
  }
  std::ranges::stable_sort(possible, {}, [](const Component& one) { return one.group->groups.size(); });

  const Likelihood likelihood(c, fit);
  Sizes sizes(likelihood);
  for (const Component& one : possible)
    if (one.found) sizes.components.push_back(one), sizes.ratio.push_back(1);
  sizes.settle();
  const auto taken = [&](const Component& one) {
    return std::ranges::any_of(sizes.components, [&](const Component& known) { return known.group == one.group; });
  };
  for (bool more = true; more;) {
    more = false;
    std::pair<double, double> best{criteria.decisive, 0};
    const Component* next = nullptr;
    for (const Component& one : possible)
      if (!taken(one))
        if (const auto gain = sizes.gain(one); gain.first >= best.first) best = gain, next = &one;
    if (!next) break;
    sizes.components.push_back(*next);
    sizes.ratio.push_back(best.second);
    sizes.settle();
    more = true;
  }
  // The one that was taken first may have stood for those that followed.
  for (std::size_t i = 0; i < sizes.components.size();)
    if (sizes.components.size() > 1 && !sizes.components[i].found && sizes.adds(i) < criteria.decisive) {
      sizes.components.erase(sizes.components.begin() + static_cast<std::ptrdiff_t>(i));
      sizes.ratio.erase(sizes.ratio.begin() + static_cast<std::ptrdiff_t>(i));
      sizes.settle();
      i = 0;
    } else {
      ++i;
    }

  FittedScatter out;
  out.variance = sizes.here().variance;
  for (std::size_t i = 0; i < sizes.components.size(); ++i) {
    out.components.push_back(sizes.components[i]);
    out.components.back().u = sizes.ratio[i] * std::sqrt(out.variance);
  }
  std::ranges::stable_sort(out.components, {}, [](const Component& one) { return one.group->groups.size(); });
  const auto freedom = likelihood.freedoms(out.components);
  for (std::size_t i = 0; i < out.components.size(); ++i)
    out.components[i].freedom = std::max(freedom[i], criteria.least_scatter_freedom);
  out.freedom = freedom.back();
  if (out.components.empty() && fit.covariance_model.scatter >= 0)
    add_not_insisted(likelihood, fit, *std::ranges::find(possible, fit.covariance_model.scatter, &Component::index),
                     out);
  out.freedom = std::max(out.freedom, criteria.least_scatter_freedom);
  return out;
}

JointFit given_others(JointFit fit, const FittedScatter& scatter, int component) {
  for (const Component& one : scatter.components)
    if (one.index != component) add_draws(fit.design, one, one.u / std::sqrt(scatter.variance));
  return fit;
}

} // namespace gumshoe::tracing
