#include "quantities/copula.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "base/error.h"

namespace gumshoe::quantities {
namespace {

constexpr int terms = 300;

bool has_steps(const Distribution& d) {
  return d.family == Family::constant || d.family == Family::discrete || d.family == Family::empirical;
}

/// Orthonormal Hermite polynomials h_0 .. h_terms at z, times the square root of the normal density.
std::vector<double> hermite_functions(double z) {
  std::vector<double> h(terms + 1);
  h[0] = std::exp(-z * z / 4) / std::pow(2 * std::numbers::pi, 0.25);
  h[1] = z * h[0];
  for (int k = 1; k < terms; ++k) h[k + 1] = (z * h[k] - std::sqrt(double(k)) * h[k - 1]) / std::sqrt(k + 1.0);
  return h;
}

double root_density(double z) { return std::exp(-z * z / 4) / std::pow(2 * std::numbers::pi, 0.25); }

struct Step {
  double value, probability; ///< of this value or a smaller one
};

/// The values, in order. Neighbours among very many are taken together as their mean: of a normal distribution the
/// coefficients below then lose less than 1e-5.
std::vector<Step> steps_of(const Distribution& d) {
  constexpr std::size_t most = 16384;
  const auto& values = *d.values;
  const std::size_t n = values.size(), together = d.family == Family::empirical ? (n + most - 1) / most : 1;
  std::vector<Step> out;
  for (std::size_t first = 0; first < n; first += together) {
    const std::size_t end = std::min(n, first + together);
    double rise = 0;
    for (std::size_t i = first; i < end; ++i) rise += (values[i] - values[first]) / static_cast<double>(end - first);
    const double p = together > 1 ? static_cast<double>(end) / static_cast<double>(n) : d.probability(values[first]);
    out.push_back({values[first] + rise, p});
  }
  return out;
}

/// a_k = E[x h_k(z)] / sd, k >= 1, of x = quantile(Phi(z)).
std::vector<double> hermite_coefficients(const Distribution& d) {
  std::vector<double> a(terms + 1, 0.0);
  const double sd = std::sqrt(d.variance());
  if (d.family == Family::normal) {
    a[1] = 1;
  } else if (has_steps(d)) {
    // A step of x at z: the integral of h_k over the density beyond z is h_(k-1)(z) phi(z) / sqrt(k).
    const auto steps = steps_of(d);
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
      const double rise = steps[i + 1].value - steps[i].value, p = steps[i].probability;
      if (rise == 0 || p <= 0 || p >= 1) continue;
      const double z = Distribution{Family::normal, {0, 1}, {}, {}}.quantile(p);
      const auto h = hermite_functions(z);
      for (int k = 1; k <= terms; ++k) a[k] += rise / sd * h[k - 1] * root_density(z) / std::sqrt(double(k));
    }
  } else {
    // The trapezoidal rule converges faster than any power; beyond 8.2 u no longer differs from 0 or 1.
    constexpr double step = 1.0 / 64, end = 8.2;
    const QuantileFunction quantile(d);
    const double mean = d.mean();
    for (double z = -end; z <= end; z += step) {
      double lanes[8] = {std::erfc(-z / std::numbers::sqrt2) / 2, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
      lanes[0] = std::min(std::max(lanes[0], 0x1p-53), 1 - 0x1p-53);
      quantile(lanes, lanes, 8);
      const auto h = hermite_functions(z);
      for (int k = 1; k <= terms; ++k) a[k] += step * (lanes[0] - mean) / sd * h[k] * root_density(z);
    }
  }
  return a;
}

double pearson_of(double rho, const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (int k = terms; k >= 1; --k) sum = (sum + a[k] * b[k]) * rho;
  return sum;
}

/// True if a = c + d b with the sign of `sign` holds for the two quantities when their order is the same (+1) or
/// opposite (-1): their standardised quantiles agree.
bool one_shape(const Distribution& a, const Distribution& b, double sign) {
  constexpr int points = 257;
  const double mean_a = a.mean(), mean_b = b.mean(), sd_a = std::sqrt(a.variance()), sd_b = std::sqrt(b.variance());
  for (int i = 0; i < points; ++i) {
    const double u = (i + 0.5) / points;
    const double x = (a.quantile(u) - mean_a) / sd_a;
    const double y = sign * (b.quantile(sign > 0 ? u : 1 - u) - mean_b) / sd_b;
    if (!(std::fabs(x - y) <= 1e-9 * (1 + std::fabs(x)))) return false;
  }
  return true;
}

bool finite_variance(const Distribution& d) { return std::isfinite(d.variance()) && d.variance() > 0; }

/// 2 sin(pi r / 6), exact at its ends.
double from_ranks(double r) { return std::fabs(r) == 1 ? r : 2 * std::sin(std::numbers::pi * r / 6); }

double from_pearson(double r, const Distribution& a, const Distribution& b, const std::string& pair) {
  if (a.family == Family::normal && b.family == Family::normal) return r;
  if (a.family == Family::rectangular && b.family == Family::rectangular) return from_ranks(r);
  for (const Distribution* d : {&a, &b})
    if (!finite_variance(*d))
      throw InputError(fmt::format("correlation of {}: a Pearson coefficient does not exist", pair),
                       "one of them has no finite, positive variance", "state a copula or spearman coefficient");
  const bool complete = std::fabs(r) == 1;
  if (complete && one_shape(a, b, r)) return r;
  const auto ca = hermite_coefficients(a), cb = hermite_coefficients(b);
  double low = -1, high = 1;
  const double least = pearson_of(low, ca, cb), greatest = pearson_of(high, ca, cb);
  if (r < least || r > greatest)
    throw InputError(
        fmt::format("correlation of {}: a Gaussian copula cannot reach the Pearson coefficient {}", pair, r),
        complete ? "as a Pearson coefficient, +1 and -1 need distributions of one shape"
                 : fmt::format("these distributions allow {:.4f} to {:.4f}", least, greatest),
        complete ? fmt::format("kind = \"spearman\", coefficient = {}", r) : "");
  while (high - low > 1e-14) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    (pearson_of(middle, ca, cb) < r ? low : high) = middle;
  }
  return (low + high) / 2;
}

} // namespace

double pearson_coefficient(double copula, const Distribution& a, const Distribution& b) {
  if (a.family == Family::normal && b.family == Family::normal) return copula;
  const auto without_variance = [](const Distribution& d) { return d.family == Family::t && std::isinf(d.variance()); };
  if (without_variance(a) || without_variance(b)) return copula;
  if (std::fabs(copula) == 1 && finite_variance(a) && finite_variance(b) && one_shape(a, b, copula)) return copula;
  if (a.family == Family::rectangular && b.family == Family::rectangular)
    return 6 / std::numbers::pi * std::asin(copula / 2);
  if (!finite_variance(a) || !finite_variance(b)) return std::numeric_limits<double>::quiet_NaN();
  return pearson_of(copula, hermite_coefficients(a), hermite_coefficients(b));
}

double copula_coefficient(Correlation::Kind kind, double r, const Distribution& a, const Distribution& b,
                          const std::string& pair) {
  if (r == 0) return 0;
  switch (kind) {
  case Correlation::Kind::copula:
  case Correlation::Kind::multivariate_t:
    return r;
  case Correlation::Kind::spearman:
    if (has_steps(a) || has_steps(b))
      throw InputError(fmt::format("correlation of {}: a spearman coefficient needs continuous distributions", pair),
                       "discrete values have tied ranks", "state a copula or pearson coefficient");
    return from_ranks(r);
  case Correlation::Kind::pearson:
    return from_pearson(r, a, b, pair);
  }
  return r;
}

namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double smallest_eigenvalue(const std::vector<double>& matrix, std::size_t n) {
  const auto size = static_cast<Eigen::Index>(n);
  const Eigen::Map<const Matrix> m(matrix.data(), size, size);
  return Eigen::SelfAdjointEigenSolver<Matrix>(m, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
}

[[noreturn]] void refuse_indefinite(double smallest, double stated, double least, const std::string& group) {
  const std::string why = fmt::format("its smallest eigenvalue is {:.6g}", smallest);
  if (stated >= least)
    throw InputError(fmt::format("correlation of {}: no Gaussian copula of these distributions has this matrix", group),
                     "the copula's matrix: " + why, "kind = \"copula\", or normal distributions");
  // The eigenvalues of 1 + f (R - 1) are 1 + f (l - 1).
  throw InputError(fmt::format("correlation of {}: the matrix is not positive semidefinite", group), why,
                   fmt::format("write the coefficients with more digits, or multiply those off the diagonal by {:.6g}",
                               std::floor(1e6 / (1 - stated)) / 1e6));
}

/// Cholesky's factor of a positive semidefinite matrix, the largest remaining pivot first; of equal ones the first.
CorrelationFactor pivoted(const std::vector<double>& matrix, std::size_t n, double least) {
  CorrelationFactor f{std::vector<std::size_t>(n), std::vector<double>(n * n, 0.0)};
  std::iota(f.order.begin(), f.order.end(), 0);
  const auto left = [&](std::size_t i, std::size_t j, std::size_t k) { // the remaining matrix after k columns
    double x = matrix[f.order[i] * n + f.order[j]];
    for (std::size_t c = 0; c < k; ++c) x -= f.lower[i * n + c] * f.lower[j * n + c];
    return x;
  };
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (left(i, i, k) > left(best, best, k) + least) best = i;
    if (left(best, best, k) <= least) break;
    // The row moves up, the others keep their order.
    std::rotate(f.order.begin() + std::ptrdiff_t(k), f.order.begin() + std::ptrdiff_t(best),
                f.order.begin() + std::ptrdiff_t(best) + 1);
    std::rotate(f.lower.begin() + std::ptrdiff_t(k * n), f.lower.begin() + std::ptrdiff_t(best * n),
                f.lower.begin() + std::ptrdiff_t(best * n + n));
    const double pivot = std::sqrt(left(k, k, k));
    for (std::size_t i = k + 1; i < n; ++i) f.lower[i * n + k] = left(i, k, k) / pivot;
    f.lower[k * n + k] = pivot;
  }
  return f;
}

} // namespace

CorrelationFactor correlation_factor(const std::vector<double>& matrix, const std::vector<double>& stated,
                                     std::size_t n, const std::string& group) {
  const double order = static_cast<double>(n), tolerated = 1e-12 * order;
  const double smallest = smallest_eigenvalue(matrix, n);
  if (!(smallest >= -tolerated)) refuse_indefinite(smallest, smallest_eigenvalue(stated, n), -tolerated, group);
  // A coefficient of 1 - 1e-12 is not 1: the difference of such quantities has an uncertainty. Only what rounding makes
  // of a singular matrix is singular, and what coefficients with too few digits do, which leave it indefinite.
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * order;
  const auto size = static_cast<Eigen::Index>(n);
  const Eigen::LLT<Matrix> factor(Eigen::Map<const Matrix>(matrix.data(), size, size));
  if (!(smallest > rounding) || factor.info() != Eigen::Success)
    return pivoted(matrix, n, std::clamp(-smallest * order, rounding, tolerated));
  const Matrix lower = factor.matrixL();
  CorrelationFactor out{std::vector<std::size_t>(n), {lower.data(), lower.data() + lower.size()}};
  std::iota(out.order.begin(), out.order.end(), 0);
  return out;
}

} // namespace gumshoe::quantities
