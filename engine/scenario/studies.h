#pragma once
/// Studies of [analysis] that are about one measurand or step through quantities: one-at-a-time tables, conformity,
/// target uncertainties.
#include "scenario/context.h"
#include "scenario/option.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

/// What a study may name.
struct StudyScope {
  const ModelCard& model; ///< with the measurands of the scenario's evaluation
  const std::vector<quantities::InputQuantity>& quantities;
};

Shape one_at_a_time_shape();
Shape conformity_shape();
Shape target_shape();

OneAtATime read_one_at_a_time(Table table, const StudyScope& scope);
ConformityTest read_conformity(Table table, const StudyScope& scope, Context& context);
Target read_target(Table table, const StudyScope& scope, Context& context);

/// Keys that say what a figure is of: "measurand", "labels".
Key measurand_key();
Key labels_key();
/// The measurand named by the key "measurand"; null and a problem if there is none of that name.
const VariableCard* read_measurand(Table& table, const ModelCard& model);
/// labels = { rod = "rod 1" }; a problem if no reading has them.
quantities::Labels read_labels(Table& table, Context& context);

/// Reads the measurand and the labels that a study is about; null if there is no such measurand: then nothing else of
/// the study can be judged.
template <class Study>
const VariableCard* read_subject(Table& table, const StudyScope& scope, Context& context, Study& out) {
  const VariableCard* measurand = read_measurand(table, scope.model);
  out.labels = read_labels(table, context);
  if (measurand) out.measurand = measurand->name;
  return measurand;
}

} // namespace gumshoe::scenario
