#pragma once
/// From the samples of a run to its results.
#include "analysis/results.h"
#include "analysis/samples.h"
#include "propagation/experiment.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// Everything that [analysis] asks for: summaries, budgets, validation of the GUM framework, sensitivity, conformity,
/// comparisons, printed values, statements. The bits do not depend on the workers.
Results analyse(const propagation::Experiment& experiment, const Samples& samples, const propagation::Workers& workers);

/// The result as JCGM 100, 7.2 states one, in one or two sentences: rounded by 7.2.6, in the unit shown to people. It
/// says where the Monte Carlo method does not validate the GUM interval.
std::string statement(const Summary& summary, const Budget& budget, const Validation& validation,
                      double coverage_probability, bool virtual_experiment);

} // namespace gumshoe::analysis
