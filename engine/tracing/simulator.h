#pragma once
/// The forward model of a scenario for tracing: in matrices, on several threads.
#include <vector>

#include "propagation/experiment.h"
#include "tracing/matrix.h"

namespace gumshoe::tracing {

using propagation::Points;
using propagation::Variation;

/// Rows are [reading][indication]. Effects must be in the scenario to act; at null they change nothing.
class Simulator {
public:
  Simulator(const propagation::Experiment& experiment, int threads);
  std::size_t rows() const { return forward_.readings() * forward_.layout().indications.size(); }
  /// Estimates of all quantities of the scenario.
  Points estimates() const { return experiment_.estimates(); }
  /// f[rows]; false if the model has no value somewhere.
  bool simulate(const Points& at, Vector& f) const;
  /// The same under each variation: f[rows][variation]. `valid[variation]` is false where the model has no value.
  void vary(const Points& at, const std::vector<Variation>& variations, Matrix& f, std::vector<bool>& valid) const;
  /// derivative[rows][i] of each row by quantities[i] at its own reading. Exact; central differences where the model
  /// has no derivatives. `kink` if a reading has none there.
  bool derivatives(const Points& at, const std::vector<std::size_t>& quantities, Vector& f, Matrix& derivative,
                   bool* kink = nullptr) const;
  /// Whether the derivative by a quantity changes with a condition: [quantities[i]][condition], by some of the readings
  /// and the condition's ends; true where the model has no value there.
  std::vector<std::vector<bool>> changes_with(const Points& at, const std::vector<std::size_t>& quantities) const;

private:
  std::vector<propagation::Partial> partials(const Points& at, const std::vector<std::size_t>& quantities) const;
  double step(std::size_t quantity, const Points& at) const;

  const propagation::Experiment& experiment_;
  propagation::ForwardModel forward_;
};

} // namespace gumshoe::tracing
