/// Groups of readings that have a line, or a first wave, of their own: passes between which something was aligned anew.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/QR>
#include <boost/math/distributions/fisher_f.hpp>
#include <fmt/format.h>

#include "tracing/criteria.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {
namespace {

/// What each group has for itself, in addition to a mean.
struct Own {
  double share = 0;    ///< of the squares about the groups' means
  double p_value = 1;  ///< were the noise independent
  Matrix coefficients; ///< groups x columns, less what all have in common
};

/// Least squares of y on the columns, with a mean for each group; `apart`: coefficients for each group, too.
Matrix fitted(const Vector& y, const Matrix& x, const std::vector<std::size_t>& group, std::size_t groups, bool apart,
              double& squares) {
  const Index p = x.cols(), k = index(groups);
  Matrix a = Matrix::Zero(y.size(), k + (apart ? k * p : p));
  for (Index i = 0; i < y.size(); ++i) {
    const Index g = index(group[index(i)]);
    a(i, g) = 1;
    a.row(i).segment(k + (apart ? g * p : 0), p) = x.row(i);
  }
  const Vector b = a.colPivHouseholderQr().solve(y);
  squares = (y - a * b).squaredNorm();
  if (!apart) return {};
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(b.data() + k, k, p);
}

Own own_of(const Vector& y, const Matrix& x, const std::vector<std::size_t>& group, std::size_t groups) {
  Own out;
  const auto k = static_cast<double>(groups), p = static_cast<double>(x.cols()), n = static_cast<double>(y.size());
  const double more = (k - 1) * p, freedom = n - k * (1 + p);
  if (freedom < 4) return out;
  double common = 0, apart = 0;
  fitted(y, x, group, groups, false, common);
  out.coefficients = fitted(y, x, group, groups, true, apart);
  if (!(common > 0) || !(apart > 0)) return out;
  out.share = 1 - apart / common;
  const double f = (common - apart) / more / (apart / freedom);
  out.p_value = boost::math::cdf(boost::math::complement(boost::math::fisher_f(more, freedom), std::max(f, 0.0)));
  out.coefficients.rowwise() -= out.coefficients.colwise().mean();
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
  const auto& card = c.experiment.model().card->indications[0];
  std::vector<std::size_t> readings; // of the first indication
  std::vector<Index> rows;
  for (const Index row : c.fitter.rows())
    if (index(row) % o.indications == 0) {
      rows.push_back(row);
      readings.push_back(fit.design.reading[index(row)]);
    }
  const Vector y = fit.residual(rows);
  for (const Grouping& g : o.labels) {
    std::vector<std::size_t> group, known;
    for (const std::size_t r : readings) {
      const auto at = std::ranges::find(known, g.group[r]);
      group.push_back(static_cast<std::size_t>(at - known.begin()));
      if (at == known.end()) known.push_back(g.group[r]);
    }
    if (known.size() < criteria.groups_of_alignments) continue;
    for (const Covariate& v : o.covariates) {
      if (!v.commanded || v.course || v.levels.size() < criteria.levels_of_alignments) continue;
      bool turns = false;
      const Own own = own_of(y, columns_of(v, readings, turns), group, known.size());
      if (own.share < criteria.share_of_alignments || own.p_value > criteria.p_of_alignments) continue;
      const double sd = std::sqrt(own.coefficients.squaredNorm() /
                                  static_cast<double>((known.size() - 1) * index(own.coefficients.cols())));
      out.statements.push_back(fmt::format(
          "each {} has {} of its own against {} (standard deviation {} {}): where it was aligned anew, the model needs "
          "{} for each, such as gumshoe new --role COLUMN=alignment writes",
          g.name, turns ? "a first wave" : "a slope", v.name,
          shown_size(sd, std::string(card.unit), std::string(card.si_unit)),
          turns ? "in cosine and sine" : "at the ends", turns ? "an eccentricity" : "a slope"));
    }
  }
}

} // namespace gumshoe::tracing
