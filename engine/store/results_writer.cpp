#include "store/results_writer.h"

#include <algorithm>

#include <fmt/format.h>

#include "store/table.h"

namespace gumshoe::store {
using namespace analysis;

std::string label_text(const quantities::Labels& labels) {
  std::string text;
  for (const auto& [name, value] : labels) text += (text.empty() ? "" : ", ") + value;
  return text;
}

namespace {

void write_record(hid_t file, const Results& r) {
  const std::pair<const char*, const std::string*> texts[] = {{"version", &r.version},
                                                              {"git_hash", &r.git_hash},
                                                              {"instruction_set", &r.instruction_set},
                                                              {"title", &r.title},
                                                              {"model", &r.model},
                                                              {"model_title", &r.model_title},
                                                              {"method", &r.method},
                                                              {"evaluation", &r.evaluation},
                                                              {"design", &r.design},
                                                              {"scenario_file", &r.scenario_file}};
  for (const auto& [name, text] : texts) hdf5::write_attribute(file, name, *text);
  hdf5::write_attribute(file, "failed", r.failed);
  hdf5::write_attribute(file, "coverage_probability", r.coverage_probability);
}

void write_readings(hid_t file, const Results& r) {
  const hdf5::Handle group = hdf5::create_group(file, "readings");
  Table table(group, "reading", r.readings.size());
  table.texts("label", column(r.readings, [](const auto& reading) { return label_text(reading.labels); }),
              "label values of the reading");
  table.numbers("repeats", column(r.readings, &quantities::Reading::repeats), "1", "readouts averaged in the reading");
  const auto write_columns = [&](const auto& names, const auto& units, auto member, const std::string& what) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::vector<double> values;
      for (const auto& reading : r.readings)
        if (i < (reading.*member).size()) values.push_back((reading.*member)[i]);
      if (values.size() == r.readings.size() && !values.empty() && !hdf5::has(group, names[i]))
        table.numbers(names[i], values, units[i], what + names[i]);
    }
  };
  write_columns(r.condition_names, r.condition_units, &quantities::Reading::conditions, "condition ");
  write_columns(r.indication_names, r.indication_units, &quantities::Reading::indications, "indication ");
}

void write_inputs(hid_t file, const std::vector<InputRecord>& rows) {
  const hdf5::Handle group = hdf5::create_group(file, "inputs");
  Table table(group, "input", rows.size());
  const auto si = column(rows, &InputRecord::si_unit);
  table.texts("name", column(rows, &InputRecord::name), "input quantity");
  table.texts("labels", column(rows, &InputRecord::labels), "label values it holds for");
  table.units(si, column(rows, &InputRecord::unit));
  table.numbers("value", column(rows, &InputRecord::value), common_units(si), "estimate");
  table.numbers("standard_uncertainty", column(rows, &InputRecord::standard_uncertainty), common_units(si),
                "standard uncertainty");
  table.texts("distribution", column(rows, &InputRecord::distribution), "distribution");
  table.texts("evaluation", column(rows, &InputRecord::evaluation), "Type A or Type B evaluation");
  table.texts("scope", column(rows, &InputRecord::scope), "scope of one draw");
  table.texts("source", column(rows, &InputRecord::source), "source");
}

void write_interval(Table& table, const Results& r, Interval Summary::*interval, const std::string& name,
                    const std::string& units, const std::string& what) {
  const std::pair<const char*, double Interval::*> ends[] = {
      {"_low", &Interval::low},         {"_high", &Interval::high},         {"_low_se", &Interval::low_se},
      {"_high_se", &Interval::high_se}, {"_low_rank", &Interval::low_rank}, {"_high_rank", &Interval::high_rank}};
  const char* meaning[] = {"lower end",
                           "upper end",
                           "Monte Carlo standard error of the lower end",
                           "Monte Carlo standard error of the upper end",
                           "lower end whatever values the failed samples had",
                           "upper end whatever values the failed samples had"};
  for (std::size_t i = 0; i < std::size(ends); ++i) {
    const auto end = ends[i].second;
    table.numbers(name + ends[i].first, column(r.summaries, [=](const Summary& s) { return s.*interval.*end; }), units,
                  what + ", " + meaning[i]);
  }
}

void write_summary(hid_t file, const Results& r) {
  const auto& rows = r.summaries;
  const hdf5::Handle group = hdf5::create_group(file, "summary");
  Table table(group, "output", rows.size());
  const auto si = column(rows, [](const Summary& s) { return s.output.si_unit; });
  const std::string units = common_units(si);
  table.texts("name", column(rows, [](const Summary& s) { return s.output.name; }), "output: a measurand at a reading");
  table.texts("measurand", column(rows, [](const Summary& s) { return s.output.measurand; }), "measurand");
  table.numbers("reading", column(rows, [](const Summary& s) { return static_cast<std::uint64_t>(s.output.reading); }),
                "1", "position of the reading, from 0");
  table.units(si, column(rows, [](const Summary& s) { return s.output.unit; }));
  table.numbers("estimate", column(rows, &Summary::estimate), units, "estimate: mean of the valid samples");
  table.numbers("estimate_se", column(rows, &Summary::estimate_se), units,
                "Monte Carlo standard error of the estimate");
  table.numbers("standard_uncertainty", column(rows, &Summary::standard_uncertainty), units, "standard uncertainty");
  table.numbers("standard_uncertainty_se", column(rows, &Summary::standard_uncertainty_se), units,
                "Monte Carlo standard error of the standard uncertainty");
  write_interval(table, r, &Summary::symmetric, "symmetric", units, "probabilistically symmetric coverage interval");
  write_interval(table, r, &Summary::shortest, "shortest", units, "shortest coverage interval");
  table.numbers("valid", column(rows, &Summary::valid), "1", "samples with a value");
  table.numbers("failed", column(rows, &Summary::failed), "1", "samples without a value");
  table.numbers("skewness", column(rows, &Summary::skewness), "1", "skewness");
  table.numbers("kurtosis", column(rows, &Summary::kurtosis), "1", "kurtosis");
  table.numbers("hill_index", column(rows, &Summary::hill_index), "1",
                "tail index by Hill's estimator, NaN if not estimated");
  table.texts("warning", column(rows, &Summary::warning), "what the reader must know of this output");
  table.texts("tail_remark", column(rows, &Summary::tail_remark), "what heavy tails do to the standard uncertainty");
  auto statements = r.statements;
  statements.resize(rows.size());
  table.texts("statement", statements, "the result in the words of the GUM");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto name = [k](const char* what) { return fmt::format("{}_{:03d}", what, k); };
    const std::string& unit = rows[k].output.si_unit;
    Table edges(group, name("edge"), rows[k].bin_edges.size());
    edges.numbers(name("histogram_edges"), rows[k].bin_edges, unit, "edges of the bins, " + rows[k].output.name);
    Table bins(group, name("bin"), rows[k].density.size());
    bins.numbers(name("histogram"), rows[k].density, unit == "1" ? "1" : "(" + unit + ")-1",
                 "probability density, " + rows[k].output.name);
  }
}

void write_budget(hid_t group, const Budget& budget) {
  write_output(group, budget.output);
  hdf5::write_attribute(group, "reason", budget.reason);
  hdf5::write_attribute(group, "remark", budget.remark);
  hdf5::write_attribute(group, "applicable", budget.applicable ? 1 : 0);
  const std::pair<const char*, double> figures[] = {
      {"estimate", budget.estimate},
      {"correlation_share", budget.correlation_share},
      {"monte_carlo_interactions", budget.monte_carlo_interactions},
      {"combined_standard_uncertainty", budget.combined_standard_uncertainty},
      {"second_order_uncertainty", budget.second_order_uncertainty},
      {"second_order_bias", budget.second_order_bias},
      {"effective_degrees_of_freedom", budget.effective_degrees_of_freedom},
      {"coverage_factor", budget.coverage_factor},
      {"expanded_uncertainty", budget.expanded_uncertainty}};
  for (const auto& [key, value] : figures) hdf5::write_attribute(group, key, value);

  const auto& rows = budget.contributions;
  Table table(group, "component", rows.size());
  const auto si = column(rows, &Contribution::si_unit);
  table.texts("name", column(rows, &Contribution::name), "component of an input quantity");
  table.texts("quantity", column(rows, &Contribution::quantity), "input quantity");
  table.units(si, column(rows, &Contribution::unit));
  table.numbers("estimate", column(rows, &Contribution::estimate), common_units(si), "estimate of the quantity");
  table.numbers("standard_uncertainty", column(rows, &Contribution::standard_uncertainty), common_units(si),
                "standard uncertainty, NaN where none exists");
  table.texts("evaluation", column(rows, [](const Contribution& c) { return std::string(1, c.evaluation); }),
              "Type A or Type B evaluation");
  table.texts("distribution", column(rows, &Contribution::distribution), "distribution");
  table.numbers("degrees_of_freedom", column(rows, &Contribution::degrees_of_freedom), "1",
                "degrees of freedom, 0 for infinite");
  table.numbers("differentiable", column(rows, [](const Contribution& c) { return c.differentiable ? 1 : 0; }), "1",
                "1 where the measurand has a derivative at the estimate");
  table.numbers("sensitivity", column(rows, &Contribution::sensitivity), "output units / units",
                "sensitivity coefficient, NaN where not differentiable");
  table.numbers("contribution", column(rows, &Contribution::contribution), budget.output.si_unit,
                "contribution to the combined standard uncertainty");
  table.numbers("share", column(rows, &Contribution::share), "1", "share of the combined variance, GUM framework");
  table.numbers("monte_carlo_share", column(rows, &Contribution::monte_carlo_share), "1",
                "first-order share of the Monte Carlo variance, NaN if not computed");
  table.texts("scope", column(rows, &Contribution::scope), "scope of one draw");
  table.texts("source", column(rows, &Contribution::source), "source");
}

void write_validation(hid_t file, const std::vector<Validation>& rows) {
  const hdf5::Handle group = hdf5::create_group(file, "validation");
  Table table(group, "output", rows.size());
  const auto si = column(rows, [](const Validation& v) { return v.output.si_unit; });
  const std::string units = common_units(si);
  table.texts("name", column(rows, [](const Validation& v) { return v.output.name; }), "output");
  table.units(si, column(rows, [](const Validation& v) { return v.output.unit; }));
  table.numbers("delta", column(rows, &Validation::delta), units, "numerical tolerance, JCGM 101 clause 7.9.2");
  table.numbers("d_low", column(rows, &Validation::d_low), units, "distance of the lower ends, JCGM 101 clause 8");
  table.numbers("d_high", column(rows, &Validation::d_high), units, "distance of the upper ends, JCGM 101 clause 8");
  table.numbers("monte_carlo_tolerance", column(rows, &Validation::monte_carlo_tolerance), units,
                "Monte Carlo tolerance, must be below delta / 5");
  table.numbers("digits", column(rows, &Validation::digits), "1", "significant digits of u regarded as meaningful");
  table.texts("verdict", column(rows, &Validation::verdict), "verdict on the GUM framework");
  table.texts("reason", column(rows, &Validation::reason), "reason of the verdict");
}

void write_comparison(hid_t file, const std::vector<ComparisonResult>& rows) {
  const hdf5::Handle group = hdf5::create_group(file, "comparison");
  Table table(group, "comparison", rows.size());
  const auto si = column(rows, &ComparisonResult::si_unit);
  const std::string units = common_units(si);
  table.texts("name", column(rows, &ComparisonResult::name), "comparison");
  table.texts("a", column(rows, &ComparisonResult::a), "output a");
  table.texts("b", column(rows, &ComparisonResult::b), "output b");
  table.units(si, column(rows, &ComparisonResult::unit));
  table.numbers("difference", column(rows, &ComparisonResult::difference), units, "d = a - b");
  table.numbers("standard_uncertainty", column(rows, &ComparisonResult::standard_uncertainty), units,
                "standard uncertainty of d, from joint samples");
  table.numbers("root_sum_square", column(rows, &ComparisonResult::root_sum_square), units,
                "what ignoring common inputs would give");
  table.numbers("expanded_uncertainty", column(rows, &ComparisonResult::expanded_uncertainty), units,
                "U(d): half the shortest coverage interval");
  table.numbers("normalised_error", column(rows, &ComparisonResult::normalised_error), "1", "E_n = d / U(d)");
}

void write_printed(hid_t file, const std::vector<PrintedResult>& rows) {
  const hdf5::Handle group = hdf5::create_group(file, "printed");
  Table table(group, "result", rows.size());
  const auto si = column(rows, &PrintedResult::si_unit);
  const std::string units = common_units(si);
  table.texts("output", column(rows, &PrintedResult::output), "output");
  table.texts("source", column(rows, &PrintedResult::source), "where it is printed");
  table.units(si, column(rows, &PrintedResult::unit));
  table.numbers("printed", column(rows, &PrintedResult::printed), units, "printed value");
  table.numbers("ours", column(rows, &PrintedResult::ours), units, "our estimate");
  table.numbers("expanded_uncertainty", column(rows, &PrintedResult::expanded_uncertainty), units,
                "expanded uncertainty of ours");
}

} // namespace

void write_list(hid_t file, const std::string& name, const std::vector<std::string>& texts, const char* long_name) {
  if (texts.empty()) return;
  const hdf5::Handle dataset = hdf5::create_dataset(file, name, hdf5::text_type(), {texts.size()}, "1", long_name);
  hdf5::write_texts(dataset, texts);
  hdf5::make_scale(dataset, name);
}

void write_budgets(hid_t file, const std::string& name, const std::vector<Budget>& budgets) {
  write_numbered(file, name, budgets, write_budget);
}

void write_results(hid_t file, const Results& r) {
  write_record(file, r);
  write_readings(file, r);
  write_inputs(file, r.inputs);
  write_summary(file, r);
  write_budgets(file, "budget", r.budgets);
  write_validation(file, r.validations);
  write_sensitivity(file, r);
  write_joint(file, r);
  write_planning(file, r);
  write_comparison(file, r.comparisons);
  write_printed(file, r.printed);
  write_list(file, "failures", r.failures, "samples that have no value, by reason");
  write_list(file, "notes", r.notes, "decisions and warnings a reader must see");
}

} // namespace gumshoe::store
