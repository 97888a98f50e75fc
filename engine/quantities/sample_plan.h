#pragma once
/// From input quantities and readings to columns of numbers.
///
/// A variate is one drawn number per sample: (quantity, entry, component, cell), the cell being the
/// combination of label values its scope distinguishes. A column is a quantity's value plus the sum
/// of the variates of its components, and differs between readings only if their labels do. The
/// gather says which column a reading uses; what is equal is drawn and solved once.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "quantities/input_quantity.h"

namespace gumshoe::quantities {

struct Variate {
  std::string name;         ///< "beam_pitch[setup 1]", with ": component" where a quantity has several
  std::size_t quantity = 0; ///< index into the quantities given
  std::size_t entry = 0, component = 0;
  Labels cell;               ///< labels that this draw is for (entry labels and scope)
  std::uint64_t key = 0;     ///< hash of (seed, quantity name, component name, cell): the Philox key
  Distribution distribution; ///< of the deviation
};

struct Column {
  double value = 0;                  ///< of the entry; deviations are added to it
  std::vector<std::size_t> variates; ///< indices into SamplePlan::variates
  std::size_t quantity = 0;          ///< of the scenario
};

/// Distribution of W = chi-squared / degrees of freedom: gamma(nu / 2, 2 / nu).
inline Distribution chi_squared_over(double degrees_of_freedom) {
  return {Family::gamma, {degrees_of_freedom / 2, 2 / degrees_of_freedom}, nullptr, nullptr};
}

/// Variates tied by a Gaussian copula, drawn together from the samples of an earlier run, or jointly t-distributed:
/// then z = L e is divided by sqrt(W), with one W = chi-squared / degrees of freedom for all of them.
struct CopulaGroup {
  std::vector<std::size_t> variates; ///< in the order of the rows
  std::vector<double> cholesky;  ///< lower factor L of the matrix, row-major; trailing columns are zero if it is singular
  std::vector<double> matrix;    ///< of the copula, or of the scales of the t distributions
  double degrees_of_freedom = 0; ///< of a multivariate t distribution; 0: Gaussian copula
  std::uint64_t key = 0;         ///< of the stream of W
  /// By variate: the rank of its value in each sample of an earlier run. One sample is drawn for all. The matrix is a
  /// Gaussian copula's near it, for whatever needs a conditional law; empty: it is the law itself.
  std::vector<std::vector<std::uint32_t>> together;
  std::vector<double> pearson; ///< Correlation::law; empty: of these samples, else by the copula
  bool singular() const { return cholesky.back() == 0; }
  bool multivariate_t() const { return degrees_of_freedom > 0; }
  Distribution shared_scale() const { return chi_squared_over(degrees_of_freedom); }
};

/// Draws of one component whose standard uncertainties are multiples of one estimate, such as a pooled s: it is as
/// much too small for all of them. t distributions are drawn jointly, then: their normal scores are independent, and
/// divided by sqrt(W), with one W = chi-squared / degrees of freedom for all. In none that a correlation ties.
struct CommonEstimate {
  std::vector<std::size_t> variates; ///< at least two
  double degrees_of_freedom = 0;     ///< finite
  bool jointly_t = false;            ///< drawn so; others have their own shapes, and are independent
  std::uint64_t key = 0;             ///< of the stream of W
};

struct SamplePlan {
  std::vector<Variate> variates;
  std::vector<Column> columns;
  std::vector<std::vector<std::size_t>> gather; ///< [reading][quantity] -> column
  std::vector<CopulaGroup> copulas;
  std::vector<CommonEstimate> estimates;
  /// Expectation of a column: value plus the means of its variates' distributions (the estimate).
  double estimate(std::size_t column) const;
  /// The same with variates drawn: one value each.
  double value(std::size_t column, const double* drawn) const;
  /// Columns from variates: out[column * stride + i] = value + sum of variates; `variates[v]` points to n values.
  /// Columns without variates are left alone: they are one number, `value`.
  void assemble(std::span<const double* const> variates, std::size_t n, double* out, std::size_t stride) const;
  /// One column of these, at `out`.
  void assemble_column(std::size_t column, std::span<const double* const> variates, std::size_t n, double* out) const;
};

/// Throws InputError: a label value of a reading that no entry of a `by` quantity has; a scope that
/// names no label; a correlation matrix that is not positive semidefinite (with its smallest
/// eigenvalue), or that no copula reaches; a correlated quantity with several components.
/// Correlated quantities are tied cell by cell: same cell with same cell.
SamplePlan make_plan(std::span<const InputQuantity> quantities, std::span<const Correlation> correlations,
                     std::span<const Reading> readings, std::uint64_t seed);

/// What a stream of random numbers is for; part of the counter, so purposes never share numbers.
enum class Purpose : std::uint32_t { sampling = 0, pick_freeze = 1, bootstrap = 2, stein = 3, fresh = 4 };
enum class PointSet { monte_carlo, latin_hypercube, sobol };

/// Draws the variates of a plan. Sample i has the same values whatever the block, thread or order.
/// Thread-safe after construction; no allocation per call beyond the first on a thread.
class Sampler {
public:
  /// The seed is in the variates' keys. `total` is the run's number of samples (Latin hypercube needs it; the other
  /// designs do not depend on it).
  Sampler(const SamplePlan& plan, PointSet design, std::uint64_t total);
  ~Sampler();
  /// Variates of samples [first, first + n): out[variate * stride + i]. first is a multiple of 64,
  /// n a multiple of 8, stride >= n.
  void draw(std::uint64_t first, std::size_t n, Purpose purpose, double* out, std::size_t stride) const;

private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

} // namespace gumshoe::quantities
