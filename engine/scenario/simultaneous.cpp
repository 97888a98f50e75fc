#include "scenario/simultaneous.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gumshoe::scenario {
namespace {

std::vector<double> deviations(const std::vector<double>& x) {
  double mean = 0;
  for (const double v : x) mean += (v - x.front()) / static_cast<double>(x.size());
  std::vector<double> out;
  for (const double v : x) out.push_back(v - x.front() - mean);
  return out;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

bool observed(const NamedComponent& m) {
  return m.component && m.component->distribution.family == quantities::Family::t && m.component->distribution.values;
}

/// Whether there are sets of observations, and enough of them.
bool sets(Table& table, const std::vector<NamedComponent>& members) {
  const std::string key = "quantities";
  for (const NamedComponent& m : members) {
    if (observed(m)) continue;
    table.refuse_key(key, fmt::format("'{}' has no observations that scatter", m.name),
                     "the correlation of simultaneous observations is computed from them",
                     "give each quantity observations, or state kind = \"pearson\" with a matrix");
    return false;
  }
  const std::size_t n = members.front().component->distribution.values->size();
  for (const NamedComponent& m : members) {
    if (m.component->distribution.values->size() == n) continue;
    table.refuse_key(key, fmt::format("{} has {} observations, {} has {}", members.front().name, n, m.name,
                                      m.component->distribution.values->size()),
                     "simultaneous observations come in sets");
    return false;
  }
  if (n > members.size()) return true;
  table.refuse_key(key, fmt::format("{} simultaneous observations of {} quantities", n, members.size()),
                   "their joint distribution needs more observations than quantities (JCGM 102, 5.3.2)",
                   "add observations, or state kind = \"pearson\" with a matrix");
  return false;
}

} // namespace

std::vector<double> evaluate_together(Table& table, const std::vector<NamedComponent>& members) {
  if (members.empty() || !sets(table, members)) return {};
  const std::size_t count = members.size(), n = members.front().component->distribution.values->size();
  std::vector<std::vector<double>> d;
  for (const NamedComponent& m : members) d.push_back(deviations(*m.component->distribution.values));
  std::vector<double> matrix(count * count, 1);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      matrix[i * count + j] = matrix[j * count + i] =
          std::clamp(product(d[i], d[j]) / std::sqrt(product(d[i], d[i]) * product(d[j], d[j])), -1.0, 1.0);
  const auto observations = static_cast<double>(n), freedom = static_cast<double>(n - count);
  for (std::size_t i = 0; i < count; ++i) {
    auto& c = *members[i].component;
    const double squares = product(d[i], d[i]) / observations;
    c.distribution.parameters = {0, std::sqrt(squares / freedom), freedom, std::sqrt(squares / (observations - 1))};
    c.degrees_of_freedom = observations - 1;
    if (c.source.empty()) c.source = fmt::format("{} simultaneous observations of {} quantities", n, count);
  }
  return matrix;
}

} // namespace gumshoe::scenario
