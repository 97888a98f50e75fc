#include "store/results_writer.h"
#include "store/table.h"

namespace gumshoe::store {
using namespace analysis;

namespace {

void write_pairs(hid_t parent, const std::vector<SobolPair>& rows) {
  if (rows.empty()) return;
  const hdf5::Handle group = hdf5::create_group(parent, "pairs");
  Table table(group, "pair", rows.size());
  table.texts("a", column(rows, &SobolPair::a), "input quantity");
  table.texts("b", column(rows, &SobolPair::b), "the other input quantity");
  table.numbers("second", column(rows, &SobolPair::second), "1",
                "second-order Sobol' index: of the two together, beyond each alone");
  table.numbers("low", column(rows, &SobolPair::low), "1", "second-order index, lower confidence limit");
  table.numbers("high", column(rows, &SobolPair::high), "1", "second-order index, upper confidence limit");
  table.texts("verdict", column(rows, &SobolPair::verdict), "how well the index is known");
}

void write_sobol(hid_t group, const Sensitivity& study) {
  write_output(group, study.output);
  hdf5::write_attribute(group, "base_samples", study.base_samples);
  hdf5::write_attribute(group, "dropped_rows", study.dropped_rows);
  hdf5::write_attribute(group, "confidence", study.confidence);
  const auto& rows = study.indices;
  Table table(group, "input_quantity", rows.size());
  table.texts("input", column(rows, &SobolIndex::input), "input quantity");
  table.numbers("first", column(rows, &SobolIndex::first), "1", "first-order Sobol' index");
  table.numbers("first_low", column(rows, &SobolIndex::first_low), "1", "first-order index, lower confidence limit");
  table.numbers("first_high", column(rows, &SobolIndex::first_high), "1", "first-order index, upper confidence limit");
  table.numbers("total", column(rows, &SobolIndex::total), "1", "total Sobol' index");
  table.numbers("total_low", column(rows, &SobolIndex::total_low), "1", "total index, lower confidence limit");
  table.numbers("total_high", column(rows, &SobolIndex::total_high), "1", "total index, upper confidence limit");
  table.texts("first_verdict", column(rows, &SobolIndex::first_verdict), "how well the first-order index is known");
  table.texts("total_verdict", column(rows, &SobolIndex::total_verdict), "how well the total index is known");
  write_pairs(group, study.pairs);
}

/// The columns NAME, NAME_low, NAME_high and NAME_verdict.
void write_indices(Table& table, const std::string& name, const std::vector<Index>& rows, const std::string& what) {
  table.numbers(name, column(rows, &Index::value), "1", what);
  table.numbers(name + "_low", column(rows, &Index::low), "1", what + ", lower 95 % confidence limit");
  table.numbers(name + "_high", column(rows, &Index::high), "1", what + ", upper 95 % confidence limit");
  table.texts(name + "_verdict", column(rows, &Index::verdict), "how well it is known: " + what);
}

void write_shapley(hid_t group, const Shapley& study) {
  write_output(group, study.output);
  hdf5::write_attribute(group, "base_rows", study.rows);
  hdf5::write_attribute(group, "dropped_rows", study.dropped_rows);
  Table table(group, "input_quantity", study.effects.size());
  table.texts("input", column(study.effects, &Index::input), "input quantity");
  write_indices(table, "effect", study.effects, "Shapley effect: share of the variance, all add up to 1");
}

void write_given_data(hid_t group, const GivenData& study) {
  write_output(group, study.output);
  hdf5::write_attribute(group, "samples", study.samples);
  hdf5::write_attribute(group, "dropped", study.dropped);
  const bool first = !study.first.empty();
  const auto& names = first ? study.first : study.delta;
  Table table(group, "input_quantity", names.size());
  table.texts("input", column(names, &Index::input), "input quantity");
  if (first) write_indices(table, "first", study.first, "first-order index from ranks (Chatterjee, Gamboa)");
  if (!study.delta.empty()) write_indices(table, "delta", study.delta, "Borgonovo's delta");
}

void write_morris(hid_t group, const Morris& study) {
  write_output(group, study.output);
  hdf5::write_attribute(group, "trajectories", study.trajectories);
  hdf5::write_attribute(group, "dropped", study.dropped);
  const auto& rows = study.rows;
  const std::string& units = study.output.si_unit;
  Table table(group, "input_quantity", rows.size());
  table.texts("input", column(rows, &MorrisRow::input), "input quantity");
  table.numbers("mean", column(rows, &MorrisRow::mean), units, "mean elementary effect per standard uncertainty");
  table.numbers("mean_absolute", column(rows, &MorrisRow::mean_absolute), units,
                "mu*: mean of the absolute elementary effects per standard uncertainty");
  table.numbers("mean_absolute_se", column(rows, &MorrisRow::mean_absolute_se), units, "standard error of mu*");
  table.numbers("standard_deviation", column(rows, &MorrisRow::standard_deviation), units,
                "sigma: standard deviation of the elementary effects");
}

void write_dgsm(hid_t group, const Dgsm& study) {
  write_output(group, study.output);
  hdf5::write_attribute(group, "points", study.points);
  hdf5::write_attribute(group, "dropped", study.dropped);
  hdf5::write_attribute(group, "exact", study.exact ? 1 : 0);
  const auto& rows = study.rows;
  Table table(group, "input_quantity", rows.size());
  table.texts("input", column(rows, &DgsmRow::input), "input quantity");
  const std::string units = "output units squared / input units squared", none = ", NaN where none is known";
  table.numbers("nu", column(rows, &DgsmRow::nu), units, "nu: mean squared derivative");
  table.numbers("nu_se", column(rows, &DgsmRow::nu_se), units, "standard error of nu");
  table.numbers("bound", column(rows, &DgsmRow::bound), "1", "upper bound of the total Sobol' index" + none);
  table.numbers("bound_low", column(rows, &DgsmRow::bound_low), "1", "bound, lower 95 % confidence limit" + none);
  table.numbers("bound_high", column(rows, &DgsmRow::bound_high), "1", "bound, upper 95 % confidence limit" + none);
}

void write_one_at_a_time(hid_t group, const OneAtATimeTable& study) {
  hdf5::write_attribute(group, "title", study.title);
  const auto output_si = column(study.outputs, &propagation::Output::si_unit);
  Table outputs(group, "output", study.outputs.size());
  outputs.texts("output_name", column(study.outputs, &propagation::Output::name), "output");
  outputs.units(output_si, column(study.outputs, &propagation::Output::unit), "output_");
  const auto& rows = study.rows;
  const auto si = column(rows, &OneAtATimeRow::si_unit);
  Table table(group, "row", rows.size());
  table.texts("quantity", column(rows, &OneAtATimeRow::quantity), "input quantity");
  table.units(si, column(rows, &OneAtATimeRow::unit));
  table.numbers("step", column(rows, &OneAtATimeRow::step), common_units(si), "what is added to the quantity");
  const auto write_changes = [&](const char* name, auto member, const char* what) {
    std::vector<double> values;
    for (const OneAtATimeRow& row : rows) values.insert(values.end(), (row.*member).begin(), (row.*member).end());
    table.matrix(name, outputs, values, common_units(output_si), what);
  };
  write_changes("up", &OneAtATimeRow::up,
                "change of the output at the estimate plus the step, NaN where it has no value");
  write_changes("down", &OneAtATimeRow::down,
                "change of the output at the estimate minus the step, NaN where it has no value");
}

} // namespace

void write_sensitivity(hid_t file, const Results& r) {
  write_numbered(file, "sensitivity", r.sensitivities, write_sobol);
  write_numbered(file, "shapley", r.shapley, write_shapley);
  write_numbered(file, "given_data", r.given_data, write_given_data);
  write_numbered(file, "morris", r.morris, write_morris);
  write_numbered(file, "dgsm", r.dgsm, write_dgsm);
  write_numbered(file, "one_at_a_time", r.one_at_a_time, write_one_at_a_time);
}

} // namespace gumshoe::store
