#pragma once
/// Fields of the result file of a trace (analysis/fields.h).
#include "analysis/fields.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// A residual with the words and the unit of its reading and its indication.
struct ResidualRow : Row {
  std::string reading_name, indication_name, unit, si_unit;
};

/// What repeats, in the unit of the residuals.
struct LackOfFitRow : LackOfFit {
  std::string unit, si_unit;
};
struct AnomalousBlockRow : AnomalousBlock {
  std::string unit, si_unit;
};

/// A size with the effect whose size it is, and its label values in one line.
struct SizeRow : SizedQuantity {
  std::string member, label_values;
};

extern const analysis::Fields<Trace> trace_fields;     ///< attributes
extern const analysis::Fields<Finding> finding_fields; ///< attributes
extern const analysis::Fields<SizeRow> size_fields;
extern const analysis::Fields<RankedCandidate> candidate_fields;
extern const analysis::Fields<DetectionLimit> limit_fields;
extern const analysis::Fields<Rms> rms_fields;                  ///< attributes
extern const analysis::Fields<IndicationError> indication_error_fields;
extern const analysis::Fields<Noise> noise_fields;              ///< attributes, in the unit of Rms
extern const analysis::Fields<LackOfFitRow> lack_of_fit_fields; ///< attributes
extern const analysis::Fields<AnomalousBlockRow> anomalous_block_fields;
extern const analysis::Fields<Outlier> outlier_fields;
extern const analysis::Fields<ResidualRow> residual_fields;

} // namespace gumshoe::tracing
