#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "tracing/candidates/candidate_families.h"
#include "tracing/candidates/candidates.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

using Groups = std::vector<std::size_t>;

/// x less its mean in each group; with a covariate's values less its straight line there, which groups of neighbouring
/// values leave.
Vector within(const Vector& x, const Groups& group, const Vector* value = nullptr) {
  std::map<std::size_t, std::vector<Index>> members;
  for (std::size_t i = 0; i < group.size(); ++i) members[group[i]].push_back(index(i));
  Vector out = x;
  for (const auto& [number, rows] : members) {
    out(rows).array() -= x(rows).mean();
    if (!value) continue;
    const Vector v = (*value)(rows).array() - (*value)(rows).mean();
    if (const double square = v.squaredNorm(); square > 0) out(rows) -= v * (v.dot(out(rows)) / square);
  }
  return out;
}

/// Groups in which a covariate has several values.
std::size_t varied(const Groups& group, const Vector& value) {
  std::map<std::size_t, double> first;
  std::set<std::size_t> out;
  for (std::size_t i = 0; i < group.size(); ++i)
    if (value[index(i)] != first.insert({group[i], value[index(i)]}).first->second) out.insert(group[i]);
  return out.size();
}

/// Share of x's variance between groups of equal values, and by a straight line in each if readings suffice for that;
/// less what chance gives.
double explained(const Vector& x, const Groups& group, const Vector* value = nullptr) {
  const std::size_t groups = std::set(group.begin(), group.end()).size(), lines = value ? varied(group, *value) : 0;
  const bool enough = group.size() > groups + lines;
  const double total = (x.array() - x.mean()).square().sum(),
               left = within(x, group, enough ? value : nullptr).squaredNorm();
  const auto n = static_cast<double>(group.size()), k = static_cast<double>(groups + (enough ? lines : 0));
  return total > 0 && n > k ? 1 - left / total * (n - 1) / (n - k) : 0;
}

double correlation(const Vector& a, const Vector& b) {
  const Vector x = a.array() - a.mean(), y = b.array() - b.mean();
  const double lengths = x.norm() * y.norm();
  return lengths > 0 ? x.dot(y) / lengths : 0;
}

/// Numbers of the combinations of two groupings.
Groups crossed(const Groups& a, const Groups& b) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> number;
  Groups out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(number.insert({{a[i], b[i]}, number.size()}).first->second);
  return out;
}

/// The part of one column, or of its size, that no covariate named so far explains.
struct Part {
  Vector left;
  double whole;

  double share(const Groups& group, const Vector* value = nullptr) const {
    return explained(left, group, value) * variance(left) / whole;
  }
  static double variance(const Vector& x) { return (x.array() - x.mean()).square().sum(); }
};

std::vector<Part> parts_of(const Observations& o, const Matrix& columns) {
  const auto k = index(o.indications);
  std::vector<Part> out;
  for (Index j = 0; j < columns.cols(); ++j)
    for (Index i = 0; i < k; ++i) {
      const Vector x = columns(Eigen::seq(i, Eigen::last, k), j);
      if (!(x.norm() > 1e-9 * columns.norm())) continue;
      for (const Vector& one : {x, Vector(x.cwiseAbs())})
        if (const double whole = Part::variance(one); whole > 1e-18 * one.squaredNorm()) out.push_back({one, whole});
    }
  return out;
}

double largest_share(const std::vector<Part>& parts, const Groups& group, const Vector* value = nullptr) {
  double out = 0;
  for (const Part& part : parts) out = std::max(out, part.share(group, value));
  return out;
}

} // namespace

std::vector<std::string> dependence(const Observations& o, const Matrix& columns) {
  std::vector<Part> parts = parts_of(o, columns);
  const auto in_order = [&](const Groups& by_reading) {
    Groups out;
    for (const std::size_t r : o.sequence) out.push_back(by_reading[r]);
    return out;
  };
  std::vector<Groups> groups;
  std::vector<Vector> values;
  for (const Covariate& c : o.covariates) {
    groups.push_back(in_order(neighbours(c, criteria.dependence_bins)));
    values.emplace_back(index(o.readings));
    for (std::size_t i = 0; i < o.readings; ++i) values.back()[index(i)] = c.value[o.sequence[i]];
  }
  std::vector<bool> named(groups.size(), false);
  std::optional<Groups> cells;
  for (;;) {
    std::vector<double> share;
    for (std::size_t c = 0; c < groups.size(); ++c) share.push_back(named[c] ? 0 : largest_share(parts, groups[c]));
    const auto first = index(std::ranges::max_element(share) - share.begin());
    if (share.empty() || share[first] <= criteria.dependence_share) break;
    // Nearly proportional covariates, such as a temperature that rises with time: the one with the smallest residual
    // wins.
    std::size_t best = first;
    for (std::size_t c = 0; c < groups.size(); ++c)
      if (!named[c] && std::fabs(correlation(values[first], values[c])) > criteria.alike &&
          largest_share(parts, groups[c], &values[c]) > largest_share(parts, groups[best], &values[best]))
        best = c;
    named[best] = true;
    const Groups both = cells ? crossed(*cells, groups[best]) : groups[best];
    // Combinations that hardly repeat would explain anything: then one after the other.
    const bool repeats = (*std::ranges::max_element(both) + 1) * criteria.least_repeats <= both.size();
    if (repeats) cells = both;
    for (Part& part : parts) part.left = within(part.left, repeats ? both : groups[best], &values[best]);
  }
  std::vector<std::string> out;
  for (std::size_t c = 0; c < groups.size(); ++c)
    if (named[c]) out.push_back(o.covariates[c].name);
  for (const Grouping& g : o.labels)
    if (out.empty() && g.groups.size() <= criteria.most_label_groups &&
        largest_share(parts, in_order(g.group)) > criteria.dependence_share)
      out.push_back(g.name);
  return out;
}

namespace {

/// Whether a formula's value at a reading changes with one of its inputs.
/// @param known    conditions, then columns, as the reading has them
/// @param varied   place in these of the input
/// @param values   tried in its place
bool changes(const scenario::StatedPart& part, std::vector<double> known, std::size_t conditions, std::size_t varied,
             const std::array<double, 2>& values) {
  const auto value = [&] {
    const auto middle = known.begin() + index(conditions);
    return part.loading_at({known.begin(), middle}, {middle, known.end()});
  };
  const double here = value();
  return std::ranges::any_of(values, [&](double x) {
    known[varied] = x;
    return std::fabs(value() - here) > 1e-9 * std::fabs(here);
  });
}

} // namespace

std::vector<std::string> dependence(const Observations& o, const propagation::Experiment& experiment,
                                    const scenario::StatedEffect& effect) {
  const scenario::Scenario& s = experiment.scenario();
  std::vector<std::string> names, out; // of the formulas' inputs
  for (const VariableCard& c : experiment.model().card->conditions) names.emplace_back(c.name);
  const std::size_t conditions = names.size();
  for (const auto& column : s.trace.columns) names.push_back(column.name);
  if (!std::ranges::all_of(effect.parts, [](const auto& part) { return static_cast<bool>(part.loading_at); }))
    return {};
  for (const Covariate& c : o.covariates) {
    const auto varied = static_cast<std::size_t>(std::ranges::find(names, c.name) - names.begin());
    if (varied == names.size()) continue;
    bool found = false;
    for (const std::size_t r : {std::size_t{0}, o.readings / 2, o.readings - 1}) { // at one a factor may be zero
      std::vector<double> known = s.readings[r].conditions;
      for (const auto& column : s.trace.columns) known.push_back(column.values[r]);
      try {
        for (const auto& part : effect.parts)
          found = found || changes(part, known, conditions, varied, {c.levels.front(), c.levels.back()});
      } catch (const InputError&) { // beyond a table's levels
        return {};
      }
    }
    if (found) out.push_back(c.name);
  }
  return out;
}

std::vector<std::string> CandidateMaker::dependence_of(const Candidate& a) const {
  std::vector<std::string> out = dependence(observations, a.columns);
  if (a.family != Family::effect && a.family != Family::declared) return out;
  const auto conditions = experiment.model().card->conditions;
  // A course in time may go along with that of a condition, on which alone it can depend.
  const auto can = [&](const std::string& name) {
    const auto c = std::ranges::find(conditions, name, &VariableCard::name) - conditions.begin();
    return std::ranges::any_of(a.amplitudes, [&](const Amplitude& size) {
      return size.quantity == Amplitude::npos ||
             (index(c) < conditions.size() && moved.changes_with[size.quantity][index(c)]);
    });
  };
  const auto is_covariate = [&](const std::string& name) {
    return std::ranges::find(observations.covariates, name, &Covariate::name) != observations.covariates.end();
  };
  std::vector<std::string> possible;
  for (const std::string& name : out)
    if (!is_covariate(name) || can(name)) possible.push_back(name);
  if (!possible.empty() || out.empty()) return possible;
  for (const Covariate& c : observations.covariates)
    if (can(c.name)) possible.push_back(c.name);
  return possible.empty() ? out : possible;
}

} // namespace gumshoe::tracing
