/// Fits of a model that jumps, as a turning mill's readings do from tooth to tooth.
#include <algorithm>
#include <cmath>

#include "quantities/cells.h"
#include "tracing/joint_fit.h"

namespace gumshoe::tracing {
namespace {

/// Sizes tried about the one found, in its standard uncertainty.
constexpr double reach = 6, spacing = 0.25, coarse = 1.5;
/// What bends less about straight lines over the sizes jumps by nothing to speak of: in standard deviations of the
/// noise. What bends more than this share of its movement is mostly jumps: some size would fit anything.
constexpr double least = 0.1, most = 0.25;

bool jumps(const Matrix& f, const std::vector<double>& steps, double noise) {
  const Eigen::Map<const Vector> x(steps.data(), f.cols());
  const Vector sizes = x.array() - x.mean();
  const Matrix moved = f.colwise() - f.rowwise().mean(), line = moved * sizes / sizes.squaredNorm() * sizes.transpose();
  const double bend = (moved - line).norm();
  return bend > least * noise * std::sqrt(static_cast<double>(f.size())) && bend < most * line.norm();
}

} // namespace

bool Fitter::explore(JointFit& fit) const {
  if (fit.terms.empty()) return false;
  // The others were tried when they came.
  const Term& t = fit.terms.back();
  const auto count = static_cast<Index>(t.alternative.amplitudes.size());
  for (Index i = 0; i < count; ++i) {
    const Index own = fit.design.fixed.cols() - count + i;
    const Amplitude& a = t.alternative.amplitudes[static_cast<std::size_t>(i)];
    const double u = std::sqrt(fit.covariance(own, own)), size = t.size[i];
    // The tool itself is solved anew for every size: there no more than Gauss-Newton.
    if (a.quantity == Amplitude::npos || a.quantity < experiment_.model_quantities() || !(u > 0)) continue;
    std::vector<double> steps;
    Matrix f;
    const auto try_each = [&](double by) {
      std::vector<Variation> variations;
      steps.clear();
      for (double step = -reach; step <= reach; step += by)
        if (size + step * u >= a.low && size + step * u <= a.high) {
          steps.push_back(step * u);
          variations.push_back({{{a.quantity, step * u, false}}});
        }
      std::vector<bool> valid;
      simulator_.vary(fit.at, variations, f, valid);
      return steps.size() > 3 && std::find(valid.begin(), valid.end(), false) == valid.end();
    };
    if (!try_each(coarse) || !jumps(f, steps, fit.design.reference[0]) || !try_each(spacing)) continue;
    const auto found = std::find(steps.begin(), steps.end(), 0.0);
    if (found == steps.end()) continue;
    const Index here = found - steps.begin();
    // Beside all other unknowns.
    Design rest = fit.design;
    std::vector<Index> others;
    for (Index j = 0; j < rest.fixed.cols(); ++j)
      if (j != own) others.push_back(j);
    rest.fixed = Matrix(fit.design.fixed(Eigen::all, others));
    const Scan scan(rest, rows_, {}, threads_);
    const Whitened prior(rest, rows_, scan.used(), fit.structure);
    const Matrix residual =
        in_sequence(observations_, (-f).colwise() + f.col(here).eval()).colwise() + fit.residual;
    const Matrix white = prior.whiten(scan.winsorised(prior.take(residual)));
    const Vector left = prior.left(white);
    Index best = 0;
    if (!(left.minCoeff(&best) < left[here] * (1 - 1e-6))) continue;
    const Vector x = prior.solve(Matrix(white.rows(), 0), white.col(best));
    Vector change = Vector::Zero(fit.design.fixed.cols());
    for (std::size_t j = 0; j < scan.used().size(); ++j)
      change[others[static_cast<std::size_t>(scan.used()[j])]] = x[static_cast<Index>(j)];
    change[own] = steps[static_cast<std::size_t>(best)];
    JointFit next = fit;
    apply(next, change, 1);
    if (!linearise(next)) continue;
    fit = std::move(next);
    return true;
  }
  return false;
}

} // namespace gumshoe::tracing
