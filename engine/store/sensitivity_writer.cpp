#include <fmt/format.h>

#include "store/results_writer.h"
#include "store/table.h"

namespace gumshoe::store {
using namespace analysis;

namespace {

void write_sobol(hid_t parent, const std::string& name, const Sensitivity& sensitivity) {
  const hdf5::Handle group = hdf5::create_group(parent, name);
  hdf5::write_attribute(group, "output", sensitivity.output.name);
  hdf5::write_attribute(group, "base_samples", sensitivity.base_samples);
  hdf5::write_attribute(group, "dropped_rows", sensitivity.dropped_rows);
  const auto& rows = sensitivity.indices;
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
}

} // namespace

void write_sensitivity(hid_t file, const Results& r) {
  const hdf5::Handle indices = hdf5::create_group(file, "sensitivity");
  for (std::size_t k = 0; k < r.sensitivities.size(); ++k)
    write_sobol(indices, fmt::format("{:03d}", k), r.sensitivities[k]);
}

} // namespace gumshoe::store
