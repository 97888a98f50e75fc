#include "tracing/noise/by_label.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/QR>
#include <boost/math/distributions/chi_squared.hpp>

#include "tracing/criteria.h"
#include "tracing/noise/student.h"

namespace gumshoe::tracing {
namespace {

/// What the readings of one group leave in one pass.
struct Stretch {
  std::size_t group, pass;
  Residuals residuals;
};

/// About a constant, and from eight readings on a straight line in time. What the mean of equal conditions takes of a
/// reading, it takes by the reading's share of their weight.
/// @param ratio  by group: the noise by which they are weighted
std::vector<Stretch> stretches(const Observations& o, const Grouping& label, const Replicates& replicates,
                               const std::vector<Index>& rows, const Vector& about, const std::vector<double>& ratio) {
  std::map<std::size_t, double> weights;                                      // of a cell and indication
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> of; // places among the chosen rows
  const auto place = [&](std::size_t i) { return index(rows[i]) / o.indications; };
  const auto cell = [&](std::size_t i) {
    return replicates.cell[place(i)] * o.indications + index(rows[i]) % o.indications;
  };
  const auto weight = [&](std::size_t i) { return std::pow(ratio[label.group[o.sequence[place(i)]]], -2); };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    weights[cell(i)] += weight(i);
    of[{label.group[o.sequence[place(i)]], replicates.pass[place(i)]}].push_back(i);
  }
  std::vector<Stretch> out;
  for (const auto& [where, all] : of) {
    const auto n = index(all.size());
    const Index used = n < 8 ? 1 : 2; // a drift within few readings counts as noise
    if (n < 2 * used) continue;
    Matrix columns(n, used);
    Vector left(n);
    for (Index i = 0; i < n; ++i) {
      left[i] = about[index(all[index(i)])];
      columns.row(i) = Eigen::RowVector2d(1, static_cast<double>(2 * i) / static_cast<double>(n) - 1).head(used);
    }
    const Eigen::HouseholderQR<Matrix> qr(columns);
    const Matrix q = qr.householderQ() * Matrix::Identity(n, used);
    left -= q * (q.transpose() * left);
    Stretch one{where.first, where.second, {}};
    for (Index i = 0; i < n; ++i) {
      const double share = 1 - q.row(i).squaredNorm() - weight(all[index(i)]) / weights.at(cell(all[index(i)]));
      if (share < 0.1) continue; // hardly anything is left of one that is alone, or of two
      one.residuals.share.push_back(share);
      one.residuals.square.push_back(left[i] * left[i] / share);
    }
    out.push_back(std::move(one));
  }
  return out;
}

struct Groups {
  std::vector<double> variance, freedom; ///< by group; 0: not told
  double gain = 0;                       ///< 2 ln L of a noise of each over one noise of all
  std::size_t told = 0;
};

void add(Residuals& to, const Residuals& one) {
  to.share.insert(to.share.end(), one.share.begin(), one.share.end());
  to.square.insert(to.square.end(), one.square.begin(), one.square.end());
}

/// Groups of one noise.
struct Alike {
  std::vector<std::size_t> groups;
  Residuals residuals;
  ScaleFound scale;
};

/// Neighbours in noise that the readings do not tell apart have one.
void merge(std::vector<Alike>& all) {
  std::ranges::sort(all, {}, [](const Alike& one) { return one.scale.variance; });
  while (all.size() > 1) {
    Alike best;
    double least = criteria.noise_alike;
    std::size_t at = all.size();
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      Alike both = all[i];
      add(both.residuals, all[i + 1].residuals);
      both.scale = scale_of(both.residuals);
      const double lost = all[i].scale.likelihood + all[i + 1].scale.likelihood - both.scale.likelihood;
      if (lost < least) best = std::move(both), least = lost, at = i;
    }
    if (at == all.size()) return;
    best.groups.insert(best.groups.end(), all[at + 1].groups.begin(), all[at + 1].groups.end());
    all[at] = std::move(best);
    all.erase(all.begin() + index(at + 1));
  }
}

/// @param without  a pass; none by default
Groups groups(const std::vector<Stretch>& all, std::size_t count, std::size_t without = -1) {
  std::vector<Residuals> each(count);
  for (const Stretch& one : all)
    if (one.pass != without) add(each[one.group], one.residuals);
  const auto freedom_of = [](const Residuals& r) { return std::accumulate(r.share.begin(), r.share.end(), 0.0); };
  Groups out{std::vector<double>(count, 0), std::vector<double>(count, 0)};
  Residuals together;
  std::vector<Alike> told;
  for (std::size_t g = 0; g < count; ++g) {
    if (freedom_of(each[g]) < criteria.least_group_freedom) continue;
    const ScaleFound own = scale_of(each[g]);
    if (!(own.variance > 0)) continue;
    out.gain += own.likelihood;
    add(together, each[g]);
    told.push_back({{g}, each[g], own});
  }
  out.told = told.size();
  if (out.told > 1) out.gain -= scale_of(together).likelihood;
  merge(told);
  for (const Alike& one : told)
    for (const std::size_t g : one.groups)
      out.variance[g] = one.scale.variance, out.freedom[g] = freedom_of(one.residuals);
  return out;
}

double wanted(std::size_t told) {
  const auto freedom = static_cast<double>(told - 1);
  return boost::math::quantile(boost::math::complement(boost::math::chi_squared(freedom), criteria.noise_differs));
}

NoiseByLabel noise_of(const Grouping& label, const Groups& found, const Observations& o) {
  NoiseByLabel out{&label, {}, found.freedom, Vector(index(o.readings))};
  double least = HUGE_VAL, sum = 0, freedom = 0;
  for (std::size_t g = 0; g < found.variance.size(); ++g) {
    out.ratio.push_back(std::sqrt(found.variance[g]));
    if (!(found.freedom[g] > 0)) continue;
    least = std::min(least, out.ratio[g]);
    sum += found.freedom[g] * out.ratio[g] * out.ratio[g];
    freedom += found.freedom[g];
  }
  for (std::size_t g = 0; g < found.variance.size(); ++g)
    out.ratio[g] = found.freedom[g] > 0 ? out.ratio[g] / least : std::sqrt(sum / freedom) / least;
  for (std::size_t r = 0; r < o.readings; ++r) out.variance[index(r)] = std::pow(out.ratio[label.group[r]], 2);
  return out;
}

/// Whether the others still say so, by their share, without any one pass: a bad stretch decides for its own.
bool without_any(const std::vector<Stretch>& all, std::size_t count) {
  std::set<std::size_t> passes;
  for (const Stretch& one : all) passes.insert(one.pass);
  const auto n = static_cast<double>(passes.size());
  return std::ranges::all_of(passes, [&](std::size_t pass) {
    const Groups others = groups(all, count, pass);
    return others.told > 1 && others.gain > wanted(others.told) * (n - 1) / n;
  });
}

} // namespace

std::vector<NoiseByLabel> noise_by_labels(const Observations& o, const Replicates& replicates,
                                          const std::vector<Index>& rows, const Vector& about) {
  std::vector<NoiseByLabel> out;
  for (const Grouping& label : o.labels) {
    if (label.group == o.blocks.group) continue;
    if (std::ranges::any_of(o.replicate_groups, [&](const Grouping& g) { return g.labels == label.labels; })) continue;
    const std::size_t count = label.groups.size();
    const Groups found = groups(stretches(o, label, replicates, rows, about, std::vector<double>(count, 1)), count);
    if (found.told < 2 || found.gain < 0.5 * wanted(found.told)) continue;
    out.push_back(noise_of(label, found, o));
  }
  return out;
}

NoiseByLabel refined(const NoiseByLabel& so_far, const Observations& o, const Replicates& replicates,
                     const std::vector<Index>& rows, const Vector& about) {
  Vector unweighted = about;
  for (std::size_t i = 0; i < rows.size(); ++i)
    unweighted[index(i)] *= so_far.ratio[so_far.label->group[o.sequence[index(rows[i]) / o.indications]]];
  const auto all = stretches(o, *so_far.label, replicates, rows, unweighted, so_far.ratio);
  const std::size_t count = so_far.ratio.size();
  const Groups found = groups(all, count);
  NoiseByLabel out = noise_of(*so_far.label, found, o);
  out.gain = found.gain - wanted(found.told);
  out.plain = out.gain > 0 && *std::ranges::max_element(out.ratio) > criteria.unequal_spread && without_any(all, count);
  return out;
}

} // namespace gumshoe::tracing
