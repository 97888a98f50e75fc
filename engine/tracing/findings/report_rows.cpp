#include "tracing/findings/report_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "propagation/experiment.h"

namespace gumshoe::tracing {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t noise_draws = 199;

struct Blocks {
  std::vector<std::vector<Index>> rows; ///< held out in turn
  std::vector<std::string> names;
};

Blocks final_blocks(const Observations& o) {
  Blocks out;
  std::set<std::size_t> groups;
  for (std::size_t r = 0; r < o.readings; ++r)
    if (o.final[r]) groups.insert(o.blocks.group[r]);
  for (const std::size_t g : groups) {
    std::vector<bool> chosen;
    for (std::size_t r = 0; r < o.readings; ++r) chosen.push_back(o.final[r] && o.blocks.group[r] == g);
    out.rows.push_back(rows_where(o, chosen));
    out.names.push_back(o.blocks.groups[g]);
  }
  return out;
}

/// Every block left out in turn, where there are too few to keep some apart.
Blocks all_blocks(const Observations& o) {
  Blocks out;
  for (std::size_t g = 0; g < o.blocks.groups.size(); ++g) {
    std::vector<bool> chosen;
    for (std::size_t r = 0; r < o.readings; ++r) chosen.push_back(o.blocks.group[r] == g);
    out.rows.push_back(rows_where(o, chosen));
    out.names.push_back(o.blocks.groups[g]);
  }
  return out;
}

struct Scored {
  double rms = nan, worst_block = nan;
  std::string worst_name;
  std::vector<double> worst_point; ///< by block
  Matrix residual;                 ///< all rows; NaN where not scored
};

/// Root mean squares by set of residual columns.
struct Scores {
  std::vector<double> all;
  double whitened = 0; ///< squares of the first column in units of all that is declared
  Scored first;        ///< of the first column
};

Scores score(const JointFit& fit, const Matrix& residual, const std::vector<Index>& training, const Blocks& blocks,
             double reference) {
  Scores out;
  Vector squares = Vector::Zero(residual.cols());
  double count = 0;
  out.first.residual = Matrix::Constant(residual.rows(), 1, nan);
  for (std::size_t b = 0; b < blocks.rows.size(); ++b) {
    std::vector<Index> train;
    std::set_difference(training.begin(), training.end(), blocks.rows[b].begin(), blocks.rows[b].end(),
                        std::back_inserter(train));
    const HeldOut held =
        hold_out(fit.design, residual, Matrix(residual.rows(), 0), train, blocks.rows[b], fit.structure);
    if (held.count <= 0) continue;
    squares += held.squares;
    out.whitened += held.whitened[0];
    count += held.count;
    const double rms = reference * std::sqrt(held.squares[0] / held.count);
    if (!(rms <= out.first.worst_block)) out.first.worst_block = rms, out.first.worst_name = blocks.names[b];
    for (std::size_t i = 0; i < held.rows.size(); ++i)
      out.first.residual(held.rows[i], 0) = held.residual(static_cast<Index>(i), 0);
  }
  for (Index j = 0; j < residual.cols(); ++j)
    out.all.push_back(count > 0 ? reference * std::sqrt(squares[j] / count) : nan);
  out.first.rms = out.all[0];
  return out;
}

/// Residuals of the fit's own readings about the fitted unknowns, declared quantities as declared: root mean squares.
Vector in_sample(const JointFit& fit, const std::vector<Index>& rows, const Matrix& residual, Matrix* left) {
  const auto use = independent(fit.design, rows);
  const Whitened w(fit.design, rows, use, fit.structure);
  const Matrix x = w.solve_all(Matrix(static_cast<Index>(rows.size()), 0), w.whiten(w.take(residual)));
  Matrix rest = w.take(residual);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < use.size(); ++j)
      rest.row(static_cast<Index>(i)) -= fit.design.fixed(rows[i], use[j]) * x.row(static_cast<Index>(j));
  if (left) *left = rest;
  Design plain = fit.design;
  plain.random.resize(plain.random.rows(), 0);
  const Matrix white = Whitened(plain, rows, {}, Structure{}).whiten(rest);
  return (white.colwise().squaredNorm() / static_cast<double>(rows.size() - use.size())).cwiseSqrt().transpose();
}

double quantile(std::vector<double> x, double p) {
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, static_cast<std::size_t>(p * static_cast<double>(x.size())))];
}
double root_mean_square(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

} // namespace

bool compare(const Circumstances& c, const Search& s, Trace& out) {
  const Observations& o = c.observations;
  const auto& rows = c.fitter.rows();
  const JointFit& after = s.found;
  // Both in the units of one noise: the fit without the effect takes it for noise.
  JointFit before = s.base;
  before.design.local = after.design.local;
  before.design.reference = after.design.reference;
  before.structure = after.structure;
  const double ref_before = before.design.reference[0], ref_after = after.design.reference[0];
  const auto& card = c.experiment.model().card->indications[0];
  Rms& rms = out.rms;
  rms.unit = card.unit;
  rms.si_unit = card.si_unit;
  Matrix left_before, left_after;
  rms.before = ref_before * in_sample(before, rows, before.residual, &left_before)[0];
  rms.after = ref_after * in_sample(after, rows, after.residual, &left_after)[0];
  // What noise alone gives, by the model with all that was found.
  std::vector<Index> every;
  for (Index i = 0; i < after.residual.size(); ++i) every.push_back(i);
  const Whitened w(after.design, every, {}, after.structure);
  const Matrix drawn = std::sqrt(after.variance) * w.draw(noise_draws, c.seed ^ 0xf100full);
  const Vector noise = ref_after * in_sample(after, rows, drawn, nullptr);
  std::vector<double> sizes(noise.data(), noise.data() + noise.size());
  rms.noise = root_mean_square(sizes);
  rms.noise_low = quantile(sizes, 0.025);
  rms.noise_high = quantile(sizes, 0.975);

  rms.holdout_before = rms.holdout_after = rms.holdout_noise = rms.holdout_noise_low = rms.holdout_noise_high = nan;
  rms.worst_block_before = rms.worst_block_after = rms.worst_point_before = rms.worst_point_after = rms.share_removed =
      nan;
  Blocks blocks = final_blocks(o);
  if (!blocks.rows.empty()) {
    rms.holdout = fmt::format("{}", fmt::join(blocks.names, ", "));
  } else if (o.blocks.groups.size() > 1) {
    blocks = all_blocks(o);
    rms.holdout = "each block left out in turn, of data that the search has seen";
  } else {
    rms.holdout = "none";
  }
  Scores b, a;
  bool vetoed = false;
  if (!blocks.rows.empty()) {
    b = score(before, before.residual, rows, blocks, ref_before);
    a = score(after, after.residual, rows, blocks, ref_after);
    const Scores n = score(after, drawn, rows, blocks, ref_after);
    rms.holdout_before = b.first.rms;
    rms.holdout_after = a.first.rms;
    if (std::isfinite(b.first.rms)) {
      rms.holdout_noise = root_mean_square(n.all);
      rms.holdout_noise_low = quantile(n.all, 0.025);
      rms.holdout_noise_high = quantile(n.all, 0.975);
    } else {
      rms.holdout += ": no more readings than constants of their own, not scored";
    }
    // What the final blocks do not feel they can neither confirm nor refuse.
    const bool felt = std::any_of(after.terms.begin(), after.terms.end(), [&](const Term& t) {
      return std::any_of(blocks.rows.begin(), blocks.rows.end(), [&](const std::vector<Index>& b) {
        return t.alternative.columns(b, Eigen::all).norm() > 1e-9 * t.alternative.columns.norm();
      });
    });
    const bool opened = !o.final_blocks.empty() && std::isfinite(b.first.rms) && !after.terms.empty();
    if (opened && !felt)
      out.statements.push_back("the final blocks do not feel what was found: they neither confirm nor refuse it");
    vetoed = opened && felt && (a.whitened >= b.whitened || a.first.rms > 1.05 * b.first.rms);
    if (vetoed) {
      a = b;
      rms.holdout_after = rms.holdout_before;
      rms.after = rms.before;
    }
    rms.worst_block_before = b.first.worst_block;
    rms.worst_block_after = a.first.worst_block;
    rms.worst_block = a.first.worst_name;
    const double removable = rms.holdout_before * rms.holdout_before - rms.holdout_noise * rms.holdout_noise;
    rms.share_removed =
        removable > 0 ? (rms.holdout_before * rms.holdout_before - rms.holdout_after * rms.holdout_after) / removable
                      : nan;
    for (Index i = 0; i < b.first.residual.rows(); ++i) {
      const double x = std::fabs(b.first.residual(i, 0)), y = std::fabs(a.first.residual(i, 0));
      if (x > rms.worst_point_before || (std::isfinite(x) && std::isnan(rms.worst_point_before)))
        rms.worst_point_before = x;
      if (y > rms.worst_point_after || (std::isfinite(y) && std::isnan(rms.worst_point_after))) {
        rms.worst_point_after = y;
        const std::size_t r = after.design.reading[static_cast<std::size_t>(i)];
        const std::string name = propagation::reading_name(c.experiment.scenario().readings[r]);
        rms.worst_point = fmt::format("reading {}{}", r + 1, name.empty() ? "" : " (" + name + ")");
      }
    }
  }
  // Rows: training residuals in sample, final ones as predicted.
  Matrix weight;
  const Whitened plain(after.design, rows, independent(after.design, rows), {});
  plain.winsorised(plain.take(vetoed ? before.residual : after.residual), nullptr, &weight);
  std::vector<Row> by_row(static_cast<std::size_t>(after.residual.size()));
  for (std::size_t i = 0; i < by_row.size(); ++i) {
    Row& row = by_row[i];
    row.reading = after.design.reading[i];
    row.indication = i % o.indications;
    row.order = o.order[row.reading];
    if (!o.blocks.groups.empty()) row.block = o.blocks.groups[o.blocks.group[row.reading]];
    row.final = o.final[row.reading];
    row.measured = o.measured[row.reading * o.indications + row.indication];
    row.before = row.after = nan;
    if (row.final && !blocks.rows.empty()) {
      row.before = b.first.residual(static_cast<Index>(i), 0);
      row.after = a.first.residual(static_cast<Index>(i), 0);
    }
    row.noise_u = after.design.local[i / o.indications].row(static_cast<Index>(row.indication)).norm();
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row& row = by_row[static_cast<std::size_t>(rows[i])];
    row.before = left_before(static_cast<Index>(i), 0);
    row.after = vetoed ? row.before : left_after(static_cast<Index>(i), 0);
    row.weight = weight(static_cast<Index>(i), 0);
    if (row.weight < 1) ++out.noise.outliers;
  }
  out.rows = std::move(by_row);
  return vetoed;
}

} // namespace gumshoe::tracing
