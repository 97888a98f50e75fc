#include "store/sample_datasets.h"

#include <algorithm>
#include <stdexcept>

#include "base/error.h"
#include "base/status.h"
#include "store/sample_file.h"
#include "store/table.h"

namespace gumshoe::store {

namespace {

void create_status(hid_t group, const hdf5::Scale& sample, std::uint64_t samples) {
  const hdf5::Handle flags =
      hdf5::create_dataset(group, "status", H5T_STD_U8LE, {samples}, "1", "why a sample has no value");
  std::vector<std::uint8_t> values;
  std::string meanings;
  for (int k = 0; k < statuses; ++k) {
    values.push_back(static_cast<std::uint8_t>(k));
    meanings += (k ? " " : "") + std::string(status_name(static_cast<Status>(k)));
  }
  hdf5::write_attribute(flags, "flag_values", values);
  hdf5::write_attribute(flags, "flag_meanings", meanings);
  hdf5::attach(flags, {&sample});
}

void create_digests(hid_t file, std::uint64_t blocks, std::size_t rows) {
  const hdf5::Scale block = hdf5::create_dimension(file, "digest_block", blocks);
  const hdf5::Scale row = hdf5::create_dimension(file, "digest_row", rows);
  const hdf5::Handle digests = hdf5::create_dataset(file, "digests", H5T_STD_U64LE, {blocks, rows}, "1",
                                                    "digest of each block of samples of each output, the status last");
  hdf5::attach(digests, {&block, &row});
}

} // namespace

void create_study_values(hid_t file, std::uint64_t values, Record& record) {
  const hdf5::Handle group = hdf5::create_group(file, "studies");
  const hdf5::Scale value = hdf5::create_dimension(group, "value", values);
  hdf5::attach(hdf5::create_dataset(group, "values", H5T_IEEE_F64LE, {values}, "1",
                                    "what the model runs of studies gave, for gumshoe merge"),
               {&value});
  create_digests(group, digest_blocks(values), 2);
  create_marker(group, "values_done", "values written so far");
  for (const char* name : {"studies/values", "studies/digests", "studies/values_done"})
    record.places[name] = place_of_dataset(file, name);
}

void create_marker(hid_t parent, const std::string& name, const std::string& meaning) {
  const std::uint64_t none = 0;
  const hdf5::Handle marker = hdf5::create_dataset(parent, name, H5T_STD_U64LE, {1}, "1", meaning);
  hdf5::make_scale(marker, name);
  hdf5::require(H5Dwrite(marker, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &none), "write the marker");
}

Span place_of_dataset(hid_t file, const std::string& path) {
  const hdf5::Handle dataset = hdf5::own(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, "open a dataset");
  const haddr_t offset = H5Dget_offset(dataset);
  hdf5::require(offset == HADDR_UNDEF ? -1 : 0, "find the place of a dataset");
  return {offset, H5Dget_storage_size(dataset)};
}

void create_samples(hid_t file, const std::vector<propagation::Output>& outputs, std::uint64_t samples,
                    const std::vector<std::string>& reading_labels, bool of_errors, Record& record) {
  const std::size_t readings = reading_labels.size();
  const hdf5::Handle group = hdf5::create_group(file, "outputs");
  const hdf5::Scale sample = hdf5::create_dimension(group, "sample", samples);
  hdf5::Handle labels =
      hdf5::create_dataset(group, "reading", hdf5::text_type(), {readings}, "1", "label values of the reading");
  hdf5::write_texts(labels, reading_labels);
  hdf5::make_scale(labels, "reading");
  const hdf5::Scale reading(std::move(labels), "reading");
  std::vector<std::string> paths{"outputs/status", "digests"};
  for (const auto& output : outputs) {
    if (output.reading >= readings) throw std::logic_error("output of an unknown reading");
    const std::string& name = output.measurand;
    if (std::ranges::find(paths, "outputs/" + name) != paths.end()) continue;
    paths.push_back("outputs/" + name);
    const auto covered = std::ranges::count(outputs, name, &propagation::Output::measurand);
    std::string long_name = name;
    std::ranges::replace(long_name, '_', ' ');
    const bool holes = static_cast<std::size_t>(covered) < readings;
    const hdf5::Handle dataset = hdf5::create_dataset(group, name, H5T_IEEE_F64LE, {readings, samples}, output.si_unit,
                                                      (of_errors ? "error of " : "") + long_name + ", samples", holes);
    write_display(dataset, output.unit, output.si_unit);
    hdf5::attach(dataset, {&reading, &sample});
  }
  create_status(group, sample, samples);
  create_digests(file, digest_blocks(samples), outputs.size() + 1);
  record.rows = rows_of(outputs);
  for (const std::string& path : paths) record.places[path] = place_of_dataset(file, path);
}

} // namespace gumshoe::store
