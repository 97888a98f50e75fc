#pragma once
/// The model's indications at given values of all quantities, reading by reading, and what moves them.
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "propagation/experiment.h"

namespace gumshoe::tracing {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// values[reading][quantity of the scenario], SI.
using Points = std::vector<std::vector<double>>;

/// Quantities set or shifted at every reading at once.
struct Variation {
  struct Change {
    std::size_t quantity;
    double value;
    bool absolute; ///< else added to what each reading has
  };
  std::vector<Change> changes;
};

/// Rows are [reading][indication]. Effects must be in the scenario to act; at null they change nothing.
class Simulator {
public:
  Simulator(const propagation::Experiment& experiment, int threads);
  std::size_t rows() const { return readings_ * indications_; }
  /// Values of the scenario: estimates of all quantities.
  Points estimates() const;
  /// f[rows]; false if the model has no value somewhere.
  bool simulate(const Points& at, Vector& f) const;
  /// The same under each variation: f[rows][variation]. `valid[variation]` is false where the model has no value.
  void vary(const Points& at, const std::vector<Variation>& variations, Matrix& f, std::vector<bool>& valid) const;
  /// derivative[rows][i] of each row by quantities[i] at its own reading. Exact; central differences where the model
  /// has no derivatives. `kink` if a reading has none there.
  bool derivatives(const Points& at, const std::vector<std::size_t>& quantities, Vector& f, Matrix& derivative,
                   bool* kink = nullptr) const;

private:
  bool by_dual_numbers(const Points& at, const std::vector<std::size_t>& quantities, Vector& f, Matrix& derivative,
                       bool* kink) const;
  bool by_differences(const Points& at, const std::vector<std::size_t>& quantities, Vector& f,
                      Matrix& derivative) const;
  /// Readings of equal quantities next to each other: a model may remember what it computed for the one before.
  std::vector<std::size_t> alike_together(const Points& at) const;
  double step(std::size_t quantity, const Points& at) const;
  /// What a stated effect adds: size times loading. Not the model's.
  void add_stated(const Points& at, const std::vector<std::size_t>& quantities, Vector& f, Matrix* derivative) const;

  const propagation::Experiment& experiment_;
  std::size_t readings_, indications_;
  int threads_;
  struct Stated {
    std::size_t quantity, effect;
  };
  std::vector<Stated> stated_;
};

} // namespace gumshoe::tracing
