#pragma once
/// [analysis]: what is computed from the samples besides the plain summary.
#include "scenario/studies.h"

namespace gumshoe::scenario {

Options<AnalysisOptions> analysis_options();
Options<SensitivityOptions> sensitivity_options();

AnalysisOptions read_analysis(Table table, const StudyScope& scope, Context& context);

} // namespace gumshoe::scenario
