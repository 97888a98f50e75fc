#pragma once
/// Conformity assessment: JCGM 106:2012.
#include <optional>

#include "analysis/results.h"
#include "analysis/samples.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// What is known of the measurand, SI.
struct Known {
  double estimate, standard_uncertainty, expanded_uncertainty;
};

/// One decision: samples of the measurand (SI, NaN where failed), its estimate with u and U for the guard band, the
/// test.
///
/// Conformance probability (7.1): the share of the samples within the tolerance limits. Acceptance limits (8.3): the
/// tolerance limits moved inwards by w = guard_band + guard_factor U (w < 0: outwards, guarded rejection), or by the w
/// of the named rule. The decision is the estimate's place. Specific risks (9.3.2): of this item.
///
/// With a process, the prior g0: the posterior conformance probability by weighting the samples with g0 (7.2.2), and
/// the global risks (9.5.2): R_C = P(nonconforming and accepted), R_P = P(conforming and rejected) of an item that the
/// process makes. A measured value is eta - d, where d is distributed as the samples about the estimate, so that
/// without prior knowledge the samples are the state of knowledge; the integral over g0 is exact for each d, so the
/// standard errors are those of a mean over the deviations, of which the first 200,000 serve.
ConformityResult assess(const Column& samples, const Known& known, const scenario::ConformityTest& test,
                        int threads = 1);

/// " 30 failed samples are left out; they could move the conformance probability by 0.3 % at most."; empty without any.
std::string failed_text(const ConformityResult& result, std::uint64_t valid, std::uint64_t failed);

/// One for each of the scenario's tests and each output it names. U is the one that the result states (certify()), or
/// half the symmetric coverage interval where it states none.
std::vector<ConformityResult> conformity(const propagation::Experiment& experiment, const ValuesOf& values,
                                         const std::vector<Summary>& summaries, int threads);

} // namespace gumshoe::analysis
