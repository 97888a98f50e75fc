#include "tracing/noise/coarse_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <boost/math/tools/toms748_solve.hpp>

#include "random/streams.h"

namespace gumshoe::tracing {

double scatter_read(double noise, double step) {
  using std::numbers::pi;
  // Terms of the series fall as exp(-k^2 t^2): where t is small, as many as still count.
  const double t = 2 * pi * noise / step;
  if (!(t > 1e-3)) return step * std::sqrt(noise / step / std::sqrt(pi)); // the series of erfc to its first term
  double mean = 0;
  for (double k = 1; k * t < 6.5; ++k) mean += std::exp(-k * k * t * t) / (2 * pi * pi * k * k);
  return step * std::sqrt(std::max(0.0, noise * noise / step / step + 1.0 / 12 - mean));
}

double noise_before_steps(double scatter, double step) {
  if (!(scatter > 0)) return 0;
  const auto above = [&](double noise) { return scatter_read(noise, step) - scatter; };
  std::uintmax_t most = 100;
  const auto [low, high] =
      boost::math::tools::toms748_solve(above, 0.0, scatter + step, boost::math::tools::eps_tolerance<double>(30), most);
  return (low + high) / 2;
}

namespace {

constexpr double sure = 6; ///< standard deviations of a variance of normal noise

} // namespace

/// Readings that are all equal do not show that they have no noise: while one in all is expected to be off by a step, it
/// is likely that none is. It leaves half the square of a step about the mean of two.
CoarseSteps::CoarseSteps(const Design& d, const std::vector<Index>& rows, Vector predicted, const Vector& scatter,
                         double freedom, const ReadoutScatter& within)
    : predicted_(std::move(predicted)) {
  double readouts = 0; // of a reading, on average
  for (const Index row : rows) {
    readouts_.push_back(static_cast<int>(readouts_of_row(d, row)));
    readouts += readouts_of_row(d, row) / static_cast<double>(rows.size());
  }
  for (std::size_t k = 0; k < d.coarse.size(); ++k) {
    const double q = d.coarse[k] ? d.step[k] : 0;
    const auto noise = [&](double s, double of) {
      return q > 0 ? noise_before_steps(std::hypot(s, q / std::sqrt(2 * of)), q) : 0;
    };
    const double between = scatter[index(k)] * d.reference[k] * std::sqrt(readouts); // as one readout would
    step_.push_back(q);
    each_.push_back(within.freedom > 0 ? noise(within.s[k], within.freedom) : noise(between, freedom));
    // Means scatter more than their readouts tell only if they surely do: what is off by a step is rare.
    const bool alike = within.freedom > 0 && std::pow(between / within.s[k], 2) < 1 + sure * std::sqrt(2 / freedom);
    noise_.push_back((alike ? each_.back() : noise(between, freedom)) / std::sqrt(readouts) / d.reference[k]);
  }
}

std::vector<double> CoarseSteps::share(double s) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < noise_.size(); ++k) out.push_back(step_[k] > 0 ? noise_[k] / s : 1);
  return out;
}

Matrix CoarseSteps::read(Matrix drawn, const Draws& draws, std::uint64_t seed) const {
  const auto indications = index(noise_.size());
  std::vector<double> place((draws.count + 1) / 2 * 2);
  for (Index k = 0; k < indications; ++k) {
    const double q = step_[index(k)];
    if (!(q > 0)) continue;
    random::uniforms({seed, static_cast<std::uint32_t>(k + 1), 6, 0}, draws.first, place.size(), place.data());
    for (Index i = k; i < drawn.rows(); i += indications) {
      const int n = readouts_[index(i)];
      // How the readouts of a mean differ from it.
      const Matrix apart = n > 1 ? Matrix(each_[index(k)] * normals(index(n), draws, seed + index(i) + 1, 7))
                                 : Matrix(Matrix::Zero(1, drawn.cols()));
      for (Index j = 0; j < drawn.cols(); ++j) {
        const double value = predicted_[i] + q * place[index(j)], mean = value + drawn(i, j) - apart.col(j).mean();
        double sum = 0;
        for (Index one = 0; one < n; ++one) sum += q * std::round((mean + apart(one, j)) / q);
        drawn(i, j) = sum / n - value;
      }
    }
  }
  return drawn;
}

} // namespace gumshoe::tracing
