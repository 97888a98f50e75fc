#pragma once
/// The fields of everything in results.h that the result file holds as a table or as attributes of a group (fields.h).
#include "analysis/fields.h"
#include "analysis/results.h"

namespace gumshoe::analysis {

extern const Fields<Equation> equation_fields;
extern const Fields<AxisRecord> axis_fields;
extern const Fields<InputRecord> input_fields;
extern const Fields<Summary> summary_fields;
extern const Fields<Budget> budget_fields; ///< attributes
extern const Fields<Contribution> contribution_fields;
extern const Fields<Validation> validation_fields;
extern const Fields<ComparisonResult> comparison_fields;
extern const Fields<PrintedResult> printed_fields;
extern const Fields<PredictedReading> predicted_fields;
extern const Fields<StoppingRecord> stopping_fields; ///< attributes

// study_fields.cpp
extern const Fields<Sensitivity> sobol_study_fields; ///< attributes, as all ..._study_fields
extern const Fields<SobolIndex> sobol_fields;
extern const Fields<SobolPair> pair_fields;
extern const Fields<Shapley> shapley_study_fields;
extern const Fields<Index> shapley_fields;
extern const Fields<GivenData> given_data_study_fields;
extern const Fields<Index> given_data_fields, rank_fields, delta_fields; ///< the input, and its two indices
extern const Fields<Morris> morris_study_fields;
extern const Fields<MorrisRow> morris_fields;
extern const Fields<Dgsm> dgsm_study_fields;
extern const Fields<DgsmRow> dgsm_fields;
extern const Fields<OneAtATimeRow> one_at_a_time_fields;
extern const Fields<JointRegion> joint_fields; ///< attributes
extern const Fields<FitCovariance> fit_fields;  ///< attributes
extern const Fields<CircularSummary> circular_fields;
extern const Fields<ConformityResult> conformity_fields;
extern const Fields<TargetResult> target_study_fields;
extern const Fields<TargetRow> target_fields;

} // namespace gumshoe::analysis
