#include "tracing/noise/by_label.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/QR>
#include <boost/math/distributions/chi_squared.hpp>

#include "math/variance_ratio.h"
#include "tracing/criteria.h"
#include "tracing/noise/student.h"

namespace gumshoe::tracing {
namespace {

/// What the readings of one group leave in one pass.
struct Stretch {
  std::size_t group, pass;
  Residuals residuals;
  double drift, drift_freedom; ///< squares that a constant and a straight line took
};

/// About what they drift: a constant, and from eight readings on a straight line in time. What the mean of equal
/// conditions takes of a reading, it takes by the reading's share of their weight.
/// @param ratio  by group: the noise by which they are weighted
std::vector<Stretch> stretches(const Observations& o, std::size_t indication, const Grouping& label,
                               const Replicates& replicates, const std::vector<Index>& rows, const Vector& about,
                               const std::vector<double>& ratio, bool drift) {
  std::map<std::size_t, double> weights, of_pass; // of a cell; of a block
  double of_all = 0;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> of; // places among the chosen rows
  const auto place = [&](std::size_t i) { return index(rows[i]) / o.indications; };
  const auto cell = [&](std::size_t i) { return replicates.cell[place(i)]; };
  const auto weight = [&](std::size_t i) { return std::pow(ratio[label.group[o.sequence[place(i)]]], -2); };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (index(rows[i]) % o.indications != indication) continue;
    weights[cell(i)] += weight(i), of_pass[replicates.pass[place(i)]] += weight(i), of_all += weight(i);
    of[{label.group[o.sequence[place(i)]], replicates.pass[place(i)]}].push_back(i);
  }
  std::vector<Stretch> out;
  for (const auto& [where, all] : of) {
    const auto n = index(all.size());
    const Index used = !drift ? 0 : n < 8 ? 1 : 2; // a drift within few readings counts as noise
    if (n < 2 * used) continue;
    Matrix columns(n, used);
    Vector left(n);
    for (Index i = 0; i < n; ++i) {
      left[i] = about[index(all[index(i)])];
      columns.row(i) = Eigen::RowVector2d(1, static_cast<double>(2 * i) / static_cast<double>(n) - 1).head(used);
    }
    const Matrix q = used == 0
                         ? Matrix(n, 0)
                         : Matrix(Eigen::HouseholderQR<Matrix>(columns).householderQ() * Matrix::Identity(n, used));
    const double all_squares = left.squaredNorm();
    left -= q * (q.transpose() * left);
    Stretch one{where.first, where.second, {}, all_squares - left.squaredNorm(), 0};
    for (Index i = 0; i < n; ++i) {
      const double own = weight(all[index(i)]), of_cell = own / weights.at(cell(all[index(i)]));
      one.drift_freedom += q.row(i).squaredNorm() * (1 - of_cell);
      // A block has a constant of its own, which a constant of every group in it holds.
      const double of_block =
          replicates.passes_are_blocks && used == 0 ? own / of_pass.at(where.second) - own / of_all : 0;
      const double share = 1 - q.row(i).squaredNorm() - of_cell - of_block;
      if (share < 0.1) continue; // hardly anything is left of one that is alone, or of two
      one.residuals.share.push_back(share);
      one.residuals.square.push_back(left[i] * left[i] / share);
    }
    out.push_back(std::move(one));
  }
  return out;
}

/// Whether groups drift within passes, by an F test in units of the noise of each.
bool drift(const std::vector<Stretch>& all, std::size_t count) {
  struct Squares {
    double drift = 0, drift_freedom = 0, left = 0, freedom = 0;
  };
  std::vector<Squares> each(count);
  for (const Stretch& one : all) {
    Squares& of = each[one.group];
    of.drift += one.drift, of.drift_freedom += one.drift_freedom;
    for (std::size_t i = 0; i < one.residuals.share.size(); ++i) {
      of.left += one.residuals.share[i] * one.residuals.square[i];
      of.freedom += one.residuals.share[i];
    }
  }
  double ratio = 0, above = 0, below = 0;
  for (const Squares& of : each) {
    if (of.freedom <= 4 || !(of.left > 0)) continue; // the mean of F, and its scatter, need four
    ratio += of.drift / of.left * (of.freedom - 2);
    above += of.drift_freedom, below += of.freedom;
  }
  return above > 0 && p_of_variance_ratio(ratio / above, above, below) < criteria.no_drift;
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

/// Merges neighbours, in the order of their noise, that the readings do not distinguish.
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

double wanted(double more) {
  return boost::math::quantile(boost::math::complement(boost::math::chi_squared(more), criteria.noise_differs));
}

/// By indication.
using All = std::vector<std::vector<Stretch>>;

/// Where the order of measurement is not known, nothing can drift.
All all_stretches(const Observations& o, const Grouping& label, const Replicates& replicates,
                  const std::vector<Index>& rows, const Vector& about, const std::vector<std::vector<double>>& ratio) {
  All out;
  for (std::size_t i = 0; i < o.indications; ++i) {
    const auto of = [&](bool drift) { return stretches(o, i, label, replicates, rows, about, ratio[i], drift); };
    if (o.order_known) out.push_back(of(true));
    if (!o.order_known || !drift(out.back(), label.groups.size())) out.resize(i), out.push_back(of(false));
  }
  return out;
}

struct Judged {
  std::vector<Groups> of; ///< by indication
  double gain = -1;       ///< 2 ln L over what is wanted
};

Judged judged(const All& all, std::size_t count, double share, std::size_t without = -1) {
  Judged out;
  double gain = 0, more = 0;
  for (const auto& one : all) {
    out.of.push_back(groups(one, count, without));
    if (out.of.back().told < 2) continue;
    gain += out.of.back().gain;
    more += static_cast<double>(out.of.back().told - 1);
  }
  if (more > 0) out.gain = gain - share * wanted(more);
  return out;
}

NoiseByLabel noise_of(const Grouping& label, const Judged& found, const Observations& o) {
  NoiseByLabel out{&label, {}, {}, Matrix(index(o.readings), index(o.indications))};
  double least = HUGE_VAL;
  for (const Groups& one : found.of)
    for (std::size_t g = 0; g < one.variance.size(); ++g)
      if (one.freedom[g] > 0) least = std::min(least, std::sqrt(one.variance[g]));
  for (std::size_t i = 0; i < found.of.size(); ++i) {
    const Groups& one = found.of[i];
    double sum = 0, freedom = 0;
    for (std::size_t g = 0; g < one.variance.size(); ++g)
      sum += one.freedom[g] * one.variance[g], freedom += one.freedom[g];
    const double all = freedom > 0 ? sum / freedom : least * least;
    out.ratio.emplace_back();
    for (std::size_t g = 0; g < one.variance.size(); ++g)
      out.ratio.back().push_back(std::sqrt(one.freedom[g] > 0 ? one.variance[g] : all) / least);
    out.freedom.push_back(one.freedom);
    for (std::size_t r = 0; r < o.readings; ++r)
      out.variance(index(r), index(i)) = std::pow(out.ratio.back()[label.group[r]], 2);
  }
  return out;
}

/// Whether the others still say so, by their share, without any one pass: a bad stretch decides for its own.
bool without_any(const All& all, std::size_t count) {
  std::set<std::size_t> passes;
  for (const auto& of_indication : all)
    for (const Stretch& one : of_indication) passes.insert(one.pass);
  const auto n = static_cast<double>(passes.size());
  return std::ranges::all_of(passes, [&](std::size_t pass) { return judged(all, count, (n - 1) / n, pass).gain > 0; });
}

double largest_ratio(const NoiseByLabel& one) {
  double out = 1;
  for (const auto& of : one.ratio) out = std::max(out, *std::ranges::max_element(of) / *std::ranges::min_element(of));
  return out;
}

/// Whether groups come in one pass each, on average: nobody knows the noise of the next.
bool are_passes(const Grouping& label, const Observations& o, const Replicates& replicates) {
  std::set<std::pair<std::size_t, std::size_t>> met;
  for (std::size_t i = 0; i < o.sequence.size(); ++i) met.insert({label.group[o.sequence[i]], replicates.pass[i]});
  return 2 * met.size() < 3 * label.groups.size();
}

} // namespace

std::vector<NoiseByLabel> noise_by_labels(const Observations& o, const Replicates& replicates,
                                          const std::vector<Index>& rows, const Vector& about) {
  std::vector<NoiseByLabel> out;
  for (const Grouping& label : o.labels) {
    if (label.group == o.blocks.group || are_passes(label, o, replicates)) continue;
    const std::size_t count = label.groups.size();
    const std::vector<std::vector<double>> equal(o.indications, std::vector<double>(count, 1));
    const All all = all_stretches(o, label, replicates, rows, about, equal);
    if (const Judged found = judged(all, count, 0.5); found.gain > 0) out.push_back(noise_of(label, found, o));
  }
  return out;
}

NoiseByLabel refined(const NoiseByLabel& so_far, const Observations& o, const Replicates& replicates,
                     const std::vector<Index>& rows, const Vector& about) {
  const Grouping& label = *so_far.label;
  Vector unweighted = about;
  for (std::size_t i = 0; i < rows.size(); ++i)
    unweighted[index(i)] *=
        so_far.ratio[index(rows[i]) % o.indications][label.group[o.sequence[index(rows[i]) / o.indications]]];
  const std::size_t count = label.groups.size();
  const All all = all_stretches(o, label, replicates, rows, unweighted, so_far.ratio);
  const Judged found = judged(all, count, 1);
  NoiseByLabel out = noise_of(label, found, o);
  out.gain = found.gain;
  out.plain = out.gain > 0 && largest_ratio(out) > criteria.unequal_spread &&
              (!o.order_known || without_any(all, count)); // rows that were sorted have no bad stretch
  return out;
}

} // namespace gumshoe::tracing
