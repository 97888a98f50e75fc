#include "store/stored_samples.h"

#include <algorithm>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/interrupt.h"
#include "store/identity.h"
#include "store/sample_file.h"

namespace gumshoe::store {

struct StoredSamples::Impl {
  std::string path;
  SampleFile samples;
  std::vector<std::size_t> rows; ///< of the outputs
};

StoredSamples::StoredSamples(const std::string& path, const std::vector<propagation::Output>& outputs)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  try {
    const Record record = read_record(path);
    impl_->samples = SampleFile(RawFile(path, O_RDONLY), record);
    for (const auto& row : rows_of(outputs)) {
      const auto at = std::ranges::find(record.rows, row);
      if (at == record.rows.end()) throw OutputError(fmt::format("outputs/{} is not there", row.first));
      impl_->rows.push_back(static_cast<std::size_t>(at - record.rows.begin()));
    }
  } catch (const OutputError& error) {
    throw InputError(path + ": holds no samples of this scenario", error.problems().front().what);
  }
}

StoredSamples::~StoredSamples() = default;

std::vector<double> StoredSamples::read(std::size_t output, std::uint64_t first, std::uint64_t count) const {
  std::vector<double> values(count);
  impl_->samples.read(impl_->rows.at(output), first, count, values.data());
  return values;
}

std::vector<std::uint8_t> StoredSamples::read_status(std::uint64_t first, std::uint64_t count) const {
  std::vector<std::uint8_t> status(count);
  impl_->samples.read_status(first, count, status.data());
  return status;
}

struct StoredStudyValues::Impl {
  SampleFile values;
};

StoredStudyValues::StoredStudyValues(const std::string& path) : impl_(std::make_unique<Impl>()) {
  try {
    impl_->values = SampleFile::of_studies(RawFile(path, O_RDONLY), read_record(path));
  } catch (const OutputError& error) {
    throw InputError(path + ": holds no values of studies", error.problems().front().what);
  }
}

StoredStudyValues::~StoredStudyValues() = default;

void StoredStudyValues::read(std::uint64_t first, std::uint64_t count, double* values) const {
  impl_->values.read(0, first, count, values);
}

void append_samples(ResultFile& to, const StoredSamples& from, std::size_t outputs, std::uint64_t first,
                    std::uint64_t last) {
  const std::uint64_t part =
      std::max<std::uint64_t>(digest_samples, (std::uint64_t{1} << 18) / std::max<std::size_t>(1, outputs)); // 2 MiB
  while (to.samples_done() < last) {
    stop_if_interrupted();
    const std::uint64_t at = to.samples_done(), count = std::min(part, last - at);
    propagation::ResultBlock block{at, count, {}, from.read_status(at - first, count)};
    block.outputs.reserve(outputs * count);
    for (std::size_t output = 0; output < outputs; ++output) {
      const auto values = from.read(output, at - first, count);
      block.outputs.insert(block.outputs.end(), values.begin(), values.end());
    }
    to.write(block);
  }
}

analysis::StoppingRecord StoredSamples::read_stopping() const {
  analysis::StoppingRecord s;
  const Lock lock(hdf5::library());
  const hdf5::Handle file = open_file(impl_->path, H5F_ACC_RDONLY);
  if (H5Lexists(file, "stopping", H5P_DEFAULT) <= 0) return s;
  const hdf5::Handle stopping = hdf5::open_group(file, "stopping");
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
