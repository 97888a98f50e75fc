#pragma once
/// What [run] and [analysis] may ask for beyond the plain summary: adaptive runs, sensitivity studies, one-at-a-time
/// tables, conformity, target uncertainties, joint regions.
#include "scenario/context.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

/// What a study may name.
struct StudyScope {
  const ModelCard& model;
  const std::vector<quantities::InputQuantity>& quantities;
};

/// adaptive = { rule = "stein", digits = 2, max_samples = 1e8 }
Adaptive read_adaptive(Table table);
/// sensitivity = { sobol = 65536, second_order = true, shapley = 4096, given_data = 65536, morris = 64, dgsm = 4096 }
SensitivityOptions read_sensitivity(Table table);
/// steps = ["100 um", "0.1 mrad"] (each quantity of that dimension) or steps = { rod_radius = "100 um" }
OneAtATime read_one_at_a_time(Table table, const StudyScope& scope, Context& context);
/// lower, upper, guard_band or guard_factor, process = { a distribution }
ConformityTest read_conformity(Table table, const StudyScope& scope, Context& context);
/// U = "5 um", costs = { rod_length = 3, beam_pitch = 1 }
Target read_target(Table table, const StudyScope& scope, Context& context);
/// joint = [["R", "X"], ["R", "X", "Z"]]
std::vector<std::vector<std::string>> read_joint(Table& table, const StudyScope& scope, Problems& problems);

/// The measurand named by the key "measurand"; null and a problem if there is none of that name.
const VariableCard* read_measurand(Table& table, const ModelCard& model);
/// labels = { rod = "rod 1" }; a problem if no reading has them.
quantities::Labels read_labels(Table& table, Context& context);

} // namespace gumshoe::scenario
