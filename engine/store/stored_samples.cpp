#include "store/stored_samples.h"

#include <algorithm>

#include "base/error.h"
#include "store/identity.h"
#include "store/sample_datasets.h"

namespace gumshoe::store {

struct StoredSamples::Impl {
  hdf5::Handle file;
  SampleDatasets samples;
};

StoredSamples::StoredSamples(const std::string& path, const std::vector<propagation::Output>& outputs,
                             std::uint64_t samples)
    : impl_(std::make_unique<Impl>()) {
  const Lock lock(hdf5::library());
  std::size_t readings = 0;
  for (const auto& output : outputs) readings = std::max(readings, output.reading + 1);
  try {
    impl_->file = open_file(path, H5F_ACC_RDONLY);
    impl_->samples = SampleDatasets(outputs, readings);
    impl_->samples.open(impl_->file, samples);
  } catch (const OutputError& error) {
    throw InputError(path + ": holds no samples of this scenario", error.problems().front().what);
  }
}

StoredSamples::~StoredSamples() {
  const Lock lock(hdf5::library());
  impl_->samples.close();
  impl_->file.close();
}

std::vector<double> StoredSamples::read(std::size_t output, std::uint64_t first, std::uint64_t count) const {
  std::vector<double> values(count);
  const Lock lock(hdf5::library());
  impl_->samples.read(output, first, count, values.data());
  return values;
}

std::vector<std::uint8_t> StoredSamples::read_status(std::uint64_t first, std::uint64_t count) const {
  std::vector<std::uint8_t> status(count);
  const Lock lock(hdf5::library());
  impl_->samples.read_status(first, count, status.data());
  return status;
}

analysis::StoppingRecord StoredSamples::read_stopping() const {
  analysis::StoppingRecord s;
  const Lock lock(hdf5::library());
  if (H5Lexists(impl_->file, "stopping", H5P_DEFAULT) <= 0) return s;
  const hdf5::Handle stopping = hdf5::open_group(impl_->file, "stopping");
  s.rule = hdf5::read_text(stopping, "rule");
  s.digits = static_cast<int>(hdf5::read_integer(stopping, "digits"));
  s.block = hdf5::read_integer(stopping, "block");
  s.jcgm_trials = hdf5::read_integer(stopping, "jcgm_trials");
  s.stein_trials = hdf5::read_integer(stopping, "stein_trials");
  s.trials = hdf5::read_integer(stopping, "trials");
  s.reached = hdf5::read_integer(stopping, "reached") != 0;
  s.statement = hdf5::read_text(stopping, "statement");
  if (H5Lexists(stopping, "tolerance", H5P_DEFAULT) > 0) {
    const hdf5::Handle values = hdf5::own(H5Dopen2(stopping, "tolerance", H5P_DEFAULT), H5Dclose, "open a dataset");
    const hdf5::Handle space = hdf5::own(H5Dget_space(values), H5Sclose, "open a dataset");
    s.tolerance.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    hdf5::require(H5Dread(values, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, s.tolerance.data()),
                  "read the tolerances");
  }
  return s;
}

} // namespace gumshoe::store
