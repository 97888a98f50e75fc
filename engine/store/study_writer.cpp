#include "analysis/result_fields.h"
#include "store/field_writer.h"
#include "store/results_writer.h"

namespace gumshoe::store {
using namespace analysis;

namespace {

void write_sobol(hid_t group, const Sensitivity& study) {
  write_study(group, study, sobol_study_fields, sobol_fields, study.indices);
  if (!study.pairs.empty()) {
    const hdf5::Handle pairs = hdf5::create_group(group, "pairs");
    Table table(pairs, "pair", study.pairs.size());
    write_fields(table, pair_fields, study.pairs);
  }
}

void write_given_data(hid_t group, const GivenData& study) {
  const bool first = !study.first.empty();
  write_output(group, study.output);
  write_attributes(group, given_data_study_fields, study);
  Table table(group, "input_quantity", (first ? study.first : study.delta).size());
  write_fields(table, given_data_fields, first ? study.first : study.delta);
  if (first) write_fields(table, rank_fields, study.first);
  if (!study.delta.empty()) write_fields(table, delta_fields, study.delta);
}

void write_one_at_a_time(hid_t group, const OneAtATimeTable& study) {
  hdf5::write_attribute(group, "title", study.title);
  const auto output_si = column(study.outputs, &propagation::Output::si_unit);
  Table outputs(group, "output", study.outputs.size());
  outputs.texts("output_name", column(study.outputs, &propagation::Output::name), "output");
  outputs.units(output_si, column(study.outputs, &propagation::Output::unit), "output_");
  Table table(group, "row", study.rows.size());
  write_fields(table, one_at_a_time_fields, study.rows);
  for (const bool up : {true, false}) {
    std::vector<double> values;
    for (const OneAtATimeRow& row : study.rows) {
      const auto& changes = up ? row.up : row.down;
      values.insert(values.end(), changes.begin(), changes.end());
    }
    table.matrix(up ? "up" : "down", outputs, values, common_units(output_si),
                 fmt::format("change of the output at the estimate {} the step, NaN where it has no value",
                             up ? "plus" : "minus"));
  }
}

/// Rows that are outputs, with matrices over pairs of them.
struct Pairs {
  hdf5::Units units, squared;
  // netCDF readers want the two axes of a matrix to be two dimensions.
  Table rows;
  const Table columns;

  Pairs(hid_t group, const std::vector<propagation::Output>& outputs)
      : units(common_units(column(outputs, &propagation::Output::si_unit))),
        squared(units.note || units.text == "1" ? units : "(" + units.text + ")2"),
        rows(group, "output", outputs.size()), columns(group, "other_output", outputs.size()) {
    rows.texts("name", column(outputs, &propagation::Output::name), "output");
    rows.units(column(outputs, &propagation::Output::si_unit), column(outputs, &propagation::Output::unit));
  }
  void covariance(const std::string& name, const std::vector<double>& values, const std::string& meaning) {
    rows.matrix(name, columns, values, squared, meaning);
  }
  void correlation(const std::vector<double>& values, const std::string& meaning) {
    rows.matrix("correlation", columns, values, "1", meaning);
  }
};

void write_region(hid_t group, const JointRegion& region) {
  write_attributes(group, joint_fields, region);
  Pairs pairs(group, region.outputs);
  pairs.rows.numbers("estimate", region.estimate, pairs.units, "estimate: mean of the valid samples");
  pairs.covariance("covariance", region.covariance, "covariance of the outputs, from the samples");
  pairs.correlation(region.correlation, "correlation coefficients, NaN where a variance is zero");
  if (!region.gum_covariance.empty())
    pairs.covariance("gum_covariance", region.gum_covariance, "covariance by the law of propagation, JCGM 102 6.2");
}

void write_fit(hid_t group, const FitCovariance& fit) {
  write_output(group, fit.output);
  write_attributes(group, fit_fields, fit);
  Pairs pairs(group, fit.outputs);
  pairs.rows.numbers("standard_uncertainty", fit.standard_uncertainty, pairs.units,
                     "standard uncertainty by the fit itself, infinite where the readings leave it undetermined");
  pairs.covariance("covariance", fit.covariance, "covariance of the outputs, by the fit itself");
  pairs.correlation(fit.correlation, "correlation coefficients, NaN of what the readings leave undetermined");
}

void write_stopping(hid_t file, const Results& r) {
  const StoppingRecord& stopping = r.stopping;
  if (stopping.rule.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, "stopping");
  write_attributes(group, stopping_fields, stopping);
  if (stopping.tolerance.size() != r.summaries.size()) return;
  const auto si = column(r.summaries, [](const Summary& s) { return s.output.si_unit; });
  Table table(group, "output", r.summaries.size());
  table.texts("name", column(r.summaries, [](const Summary& s) { return s.output.name; }), "output");
  table.units(si, column(r.summaries, [](const Summary& s) { return s.output.unit; }));
  table.numbers("tolerance", stopping.tolerance, common_units(si), "numerical tolerance delta, JCGM 101 7.9.2");
}

} // namespace

void write_sensitivity(hid_t file, const std::vector<Sensitivity>& sobol, const std::vector<Shapley>& shapley) {
  write_numbered(file, "sensitivity", sobol, write_sobol);
  write_numbered(file, "shapley", shapley, [](hid_t group, const Shapley& study) {
    write_study(group, study, shapley_study_fields, shapley_fields, study.effects);
  });
}

void write_studies(hid_t file, const Results& r) {
  write_sensitivity(file, r.sensitivities, r.shapley);
  write_numbered(file, "given_data", r.given_data, write_given_data);
  write_numbered(file, "morris", r.morris, [](hid_t group, const Morris& study) {
    write_study(group, study, morris_study_fields, morris_fields, study.rows);
  });
  write_numbered(file, "dgsm", r.dgsm, [](hid_t group, const Dgsm& study) {
    write_study(group, study, dgsm_study_fields, dgsm_fields, study.rows);
  });
  write_numbered(file, "one_at_a_time", r.one_at_a_time, write_one_at_a_time);
  write_numbered(file, "joint", r.joint, write_region);
  write_numbered(file, "fit", r.fits, write_fit);
  if (!r.circular.empty()) write_table(file, circular_fields, r.circular);
  if (!r.conformity.empty()) write_table(file, conformity_fields, r.conformity);
  write_numbered(file, "target", r.targets, [](hid_t group, const TargetResult& study) {
    write_study(group, study, target_study_fields, target_fields, study.rows);
  });
  write_stopping(file, r);
}

} // namespace gumshoe::store
