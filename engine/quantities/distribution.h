#pragma once
/// Probability distributions of JCGM 101:2008, Table 1, and a few more, as rows of one table.
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gumshoe::quantities {

enum class Family {
  constant,
  rectangular,
  curvilinear_trapezoid,
  trapezoid,
  triangular,
  arcsine,
  normal,
  t,
  exponential,
  gamma,
  lognormal,
  truncated_normal,
  discrete,
  empirical,
};

/// A parameter of a family: its key in a scenario and how its unit goes.
struct ParameterCard {
  enum class Dimension {
    point,
    difference,
    number,
    log
  };                    ///< like the quantity (affine), its differences, plain, of ln x
  std::string_view key; ///< "low", "high", "half_width", "u", "degrees_of_freedom", ...
  Dimension dimension;
  std::string_view meaning;
};

struct FamilyCard {
  Family family;
  std::string_view name;                     ///< as in a scenario: "rectangular"
  std::string_view reference;                ///< JCGM 101:2008 clause
  std::span<const ParameterCard> parameters; ///< in the order of Distribution::parameters
};

/// All families, in the order of Family, and one by its name; null if there is none.
std::span<const FamilyCard> families();
const FamilyCard* find_family(std::string_view name);

/// A distribution with its parameters in SI units. Immutable; cheap to copy.
///
/// Parameters by family, in this order:
///   constant(value); rectangular(low, high); curvilinear_trapezoid(low, high, inexactness d);
///   trapezoid(low, high, top_ratio beta); triangular(low, high); arcsine(low, high);
///   normal(mean, u); t(mean, scale, degrees_of_freedom, u): `u` of a scenario is the scale s/sqrt(n),
///   JCGM 101 6.4.9, or that of a certificate with effective degrees of freedom, 6.4.9.7; the last one is the standard
///   uncertainty of the law of propagation, 0: the scale (simultaneous observations have another, JCGM 102 5.3.2);
///   exponential(mean) from 0; gamma(shape, scale); lognormal(mu, sigma of ln x);
///   truncated_normal(mean, u, low, high): mean and u are the parent's;
///   discrete / empirical: `values` with `probabilities` (empirical: equal), no parameters, but of an empirical one from
///   an earlier result with degrees of freedom the first is the u of the law of propagation; 0: that of the values.
struct Distribution {
  Family family = Family::constant;
  std::array<double, 4> parameters{};
  std::shared_ptr<const std::vector<double>> values; ///< discrete, empirical: sorted; t: the observations, if it is of any
  std::shared_ptr<const std::vector<double>> probabilities; ///< discrete only: same length, sum 1

  /// Expectation; for t with 1 degree of freedom or fewer, which has none, the centre.
  double mean() const;
  /// Variance; +infinity for t with 2 degrees of freedom or fewer (no standard uncertainty exists).
  double variance() const;
  /// Standard uncertainty as the law of propagation takes it: of a t distribution its u: the s/sqrt(n) of a Type A
  /// evaluation or the declared u (JCGM 100, 4.2.3 and G.3); else the square root of the variance. Always finite.
  double standard_uncertainty() const;
  /// Fourth central moment over variance squared; NaN where it does not exist.
  double kurtosis() const;
  /// Third central moment over the variance's power 3/2; NaN where it does not exist.
  double skewness() const;
  /// Inverse distribution function, u in (0, 1).
  double quantile(double u) const;
  /// Density (0 for constant, discrete and empirical, which have none).
  double density(double x) const;
  /// Distribution function.
  double probability(double x) const;
  /// Smallest and largest possible value, +-infinity where unbounded.
  double support_low() const;
  double support_high() const;
};

/// Beyond these the quantiles of t and gamma cannot be tabulated: powers of the samples of such a t overflow, and the
/// series of such a gamma, which is normal to 1e-4 of its u, does not end.
inline constexpr double least_degrees_of_freedom = 0.25, largest_gamma_shape = 1e9;

/// What is wrong with the parameters, or empty: "low must be below high". Checked before first use.
std::string invalid_parameters(const Distribution& distribution);

/// quantile() of many values: out[i] = quantile(u[i]), i < n; n is a multiple of 8. The bits equal
/// quantile()'s. out may be u. Fast: vectorised closed forms, a tabulated inverse (relative error
/// of the deviate below 1e-12, tested against Boost.Math) for t and gamma. Prepare once per
/// distribution, use from any thread.
class QuantileFunction {
public:
  explicit QuantileFunction(const Distribution& distribution);
  void operator()(const double* u, double* out, std::size_t n) const;

private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

} // namespace gumshoe::quantities
