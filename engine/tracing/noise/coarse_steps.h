#pragma once
/// Noise as a coarse display shows it.
///
/// Where the noise is less than half a step, readings of one place come back with one deviation, and rounding looks
/// like an effect. Draws of the noise that are read in the same steps hold as much of that as the data do.
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {

/// Root mean square scatter, about their mean, of readings of one place whose normal noise is `noise`, read in steps q;
/// over all places between two steps:
///   s^2 = noise^2 + q^2 / 12 - sum over k >= 1 of q^2 / (2 pi^2 k^2) exp(-4 pi^2 k^2 noise^2 / q^2),
/// the variance of noise and rounding less that of their mean, whose Fourier series this is.
double scatter_read(double noise, double step);
/// The noise of which readings in these steps scatter so. 0 <= scatter <= step
double noise_before_steps(double scatter, double step);

/// The steps of some readings and the values that the model has there.
class CoarseSteps {
public:
  /// Steps are not coarse.
  CoarseSteps() = default;
  /// @param rows       chosen rows
  /// @param predicted  their values by the model, SI
  /// @param scatter    of readings of one place, by indication, in units of the design's noise
  /// @param freedom    degrees of freedom of each of them
  /// @param readouts   how the readouts of a mean scatter: that of the means tells of fewer
  CoarseSteps(const Design& design, const std::vector<Index>& rows, Vector predicted, const Vector& scatter,
              double freedom, const ReadoutScatter& readouts = {});

  bool any() const { return !noise_.empty(); }
  /// By indication, the standard deviation of the noise before it is read over `s` times that of the design; 1 where
  /// steps are not coarse.
  std::vector<double> share(double s) const;
  /// Draws (chosen rows x sets, SI) as they are read, each readout of a mean by itself. Where between two steps the
  /// values lie is drawn, too.
  Matrix read(Matrix drawn, const Draws& draws, std::uint64_t seed) const;

private:
  std::vector<double>
      noise_; ///< by indication, before it is read, in units of the design's noise; empty: none is coarse
  std::vector<double> step_;  ///< by indication, SI; 0: not coarse
  std::vector<double> each_;  ///< by indication: standard deviation of the noise of a readout, SI
  std::vector<int> readouts_; ///< by chosen row
  Vector predicted_;
};

} // namespace gumshoe::tracing
