#include "store/stored_results.h"

#include <fmt/format.h>

#include "store/identity.h"

namespace gumshoe::store {
namespace {

using namespace analysis;

void require_rows(bool hold, const char* name) {
  if (!hold) throw OutputError(fmt::format("the dataset '{}' does not have a value for each row", name));
}

/// Sets a member of every row from the dataset named like it.
template <class Row, class Member>
void fill(hid_t group, const char* name, std::vector<Row>& rows, Member Row::*member) {
  if constexpr (std::is_same_v<Member, std::string>) {
    auto texts = hdf5::read_texts(group, name);
    require_rows(texts.size() == rows.size(), name);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].*member = std::move(texts[i]);
  } else {
    const auto numbers = hdf5::read_numbers(group, name);
    require_rows(numbers.size() == rows.size(), name);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].*member = static_cast<Member>(numbers[i]);
  }
}

std::vector<Summary> read_summaries(hid_t file) {
  const hdf5::Handle group = hdf5::open_group(file, "summary");
  if (!hdf5::has(group, "name")) return {};
  const auto name = hdf5::read_texts(group, "name"), measurand = hdf5::read_texts(group, "measurand"),
             unit = hdf5::read_texts(group, "display_units"), si = hdf5::read_texts(group, "units");
  const auto diagnostic = hdf5::read_numbers(group, "diagnostic");
  std::vector<Summary> rows(name.size());
  for (const auto& [texts, key] : {std::pair{&measurand, "measurand"}, {&unit, "display_units"}, {&si, "units"}})
    require_rows(texts->size() == rows.size(), key);
  require_rows(diagnostic.size() == rows.size(), "diagnostic");
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].output = {name[i], measurand[i], 0, unit[i], si[i], {}, diagnostic[i] != 0};
  fill(group, "estimate", rows, &Summary::estimate);
  fill(group, "standard_uncertainty", rows, &Summary::standard_uncertainty);
  fill(group, "standard_uncertainty_se", rows, &Summary::standard_uncertainty_se);
  fill(group, "expanded_uncertainty", rows, &Summary::expanded_uncertainty);
  fill(group, "coverage_factor", rows, &Summary::coverage_factor);
  fill(group, "degrees_of_freedom", rows, &Summary::degrees_of_freedom);
  fill(group, "certificate", rows, &Summary::certificate);
  for (const auto& [key, member] : {std::pair{"symmetric_low", &Interval::low},
                                    {"symmetric_high", &Interval::high},
                                    {"symmetric_low_se", &Interval::low_se},
                                    {"symmetric_high_se", &Interval::high_se}}) {
    const auto numbers = hdf5::read_numbers(group, key);
    require_rows(numbers.size() == rows.size(), key);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].symmetric.*member = numbers[i];
  }
  return rows;
}

Budget read_budget(hid_t group, const propagation::Output& output) {
  Budget out;
  out.output = output;
  out.applicable = hdf5::read_integer(group, "applicable") != 0;
  if (out.applicable) {
    out.combined_standard_uncertainty = hdf5::read_number(group, "combined_standard_uncertainty");
    out.effective_degrees_of_freedom = hdf5::read_number(group, "effective_degrees_of_freedom");
    out.coverage_factor = hdf5::read_number(group, "coverage_factor");
    out.expanded_uncertainty = hdf5::read_number(group, "expanded_uncertainty");
  }
  if (!hdf5::has(group, "name")) return out; // without contributions
  auto& rows = out.contributions;
  rows.resize(hdf5::read_texts(group, "name").size());
  fill(group, "name", rows, &Contribution::name);
  fill(group, "quantity", rows, &Contribution::quantity);
  fill(group, "units", rows, &Contribution::si_unit);
  fill(group, "display_units", rows, &Contribution::unit);
  fill(group, "estimate", rows, &Contribution::estimate);
  fill(group, "standard_uncertainty", rows, &Contribution::standard_uncertainty);
  fill(group, "distribution", rows, &Contribution::distribution);
  fill(group, "degrees_of_freedom", rows, &Contribution::degrees_of_freedom);
  fill(group, "sensitivity", rows, &Contribution::sensitivity);
  fill(group, "contribution", rows, &Contribution::contribution);
  fill(group, "share", rows, &Contribution::share);
  fill(group, "monte_carlo_share", rows, &Contribution::monte_carlo_share);
  fill(group, "source", rows, &Contribution::source);
  const auto evaluation = hdf5::read_texts(group, "evaluation");
  require_rows(evaluation.size() == rows.size(), "evaluation");
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].evaluation = evaluation[i].empty() ? 'B' : evaluation[i][0];
  return out;
}

} // namespace

analysis::Results read_results(const std::string& path) {
  const Lock lock(hdf5::library());
  const hdf5::Handle file = open_file(path, H5F_ACC_RDONLY);
  Results out;
  out.title = hdf5::read_text(file, "title");
  out.coverage_probability = hdf5::read_number(file, "coverage_probability");
  out.scenario_text = hdf5::read_text(file, "scenario_text");
  out.summaries = read_summaries(file);
  if (!hdf5::has(file, "budget")) return out;
  const hdf5::Handle budgets = hdf5::open_group(file, "budget");
  for (std::size_t k = 0; k < out.summaries.size(); ++k)
    if (const std::string place = fmt::format("{:03d}", k); hdf5::has(budgets, place))
      out.budgets.push_back(read_budget(hdf5::open_group(budgets, place), out.summaries[k].output));
  return out;
}

namespace {

/// Those of the last finding.
void read_sizes(hid_t group, StoredTrace& out) {
  if (!hdf5::has(group, "name")) return;
  std::vector<StoredSize> rows(hdf5::read_texts(group, "name").size());
  fill(group, "name", rows, &StoredSize::name);
  fill(group, "labels", rows, &StoredSize::labels);
  fill(group, "display_units", rows, &StoredSize::unit);
  fill(group, "units", rows, &StoredSize::si_unit);
  fill(group, "value", rows, &StoredSize::value);
  fill(group, "standard_uncertainty", rows, &StoredSize::u);
  fill(group, "low", rows, &StoredSize::low);
  fill(group, "high", rows, &StoredSize::high);
  for (StoredSize& one : rows) one.finding = out.findings.back();
  std::ranges::move(rows, std::back_inserter(out.sizes));
}

} // namespace

StoredTrace read_trace(const std::string& path) {
  const Lock lock(hdf5::library());
  const hdf5::Handle file = open_file(path, H5F_ACC_RDONLY), trace = hdf5::open_group(file, "trace"),
                     group = hdf5::open_group(trace, "rms");
  StoredTrace out;
  out.title = hdf5::read_text(file, "title");
  out.verdict = hdf5::read_text(trace, "verdict");
  out.vetoed = hdf5::read_integer(trace, "vetoed") != 0;
  out.rms.unit = hdf5::read_text(group, "display_units");
  out.rms.si_unit = hdf5::read_text(group, "units");
  using R = tracing::Rms;
  for (const auto& [name, member] : {std::pair{"before", &R::before},
                                     {"after", &R::after},
                                     {"noise", &R::noise},
                                     {"holdout_before", &R::holdout_before},
                                     {"holdout_after", &R::holdout_after},
                                     {"holdout_noise", &R::holdout_noise},
                                     {"replicate_floor", &R::replicate_floor}})
    out.rms.*member = hdf5::read_number(group, name);
  if (!hdf5::has(trace, "findings")) return out;
  const hdf5::Handle findings = hdf5::open_group(trace, "findings");
  for (std::size_t k = 0;; ++k) {
    const std::string place = fmt::format("{:03d}", k);
    if (!hdf5::has(findings, place)) return out;
    const hdf5::Handle finding = hdf5::open_group(findings, place);
    out.findings.push_back(hdf5::read_text(finding, "name"));
    if (hdf5::has(finding, "quantities")) read_sizes(hdf5::open_group(finding, "quantities"), out);
  }
}

} // namespace gumshoe::store
