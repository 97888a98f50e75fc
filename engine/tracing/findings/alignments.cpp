/// Groups of readings that have a line, or a first wave, of their own: passes between which something was aligned anew.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/QR>
#include <fmt/format.h>

#include "math/variance_ratio.h"
#include "tracing/criteria.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {
namespace {

/// What each group has for itself, in addition to a mean.
struct Own {
  double share = 0;   ///< of the squares about the groups' means and what all have in common
  double p_value = 1; ///< were the noise independent
  double size = 0;    ///< root mean square in the readings
};

/// Squares of y that a least-squares fit of the columns leaves; `rank` of the columns.
double left_over(const Matrix& a, const Vector& y, Index& rank, Vector* coefficients = nullptr) {
  const Eigen::CompleteOrthogonalDecomposition<Matrix> qr(a);
  rank = qr.rank();
  const Vector b = qr.solve(y);
  if (coefficients) *coefficients = b;
  return (y - a * b).squaredNorm();
}

/// Less its mean in each cell.
void leave_cells(Matrix& m, const std::vector<std::size_t>& cell, std::size_t cells) {
  Matrix mean = Matrix::Zero(index(cells), m.cols());
  Vector count = Vector::Zero(index(cells));
  for (Index i = 0; i < m.rows(); ++i) mean.row(index(cell[index(i)])) += m.row(i), ++count[index(cell[index(i)])];
  for (Index i = 0; i < m.rows(); ++i) m.row(i) -= mean.row(index(cell[index(i)])) / count[index(cell[index(i)])];
}

/// Means of the groups, columns that all have in common, and columns of each group.
/// @param cell  readings of equal conditions, whose means count for nothing; empty: all count
Own own_of(Matrix y, const Matrix& x, const std::vector<std::size_t>& group, std::size_t groups,
           const std::vector<std::size_t>& cell) {
  Own out;
  const Index p = x.cols(), k = index(groups), n = y.rows();
  Matrix a = Matrix::Zero(n, k + p + k * p);
  for (Index i = 0; i < n; ++i) {
    const Index g = index(group[index(i)]);
    a(i, g) = 1;
    a.row(i).segment(k, p) = x.row(i);
    a.row(i).segment(k + p + g * p, p) = x.row(i);
  }
  const std::size_t cells = cell.empty() ? 0 : *std::ranges::max_element(cell) + 1;
  if (cells > 0) leave_cells(y, cell, cells), leave_cells(a, cell, cells);
  Index fewer = 0, more = 0;
  Vector b;
  const double common = left_over(a.leftCols(k + p), y, fewer), apart = left_over(a, y, more, &b);
  const double freedom = static_cast<double>(n - index(cells) - more);
  if (freedom < 4 || more <= fewer || !(common > 0) || !(apart > 0)) return out;
  out.share = 1 - apart / common;
  const auto gained = static_cast<double>(more - fewer);
  const double f = (common - apart) / gained / (apart / freedom);
  out.p_value = p_of_variance_ratio(f, gained, freedom);
  // The part that is the groups' own, over the freedom that it takes of what does not repeat.
  out.size = std::sqrt((common - apart) / (static_cast<double>(n - index(cells) - fewer)));
  return out;
}

/// Positions in units of half their range about the middle; of a full turn, cosine and sine.
Matrix columns_of(const Covariate& c, const std::vector<std::size_t>& readings, bool& turns) {
  const double low = c.levels.front(), half = (c.levels.back() - low) / 2;
  turns = c.angle && half > 0.9 * std::numbers::pi;
  Matrix out(index(readings.size()), turns ? 2 : 1);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double v = c.value[readings[i]];
    if (turns)
      out.row(index(i)) << std::cos(v), std::sin(v);
    else
      out(index(i), 0) = (v - low) / half - 1;
  }
  return out;
}

} // namespace

void describe_alignments(const TraceContext& c, const Search& s, Trace& out) {
  const JointFit& fit = out.vetoed ? s.base : s.found;
  const Observations& o = c.observations;
  std::vector<std::size_t> readings; // of the first indication
  std::vector<Index> rows;
  for (const Index row : c.fitter.rows())
    if (index(row) % o.indications == 0) {
      rows.push_back(row);
      readings.push_back(fit.design.reading[index(row)]);
    }
  // What is left after everything found; and what does not repeat of that before, of which a drift or a step may have
  // taken some.
  const Vector left = fit.residual(rows), before = s.base.residual(rows);
  const bool predicted = !(out.rms.holdout_after > out.rms.holdout_noise_high);
  const Replicates& replicates = c.fitter.replicates();
  std::map<std::size_t, std::size_t> numbers;
  std::vector<std::size_t> cell;
  for (const Index row : rows)
    cell.push_back(numbers.try_emplace(replicates.cell[index(row) / o.indications], numbers.size()).first->second);
  for (const Grouping& g : o.labels) {
    std::vector<std::size_t> group, known;
    for (const std::size_t r : readings) {
      const auto at = std::ranges::find(known, g.group[r]);
      group.push_back(static_cast<std::size_t>(at - known.begin()));
      if (at == known.end()) known.push_back(g.group[r]);
    }
    if (g.name == "block" || known.size() < criteria.groups_of_alignments) continue; // a stretch is no act of anybody
    // Its draws are part of the noise by which held-out readings are judged then, whatever their slopes.
    const bool scatters = std::ranges::any_of(s.findings, [&](const SearchFinding& f) {
      return f.component >= 0 && o.replicate_groups[index(f.component)].group == g.group;
    });
    for (const Covariate& v : o.covariates) {
      if (!v.commanded || v.course || v.levels.size() < criteria.levels_of_alignments) continue;
      bool turns = false;
      const Matrix x = columns_of(v, readings, turns);
      Own own = own_of(left, x, group, known.size(), {});
      if (own.p_value > criteria.p_of_alignments && predicted && !scatters) continue;
      if (own.share < criteria.share_of_alignments) own = own_of(before, x, group, known.size(), cell);
      if (own.share < criteria.share_of_alignments || own.p_value > criteria.p_of_alignments) continue;
      out.statements.push_back(fmt::format(
          "each {} has {} of its own against {} ({}, root mean square): where it was aligned anew, the model needs {} "
          "for each, such as gumshoe new --role COLUMN=alignment writes",
          g.name, turns ? "a first wave" : "a slope", v.name, shown_rms(own.size, out.rms),
          turns ? "an eccentricity" : "a slope"));
    }
  }
}

} // namespace gumshoe::tracing
