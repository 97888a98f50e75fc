#include "store/results_writer.h"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/result_fields.h"
#include "store/field_writer.h"

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
  hdf5::write_attribute(file, "Conventions", std::string("CF-1.11")); // units, long_name, flags
  hdf5::write_attribute(file, "failed", r.failed);
  hdf5::write_attribute(file, "coverage_probability", r.coverage_probability);
  if (r.date.empty()) return;
  hdf5::write_attribute(file, "date", r.date);
  hdf5::write_attribute(file, "host", r.host);
  hdf5::write_attribute(file, "duration", r.duration);
}

void write_readings(hid_t file, const Results& r) {
  const hdf5::Handle group = hdf5::create_group(file, "readings");
  Table table(group, "reading", r.readings.size());
  table.texts("label", column(r.readings, [](const auto& reading) { return label_text(reading.labels); }),
              "label values of the reading");
  table.numbers("repeats", column(r.readings, &quantities::Reading::repeats), "1", "readouts averaged in the reading");
  const auto write_columns = [&](const auto& names, const auto& units, const auto& shown, auto member,
                                 const std::string& what) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::vector<double> values;
      for (const auto& reading : r.readings)
        if (i < (reading.*member).size()) values.push_back((reading.*member)[i]);
      if (values.size() != r.readings.size() || values.empty() || hdf5::has(group, names[i])) continue;
      table.numbers(names[i], values, units[i], what + names[i]);
      write_display(hdf5::own(H5Dopen2(group, names[i].c_str(), H5P_DEFAULT), H5Dclose, "describe a column"), shown[i],
                    units[i]);
    }
  };
  write_columns(r.condition_names, r.condition_units, r.condition_shown, &quantities::Reading::conditions, "condition ");
  write_columns(r.indication_names, r.indication_units, r.indication_shown, &quantities::Reading::indications, "indication ");
}

void write_summary(hid_t file, const std::vector<Summary>& rows) {
  write_table(file, summary_fields, rows);
  const hdf5::Handle group = hdf5::open_group(file, "summary");
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

} // namespace

void write_list(hid_t file, const std::string& name, const std::vector<std::string>& texts, const char* long_name) {
  if (texts.empty()) return;
  const hdf5::Handle dataset = hdf5::create_dataset(file, name, hdf5::text_type(), {texts.size()}, "1", long_name);
  hdf5::write_texts(dataset, texts);
  hdf5::make_scale(dataset, name);
}

void write_budgets(hid_t file, const std::string& name, const std::vector<Budget>& budgets) {
  write_numbered(file, name, budgets, [](hid_t group, const Budget& budget) {
    write_study(group, budget, budget_fields, contribution_fields, budget.contributions);
  });
}

namespace {

/// by_output/NAME/STUDY leads to what STUDY says of that output.
void write_links(hid_t file, const Results& r) {
  const hdf5::Handle all = hdf5::create_group(file, "by_output");
  const auto link = [&](const char* study, const auto& items) {
    for (std::size_t k = 0; k < items.size(); ++k) {
      std::string name = items[k].output.name;
      std::ranges::replace(name, '/', '_');
      if (!hdf5::has(all, name)) hdf5::create_group(all, name);
      const hdf5::Handle one = hdf5::open_group(all, name);
      if (!hdf5::has(one, study)) hdf5::link(one, study, fmt::format("/{}/{:03d}", study, k));
    }
  };
  link("budget", r.budgets);
  link("sensitivity", r.sensitivities);
  link("shapley", r.shapley);
  link("given_data", r.given_data);
  link("morris", r.morris);
  link("dgsm", r.dgsm);
  link("target", r.targets);
}

} // namespace

namespace {

void write_draws(hid_t file, const InputDraws& draws, std::uint64_t samples) {
  const std::size_t n = draws.names.size();
  if (n == 0 || samples == 0) return;
  const hdf5::Handle group = hdf5::create_group(file, "draws");
  Table table(group, "component", n, draws.names);
  table.units(draws.si_units, draws.units);
  const hdf5::Scale sample = hdf5::create_dimension(group, "sample", samples);
  const hdf5::Handle values = hdf5::create_dataset(group, "deviation", H5T_IEEE_F64LE, {n, samples},
                                                   common_units(draws.si_units), "deviation drawn, from the estimate");
  hdf5::attach(values, {&table.scale(), &sample});
  const std::size_t chunk = std::max<std::size_t>(1, (std::size_t{1} << 22) / n);
  std::vector<double> some;
  for (std::uint64_t first = 0; first < samples; first += chunk) {
    const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(chunk, samples - first));
    some.resize(n * count);
    draws.draw(first, count, some.data());
    const hsize_t start[2] = {0, first}, size[2] = {n, count};
    const hdf5::Handle space = hdf5::own(H5Dget_space(values), H5Sclose, "select draws");
    hdf5::require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, size, nullptr), "select draws");
    const hdf5::Handle memory = hdf5::own(H5Screate_simple(2, size, nullptr), H5Sclose, "select draws");
    hdf5::require(H5Dwrite(values, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, some.data()), "write draws");
  }
}

} // namespace

void write_results(hid_t file, const Results& r) {
  write_record(file, r);
  write_readings(file, r);
  write_table(file, equation_fields, r.equations);
  write_table(file, axis_fields, r.axes);
  write_table(file, input_fields, r.inputs);
  write_summary(file, r.summaries);
  write_budgets(file, "budget", r.budgets);
  write_table(file, validation_fields, r.validations);
  write_studies(file, r);
  write_links(file, r);
  write_draws(file, r.draws, r.samples);
  write_table(file, comparison_fields, r.comparisons);
  write_table(file, printed_fields, r.printed);
  write_table(file, predicted_fields, r.predicted);
  write_list(file, "failures", r.failures, "samples that have no value, by reason");
  write_list(file, "notes", r.notes, "decisions and warnings a reader must see");
}

} // namespace gumshoe::store
