#pragma once
/// The declared model and the effects found so far, fitted to some of the readings with the full non-linear model.
#include <optional>

#include "tracing/candidates/candidates.h"
#include "tracing/fit/scan.h"
#include "tracing/noise/declared_response.h"
#include "tracing/noise/design.h"

namespace gumshoe::tracing {

/// An effect that has been taken in, with its size.
struct Term {
  Alternative alternative;
  Vector size; ///< SI
};

struct JointFit {
  std::vector<Term> terms;
  Points at;            ///< all quantities, sizes of terms included
  Vector residual;      ///< measured minus simulated, rows in the order of measurement, all readings
  Design design;        ///< linearised there; the terms' columns are its last fixed ones
  Matrix covariance;    ///< of all fixed columns in use, SI; NaN for those that the readings do not see
  double noise = 1;     ///< scale of the declared noise that the design holds
  Structure structure;  ///< of the noise
  double variance = 1;  ///< left over by the design's noise
  double criterion = 0; ///< minus two ln likelihood, comparable between fits of equal noise
  bool valid = true;    ///< false: the model has no value there
  bool converged = true, kink = false;
  int iterations = 0;
};

/// Where a term's columns start among the fit's fixed ones.
Index first_column(const JointFit& fit, std::size_t term);

/// A free unknown: a quantity marked estimated that has no prior, or one of its entries.
struct FreeUnknown {
  std::string name;
  std::size_t quantity = 0, entry = 0;
  std::vector<bool> holds; ///< by reading
};

class Fitter {
public:
  /// @param experiment of the extended scenario
  Fitter(const propagation::Experiment& experiment, const Simulator& simulator, const Observations& observations,
         std::vector<Index> rows, int threads);

  /// Gauss-Newton with the winsorised residuals; from `start` where it is given. `noise` 0: found with the fit.
  JointFit fit(const std::vector<Term>& terms, double noise, const JointFit* start = nullptr) const;
  /// The declared model at its estimates, not fitted.
  JointFit linearised(double noise) const;
  /// Unknowns that only readings outside the fit feel, such as a constant of a block kept apart: found there with all
  /// else as fitted. The covariance takes them in.
  void settle(JointFit& fit) const;
  /// Where readings jump with a term's size, the tangent tells nothing of its uncertainty. In its place in the
  /// covariance comes that of the likelihood along the size, or by the straight line through the jumps, whichever is
  /// larger.
  void widen_jumping(JointFit& fit) const;
  const std::vector<FreeUnknown>& unknowns() const { return unknowns_; }
  bool noise_declared() const { return noise_declared_; }
  const std::vector<Index>& rows() const { return rows_; }

private:
  bool linearise(JointFit& fit) const;
  /// Gauss-Newton from a fit's point.
  void converge(JointFit& fit, double noise) const;
  /// Gauss-Newton ends in the next best optimum where readings jump: takes a size of the last term, near the one found,
  /// that fits better, all else as good as can be. False if there is none or nothing jumps.
  bool explore(JointFit& fit) const;
  struct Profile;
  /// Where it is worth the simulations: readings jump with the size, or do not follow its tangent.
  enum class Worth { jumps, tangent_wrong };
  /// `unit` is what the size may be uncertain by.
  std::optional<Profile> profile(const JointFit& fit, std::size_t term, Index amplitude, double unit,
                                 Worth worth) const;
  void local_noise(const Matrix& derivative, JointFit& fit) const;
  void apply(JointFit& fit, const Vector& change, double share) const;
  double objective(const JointFit& fit, const Whitened& prior, const Scan& scan) const;

  const propagation::Experiment& experiment_;
  const Simulator& simulator_;
  const Observations& observations_;
  std::vector<Index> rows_;
  int threads_;
  std::vector<FreeUnknown> unknowns_;
  bool noise_declared_ = false;
  /// What declared draws of effects do over the values they take, at the estimates.
  void find_responses();
  std::vector<DeclaredResponse> responses_; ///< by column of `needed_`
  Vector offset_;                           ///< of the readings' mean over these draws, by row of the simulator
  std::vector<std::size_t> needed_;         ///< quantities whose derivatives are used
  /// Draws with all that they move: by reading of the scenario, quantity.
  struct Draw {
    std::string name;
    double u = 0;
    std::vector<std::pair<std::size_t, std::size_t>> moves;
    bool local = false; ///< of one reading only
  };
  std::vector<Draw> draws_;
};

} // namespace gumshoe::tracing
