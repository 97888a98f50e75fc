#pragma once
/// The search: is anything left, which effect is it, is there another? One step at a time.
#include "tracing/fit/joint_fit.h"
#include "tracing/judgement/assess.h"
#include "tracing/judgement/holdout.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// What a step of the search took in.
struct Step {
  Kind kind = Kind::named;
  std::vector<std::size_t> terms; ///< into the last fit's terms; none: a variance component
  std::vector<std::string> members;
  std::vector<Term> rivals; ///< members of the class beside the first, fitted in its place
  double p_value = 1;
  double threshold = 0;     ///< likelihood ratio that the term had to pass
  double removed_share = 0; ///< of the mean square of what the declared model leaves
  std::vector<std::string> remarks;
  std::vector<std::string> depends_on;
  int component = -1; ///< of Design::scatter: what was found, or a member of the class
};

struct Search {
  JointFit base, found; ///< without and with the terms, to the training readings
  std::vector<Step> steps;
  Assessment first;                      ///< of the declared model
  std::vector<Alternative> alternatives; ///< of the first step
  std::vector<Candidate> candidates;     ///< ranking of the first step
  std::vector<DetectionLimit> limits;
  Assessment last; ///< after all steps
  std::vector<std::string> statements;
  int tried = 0;
};

struct Circumstances {
  const propagation::Experiment& experiment; ///< of the extended scenario
  const Simulator& simulator;
  const Observations& observations;
  const Fitter& fitter;
  double alpha;
  int draws;
  std::uint64_t seed;
  int threads;
  std::function<void(const std::string&)> progress;
};

Search search(const Circumstances& circumstances);

} // namespace gumshoe::tracing
