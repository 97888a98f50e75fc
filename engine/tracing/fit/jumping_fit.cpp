/// Fits of a model that jumps, as a turning mill's readings do from tooth to tooth: its likelihood along one size.
#include <algorithm>
#include <cmath>

#include "quantities/cells.h"
#include "tracing/criteria.h"
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {
namespace {

/// How readings follow a size: like a line; in jumps about a line; in jumps as large as what the size moves.
enum class Following { smooth, jumps, rough };

Following following(const Matrix& f, const std::vector<double>& steps, double noise) {
  const Eigen::Map<const Vector> x(steps.data(), f.cols());
  const Vector sizes = x.array() - x.mean();
  const Matrix moved = f.colwise() - f.rowwise().mean(), line = moved * sizes / sizes.squaredNorm() * sizes.transpose();
  const double bend = (moved - line).norm();
  if (!(bend > criteria.least_jump * noise * std::sqrt(static_cast<double>(f.size())))) return Following::smooth;
  return bend < criteria.most_jump * line.norm() ? Following::jumps : Following::rough;
}

} // namespace

/// The likelihood along one size, all else fitted. `left` is empty if jumps are as large as what the size moves.
struct Fitter::Profile {
  std::vector<double> steps; ///< from the size found, SI
  Index here = 0;            ///< the step of none
  Vector left;               ///< squares, by step
  double freedom = 0;
  double u = 0;  ///< by the straight line through the readings over the steps
  Matrix others; ///< changes of the other columns that go with each step
  std::vector<Index> columns;

  /// Standard deviation of the likelihood over the steps.
  double spread() const {
    const Eigen::Map<const Vector> x(steps.data(), left.size());
    const Vector weight = (-0.5 * freedom * (left.array() / left.minCoeff()).log()).exp();
    const double mean = weight.dot(x) / weight.sum();
    return std::sqrt(weight.dot((x.array() - mean).square().matrix()) / weight.sum());
  }
};

Fitter::Size Fitter::size_of(const JointFit& fit, std::size_t term, Index amplitude) const {
  const Term& t = fit.terms[term];
  const Amplitude& a = t.candidate.amplitudes[index(amplitude)];
  Size out{first_column(fit, term) + amplitude, a.quantity, {}, t.size[amplitude], a.low, a.high};
  for (const auto& reading : experiment_.scenario().readings)
    out.holds.push_back(quantities::holds_for(a.labels, reading.labels));
  return out;
}

Fitter::Size Fitter::size_of(const JointFit& fit, std::size_t unknown) const {
  const FreeUnknown& u = unknowns_[unknown];
  const auto first = std::ranges::find(u.holds, true) - u.holds.begin();
  return {index(unknown), u.quantity, u.holds, fit.at[static_cast<std::size_t>(first)][u.quantity]};
}

std::optional<Fitter::Profile> Fitter::profile(const JointFit& fit, const Size& size, double unit, Worth worth) const {
  // The tool itself is solved anew for every size: there no more than Gauss-Newton.
  if (!experiment_.layout().effects.contains(size.quantity) || !(unit > 0)) return std::nullopt;
  Profile out;
  Matrix f;
  const auto try_each = [&](double by) {
    std::vector<Variation> variations;
    out.steps.clear();
    for (double step = -criteria.profile_reach; step <= criteria.profile_reach; step += by)
      if (const double to = size.at + step * unit; to >= size.low && to <= size.high) {
        out.steps.push_back(step * unit);
        variations.push_back({{{size.quantity, step * unit, false}}});
      }
    std::vector<bool> valid;
    simulator_.vary(fit.at, variations, f, valid);
    // An effect of one part moves none of the other readings.
    for (std::size_t r = 0; r < observations_.readings; ++r)
      if (!size.holds[r])
        f.middleRows(index(r * observations_.indications), index(observations_.indications)).setZero();
    return out.steps.size() > 3 && std::ranges::find(valid, false) == valid.end();
  };
  const auto line_through = [&] {
    const Eigen::Map<const Vector> x(out.steps.data(), f.cols());
    const Vector centred = x.array() - x.mean();
    return in_sequence(observations_, f * centred / centred.squaredNorm());
  };
  const Index own = size.column;
  if (!try_each(criteria.profile_coarse)) return std::nullopt;
  const Matrix line = line_through();
  const bool tangent_serves = (line - fit.design.fixed.col(own)).norm() < criteria.tangent_serves * line.norm();
  const Following how = following(f, out.steps, fit.design.reference[0]);
  if (tangent_serves && (worth == Worth::tangent_wrong || how == Following::smooth)) return std::nullopt;
  if (worth == Worth::jumps && how == Following::rough) return out;
  if (!try_each(criteria.profile_spacing)) return std::nullopt;
  const auto found = std::ranges::find(out.steps, 0.0);
  if (found == out.steps.end()) return std::nullopt;
  out.here = found - out.steps.begin();
  // Given all other unknowns.
  Design rest = fit.design;
  std::vector<Index> others;
  for (Index j = 0; j < rest.fixed.cols(); ++j)
    if (j != own) others.push_back(j);
  rest.fixed = Matrix(fit.design.fixed(Eigen::all, others));
  const auto use = independent(rest, rows_);
  const Whitened plain(rest, rows_, use, {}), prior(rest, rows_, use, fit.covariance_model);
  const Matrix residual = in_sequence(observations_, (-f).colwise() + f.col(out.here).eval()).colwise() + fit.residual;
  const Matrix clean = plain.winsorised(plain.take(residual));
  out.left = prior.squares(clean);
  out.u = std::sqrt(fit.variance / prior.squares(prior.take(line_through()))[0]);
  out.freedom = static_cast<double>(prior.degrees_of_freedom());
  for (const Index j : use) out.columns.push_back(others[index(j)]);
  out.others = prior.coefficients(clean).topRows(index(out.columns.size()));
  return out;
}

bool Fitter::explore(JointFit& fit) const {
  if (fit.terms.empty()) return false;
  // The others were tried when they came.
  const std::size_t term = fit.terms.size() - 1;
  if (!fit.terms[term].candidate.start.empty()) return false;
  for (Index i = 0; i < fit.terms[term].size.size(); ++i) {
    if (fit.terms[term].candidate.amplitudes[index(i)].is_shape) continue;
    const Index own = first_column(fit, term) + i;
    std::optional<Profile> p;
    Index best = 0;
    double unit = std::sqrt(fit.covariance(own, own));
    for (int tries = 0; tries < criteria.most_reaches; ++tries) {
      auto other = profile(fit, size_of(fit, term, i), unit, Worth::jumps);
      if (!other) break;
      if (other->left.size() > 0) {
        p = std::move(other);
        p->left.minCoeff(&best);
        const bool at_end = best == 0 || best == p->left.size() - 1;
        if (best != p->here && !at_end) break;
        const double u = p->u * std::sqrt(p->left[best] / p->left[p->here]);
        if (best == p->here && unit < 2 * u) break;
        if (best == p->here) unit /= 8; // too coarse to see the likelihood's peak
      }
      unit *= 2; // rough, or the likelihood rises to the end
    }
    if (!p || !(p->left[best] < p->left[p->here] * (1 - 1e-6))) continue;
    Vector change = Vector::Zero(fit.design.fixed.cols());
    for (std::size_t j = 0; j < p->columns.size(); ++j) change[p->columns[j]] = p->others(index(j), best);
    change[own] = p->steps[index(best)];
    JointFit next = fit;
    apply(next, change, 1);
    if (!linearise(next)) continue;
    fit = std::move(next);
    return true;
  }
  return false;
}

double Fitter::widened(const JointFit& fit, const Size& size, double u) const {
  // A pattern of jumps that fits pins the size, were all else of the model exact: the line does not rely on that.
  double unit = u, out = 0;
  for (int tries = 0; tries < criteria.most_reaches; ++tries) {
    const auto p = profile(fit, size, unit, Worth::tangent_wrong);
    if (!p) break;
    out = std::max(p->u, p->spread());
    if (p->u > 2 * unit || p->u < 0.5 * unit)
      unit = p->u; // the tangent's was of another size
    else if (p->spread() > 0.4 * criteria.profile_reach * unit)
      unit *= 2; // the likelihood reaches beyond
    else
      break;
  }
  return out;
}

void Fitter::widen_jumping(JointFit& fit) const {
  widen_across_jumps(fit);
  std::vector<Size> sizes;
  for (std::size_t u = 0; u < unknowns_.size(); ++u)
    if (unknowns_[u].is_size && unknowns_[u].jump == 0) sizes.push_back(size_of(fit, u));
  for (std::size_t term = 0; term < fit.terms.size(); ++term)
    for (Index i = 0; fit.terms[term].candidate.start.empty() && i < fit.terms[term].size.size(); ++i)
      if (!fit.terms[term].candidate.amplitudes[index(i)].is_shape) sizes.push_back(size_of(fit, term, i));
  for (const Size& size : sizes) {
    const double u = std::sqrt(fit.covariance(size.column, size.column)), wide = widened(fit, size, u);
    if (!(wide > 0)) continue;
    fit.covariance.row(size.column) *= wide / u;
    fit.covariance.col(size.column) *= wide / u;
  }
}

} // namespace gumshoe::tracing
