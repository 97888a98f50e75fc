#include "store/sample_datasets.h"

#include <algorithm>
#include <stdexcept>

#include "base/error.h"
#include "base/status.h"
#include "store/table.h"

namespace gumshoe::store {

namespace {

hdf5::Handle open_dataset(hid_t group, const std::string& name, const std::vector<hsize_t>& least, bool exactly) {
  hdf5::Handle dataset = hdf5::own(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open a dataset");
  const hdf5::Handle space = hdf5::own(H5Dget_space(dataset), H5Sclose, "open a dataset");
  hsize_t shape[2] = {0, 0};
  bool fits = H5Sget_simple_extent_ndims(space) == static_cast<int>(least.size());
  if (fits) H5Sget_simple_extent_dims(space, shape, nullptr);
  for (std::size_t k = 0; fits && k < least.size(); ++k)
    fits = exactly ? shape[k] == least[k] : shape[k] >= least[k];
  if (!fits) throw OutputError("outputs/" + name + " has another shape");
  return dataset;
}

/// Reads or writes [first, first + count) of a row; without `row` of a dataset of one dimension.
template <class T, class Transfer>
void transfer(hid_t dataset, const hsize_t* row, hsize_t first, hsize_t count, Transfer action, T* data,
              const char* what) {
  if (count == 0) return;
  const hdf5::Handle space = hdf5::own(H5Dget_space(dataset), H5Sclose, "select samples");
  const hsize_t start[2] = {row ? *row : first, first}, size[2] = {row ? 1 : count, count};
  hdf5::require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, size, nullptr), "select samples");
  const hdf5::Handle memory = hdf5::own(H5Screate_simple(1, &count, nullptr), H5Sclose, "select samples");
  hdf5::require(action(dataset, hdf5::memory_type<std::remove_const_t<T>>(), memory, space, H5P_DEFAULT, data), what);
}

void create_status(hid_t group, hid_t sample, std::uint64_t samples) {
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
  hdf5::attach(flags, 0, sample, "sample");
}

} // namespace

SampleDatasets::SampleDatasets(const std::vector<propagation::Output>& outputs, std::size_t readings)
    : outputs_(outputs), readings_(readings) {
  for (const auto& output : outputs) {
    if (output.reading >= readings) throw std::logic_error("output of an unknown reading");
    const auto at = std::ranges::find(names_, output.measurand);
    rows_.push_back({static_cast<std::size_t>(at - names_.begin()), output.reading});
    if (at == names_.end()) names_.push_back(output.measurand);
  }
}

void SampleDatasets::create(hid_t file, std::uint64_t samples, const std::vector<std::string>& reading_labels,
                            bool of_errors) const {
  const hdf5::Handle group = hdf5::create_group(file, "outputs");
  const hdf5::Handle sample = hdf5::create_dimension(group, "sample", samples);
  const hdf5::Handle reading =
      hdf5::create_dataset(group, "reading", hdf5::text_type(), {readings_}, "1", "label values of the reading");
  hdf5::write_texts(reading, reading_labels);
  hdf5::make_scale(reading, "reading");
  for (std::size_t d = 0; d < names_.size(); ++d) {
    const auto covered = std::ranges::count(rows_, d, &Row::dataset);
    const auto& output = *std::ranges::find(outputs_, names_[d], &propagation::Output::measurand);
    std::string long_name = names_[d];
    std::ranges::replace(long_name, '_', ' ');
    const bool holes = static_cast<std::size_t>(covered) < readings_;
    const hdf5::Handle dataset =
        hdf5::create_dataset(group, names_[d], H5T_IEEE_F64LE, {readings_, samples}, output.si_unit,
                             (of_errors ? "error of " : "") + long_name + ", samples", holes);
    write_display(dataset, output.unit, output.si_unit);
    hdf5::attach(dataset, 0, reading, "reading");
    hdf5::attach(dataset, 1, sample, "sample");
  }
  create_status(group, sample, samples);
}

void SampleDatasets::open(hid_t file, std::uint64_t samples, bool exactly) {
  close();
  const hdf5::Handle group = hdf5::open_group(file, "outputs");
  for (const std::string& name : names_) datasets_.push_back(open_dataset(group, name, {readings_, samples}, exactly));
  status_ = open_dataset(group, "status", {samples}, exactly);
}

void SampleDatasets::close() {
  datasets_.clear();
  status_.close();
}

void SampleDatasets::read(std::size_t output, std::uint64_t first, std::uint64_t count, double* values) const {
  const Row& row = rows_.at(output);
  transfer(datasets_.at(row.dataset), &row.reading, first, count, H5Dread, values, "read samples");
}

void SampleDatasets::read_status(std::uint64_t first, std::uint64_t count, std::uint8_t* status) const {
  transfer(status_, nullptr, first, count, H5Dread, status, "read samples");
}

void SampleDatasets::write(std::size_t output, std::uint64_t first, std::uint64_t count, const double* values) const {
  const Row& row = rows_.at(output);
  transfer(datasets_.at(row.dataset), &row.reading, first, count, H5Dwrite, values, "write samples");
}

void SampleDatasets::write_status(std::uint64_t first, std::uint64_t count, const std::uint8_t* status) const {
  transfer(status_, nullptr, first, count, H5Dwrite, status, "write samples");
}

} // namespace gumshoe::store
