#pragma once
/// Adaptive runs: how many Monte Carlo trials until the results are known to a number of digits.
///
/// Both rules look at blocks of J = max(100 / (1 - p), 10^4) trials, and at four figures of each block: the estimate,
/// the standard uncertainty and both ends of the symmetric coverage interval.
///   jcgm_101: JCGM 101 7.9.4. After each block, twice the standard deviation of the mean of the block figures is
///     compared with the tolerance delta of the standard uncertainty so far; stop when none exceeds it, at h >= 2
///     blocks. It stops by chance too early, since it looks again and again at few blocks.
///   stein: two stages (Stein 1945; Wuebbeler, Harris, Cox, Elster 2010). From the scatter s of h_1 = 10 blocks follows
///     the number h = max(h_1, ceil(t^2 s^2 / delta^2)), t the 97.5 % quantile of Student's t with h_1 - 1 degrees of
///     freedom: the mean of h blocks then lies within delta of its expectation with a probability of at least 95 %.
/// Several outputs: every one must be done. The block figures do not depend on threads, so neither does the stop.
#include <span>
#include <vector>

#include "analysis/results.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

class StoppingRules {
public:
  static constexpr std::uint64_t first_stage = 10; ///< blocks
  /// `share` of delta is aimed at: 1, or below 1/5 for a validation (JCGM 101, 8.2).
  StoppingRules(std::vector<propagation::Output> outputs, double coverage_probability, int digits, double share = 1);

  std::uint64_t block() const { return block_; }
  std::uint64_t blocks() const { return blocks_; }
  /// The next block: `values` of every output, NaN where failed. Calls come output by output, 0 first.
  void add(std::size_t output, std::span<const double> values);
  /// Blocks after which JCGM 101 7.9 stops; 0: not yet.
  std::uint64_t jcgm_blocks() const { return jcgm_; }
  /// All blocks so far together satisfy the criterion of JCGM 101 7.9.
  bool settled() const { return settled_; }
  /// Blocks that the two-stage rule asks for; 0: its first stage is not complete.
  std::uint64_t stein_blocks() const { return stein_; }
  /// delta of each output from all blocks so far, SI; NaN where nothing varies or no standard uncertainty exists.
  std::vector<double> tolerances() const;

private:
  struct Figures {
    std::vector<double> mean, u, low, high; ///< by block
    double tolerance = 0;
  };
  void look();
  std::vector<propagation::Output> outputs_;
  double p_, share_;
  int digits_;
  std::uint64_t block_, blocks_ = 0, jcgm_ = 0, stein_ = 0;
  bool settled_ = false;
  std::vector<Figures> figures_;
};

/// Runs the experiment into the store until the scenario's rule is satisfied, or its `most` samples are done, and
/// leaves the store at exactly the number of trials used. Resumes from what the store holds. `stopped`: a signal came
/// first; the same call goes on.
StoppingRecord run_adaptively(const propagation::Experiment& experiment, propagation::SampleStore& store,
                              propagation::RunSettings settings, bool& stopped);

} // namespace gumshoe::analysis
