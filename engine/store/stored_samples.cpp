#include "store/stored_samples.h"

#include "base/error.h"
#include "store/identity.h"

namespace gumshoe::store {

struct StoredSamples::Impl {
  std::string path;
  std::vector<propagation::Output> outputs;
  hdf5::Handle file, group;

  hdf5::Handle open(const std::string& name, const std::vector<hsize_t>& least) const {
    hdf5::Handle dataset = hdf5::own(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open a dataset");
    const hdf5::Handle space = hdf5::own(H5Dget_space(dataset), H5Sclose, "open a dataset");
    hsize_t shape[2] = {0, 0};
    bool fits = H5Sget_simple_extent_ndims(space) == static_cast<int>(least.size());
    if (fits) H5Sget_simple_extent_dims(space, shape, nullptr);
    for (std::size_t k = 0; fits && k < least.size(); ++k) fits = shape[k] >= least[k];
    if (!fits) throw OutputError("outputs/" + name + " has another shape");
    return dataset;
  }

  void read(const std::string& name, hid_t type, std::vector<hsize_t> start, std::vector<hsize_t> size,
            void* data) const {
    std::vector<hsize_t> least;
    for (std::size_t k = 0; k < start.size(); ++k) least.push_back(start[k] + size[k]);
    const hdf5::Handle dataset = open(name, least);
    const hdf5::Handle space = hdf5::own(H5Dget_space(dataset), H5Sclose, "select samples");
    hdf5::require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr),
                  "select samples");
    const hdf5::Handle memory = hdf5::own(H5Screate_simple(1, &size.back(), nullptr), H5Sclose, "select samples");
    hdf5::require(H5Dread(dataset, type, memory, space, H5P_DEFAULT, data), "read samples");
  }
};

StoredSamples::StoredSamples(const std::string& path, const std::vector<propagation::Output>& outputs,
                             std::uint64_t samples)
    : impl_(std::make_unique<Impl>()) {
  const Lock lock(hdf5::library());
  try {
    impl_->path = path;
    impl_->outputs = outputs;
    impl_->file = open_file(path, H5F_ACC_RDONLY);
    impl_->group = hdf5::open_group(impl_->file, "outputs");
    for (const auto& o : outputs) impl_->open(o.measurand, {o.reading + 1, samples});
    impl_->open("status", {samples});
  } catch (const OutputError& error) {
    throw InputError(path + ": holds no samples of this scenario", error.problems().front().what);
  }
}

StoredSamples::~StoredSamples() {
  const Lock lock(hdf5::library());
  impl_->group.close();
  impl_->file.close();
}

std::vector<double> StoredSamples::read(std::size_t output, std::uint64_t first, std::uint64_t count) const {
  std::vector<double> values(count);
  if (count == 0) return values;
  const auto& o = impl_->outputs.at(output);
  const Lock lock(hdf5::library());
  impl_->read(o.measurand, H5T_NATIVE_DOUBLE, {o.reading, first}, {1, count}, values.data());
  return values;
}

std::vector<std::uint8_t> StoredSamples::read_status(std::uint64_t first, std::uint64_t count) const {
  std::vector<std::uint8_t> values(count);
  if (count == 0) return values;
  const Lock lock(hdf5::library());
  impl_->read("status", H5T_NATIVE_UINT8, {first}, {count}, values.data());
  return values;
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
