#include "store/result_file.h"

#include <chrono>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "base/error.h"
#include "propagation/memory_store.h"
#include "store/identity.h"
#include "store/place.h"
#include "store/results_writer.h"
#include "store/sample_datasets.h"

namespace gumshoe::store {
namespace {

bool empty_or_absent(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (!file) return true; // destination() has checked the permissions
  const bool empty = std::fgetc(file) == EOF;
  std::fclose(file);
  return empty;
}

} // namespace

struct ResultFile::Impl {
  std::string path;
  Identity identity;
  std::vector<propagation::Output> outputs;
  std::vector<std::string> labels;
  hdf5::Handle file, marker;
  SampleDatasets samples;
  std::optional<propagation::MemoryStore> memory; ///< the samples of a file that does not keep them
  std::uint64_t done = 0, marked = 0;
  std::chrono::steady_clock::time_point marked_at = std::chrono::steady_clock::now();
  bool finished = false;
  std::string remark;

  Impl(std::string where, const Identity& run, const std::vector<propagation::Output>& rows,
       const std::vector<std::string>& readings)
      : path(std::move(where)), identity(run), outputs(rows), labels(readings), samples(rows, readings.size()) {}

  /// A new file; `before`: the samples so far, which it takes over; `results`: complete with these. HDF5 changes a file
  /// in many writes, between which it is no file to read: so none that stands at the path is changed but in its samples
  /// and its marker, which have their place from the start.
  void create(Impl* before = nullptr, const analysis::Results* results = nullptr);
  /// Whether the file at the path is an unfinished one of the same run, which then goes on.
  bool resume();
  /// The same run with another number of samples, and no file yet.
  std::unique_ptr<Impl> successor(std::uint64_t count) const;
  void take_over(Impl& before);
  void open_samples();
  void mark();
  void close();
};

void ResultFile::Impl::create(Impl* before, const analysis::Results* results) {
  const std::uint64_t reserve = (1u << 20) + 65536 * outputs.size(); // for what comes last
  if (identity.store_samples) { // once while they are drawn, and once more in the complete file
    const double once =
        static_cast<double>(identity.samples) * (8.0 * static_cast<double>(samples.measurands() * labels.size()) + 1);
    require_space(path, (before ? 1 : 2) * once + static_cast<double>(reserve));
  }
  remove_leftovers(path);
  try {
    replace_file(path, [&](const std::string& temporary) {
      file = open_file(temporary, H5F_ACC_TRUNC);
      write_identity(file, identity);
      if (identity.store_samples)
        samples.create(file, identity.samples, labels, identity.method == "virtual_experiment");
      hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write the file");
      claim_space(temporary, reserve);
      open_samples();
      if (before) take_over(*before);
      if (!results) return;
      write_results(file, *results);
      hdf5::write_attribute(file, "complete", 1);
      hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write results");
      finished = true;
    });
  } catch (...) {
    close();
    throw;
  }
}

void ResultFile::Impl::open_samples() {
  marker = hdf5::own(H5Dopen2(file, "samples_done", H5P_DEFAULT), H5Dclose, "open a dataset");
  if (identity.store_samples)
    samples.open(file, identity.samples);
  else
    memory.emplace(outputs.size(), identity.samples);
}

void ResultFile::Impl::take_over(Impl& before) {
  done = std::min(before.done, identity.samples);
  if (memory) {
    memory = std::move(before.memory);
    if (memory->samples() != identity.samples) memory->resize(identity.samples);
    return;
  }
  constexpr std::uint64_t chunk = 1u << 18;
  std::vector<double> some(chunk);
  std::vector<std::uint8_t> flags(chunk);
  for (std::uint64_t first = 0; first < done; first += chunk) {
    const std::uint64_t count = std::min(chunk, done - first);
    for (std::size_t output = 0; output < outputs.size(); ++output) {
      before.samples.read(output, first, count, some.data());
      samples.write(output, first, count, some.data());
    }
    before.samples.read_status(first, count, flags.data());
    samples.write_status(first, count, flags.data());
  }
  mark();
}

bool ResultFile::Impl::resume() {
  hdf5::Handle old = open_file(path, H5F_ACC_RDWR);
  const Stored stored = read_stored(old);
  if (stored.complete || !identity.store_samples || !same_numbers(stored.identity, identity)) return false;
  try {
    samples.open(old, stored.identity.samples, true);
  } catch (const OutputError&) {
    samples.close();
    return false;
  }
  file = std::move(old);
  identity.samples = stored.identity.samples;
  done = marked = stored.samples_done;
  open_samples();
  return true;
}

std::unique_ptr<ResultFile::Impl> ResultFile::Impl::successor(std::uint64_t count) const {
  auto next = std::make_unique<Impl>(path, identity, outputs, labels);
  next->identity.samples = count;
  next->remark = remark;
  return next;
}

/// The marker follows the data: both reach the operating system, in this order.
void ResultFile::Impl::mark() {
  marked_at = std::chrono::steady_clock::now();
  if (marked == done || !identity.store_samples) return;
  hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write samples");
  hdf5::require(H5Dwrite(marker, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &done), "write the marker");
  hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write the marker");
  marked = done;
}

void ResultFile::Impl::close() {
  samples.close();
  marker.close();
  file.close();
}

ResultFile::ResultFile(const std::string& path, const Identity& identity,
                       const std::vector<propagation::Output>& outputs,
                       const std::vector<std::string>& reading_labels) {
  const Lock lock(hdf5::library());
  survive_size_limit();
  naming(path, [&] {
    impl_ = std::make_unique<Impl>(destination(path), identity, outputs, reading_labels);
    if (empty_or_absent(impl_->path) || !resumed(path)) impl_->create();
  });
}

/// Whether the run goes on in the file that stands there. Throws OutputError if it must not be overwritten.
bool ResultFile::resumed(const std::string& path) {
  const std::string remedy = "choose another name";
  if (!is_hdf5(impl_->path)) throw OutputError("not overwritten", "it is not a Gumshoe result", remedy);
  try {
    return impl_->resume();
  } catch (const OutputError& error) {
    const Problem& p = error.problems().front();
    const std::string reason = p.what + (p.why.empty() ? "" : ", " + p.why);
    if (held_by_another(impl_->path))
      throw OutputError("not overwritten", "another program has it open: " + reason, "wait until it is closed");
    if (dynamic_cast<const NoResult*>(&error) || !was_ours(impl_->path))
      throw OutputError("not overwritten", "it is not a Gumshoe result: " + reason, remedy);
    impl_ = impl_->successor(impl_->identity.samples);
    impl_->remark = fmt::format("'{}' is a Gumshoe result that cannot be read ({}); the run starts from the beginning",
                                path, reason);
    return false;
  }
}

ResultFile::~ResultFile() {
  const Lock lock(hdf5::library());
  try {
    if (impl_->file && !impl_->finished) impl_->mark();
  } catch (...) { // the marker stays where it was: the file is good up to there
  }
  impl_->close();
}

std::string ResultFile::remark() const { return impl_->remark; }

std::uint64_t ResultFile::samples_done() const { return impl_->done; }

std::uint64_t ResultFile::samples() const { return impl_->identity.samples; }

void ResultFile::resize(std::uint64_t samples) {
  Impl& f = *impl_;
  if (samples == f.identity.samples) return;
  if (samples <= f.done && f.identity.store_samples) { // the file keeps more; the complete one will not
    f.identity.samples = f.done = samples;
    return;
  }
  const Lock lock(hdf5::library());
  naming(f.path, [&] {
    auto next = f.successor(samples);
    next->create(&f);
    std::swap(impl_, next);
  });
}

void ResultFile::write(const propagation::ResultBlock& block) {
  Impl& f = *impl_;
  if (f.finished || block.first_sample != f.done || block.first_sample + block.samples > f.identity.samples ||
      block.outputs.size() < f.outputs.size() * block.samples || block.status.size() < block.samples)
    throw std::logic_error("blocks must come whole and in sample order");
  if (f.memory) {
    f.memory->write(block);
    f.done += block.samples;
    return;
  }
  const Lock lock(hdf5::library());
  naming(f.path, [&] {
    for (std::size_t output = 0; output < f.outputs.size(); ++output)
      f.samples.write(output, block.first_sample, block.samples, block.outputs.data() + output * block.samples);
    f.samples.write_status(block.first_sample, block.samples, block.status.data());
    f.done += block.samples;
    if (std::chrono::steady_clock::now() - f.marked_at > std::chrono::milliseconds(250)) f.mark();
  });
}

std::vector<double> ResultFile::read(std::size_t output, std::uint64_t first, std::uint64_t count) const {
  const Impl& f = *impl_;
  if (f.memory) return f.memory->read(output, first, count);
  if (output >= f.outputs.size() || first > f.done || count > f.done - first)
    throw std::out_of_range("samples that are not there");
  std::vector<double> values(count);
  const Lock lock(hdf5::library());
  naming(f.path, [&] { f.samples.read(output, first, count, values.data()); });
  return values;
}

std::vector<std::uint8_t> ResultFile::read_status(std::uint64_t first, std::uint64_t count) const {
  const Impl& f = *impl_;
  if (f.memory) return f.memory->read_status(first, count);
  if (first > f.done || count > f.done - first) throw std::out_of_range("samples that are not there");
  std::vector<std::uint8_t> status(count);
  const Lock lock(hdf5::library());
  naming(f.path, [&] { f.samples.read_status(first, count, status.data()); });
  return status;
}

void ResultFile::finish(const analysis::Results& results) {
  Impl& f = *impl_;
  if (f.done != f.identity.samples) throw std::logic_error("finished before the last sample");
  const Lock lock(hdf5::library());
  naming(f.path, [&] {
    f.mark();
    auto next = f.successor(f.done);
    next->create(&f, &results);
    std::swap(impl_, next);
  });
}

} // namespace gumshoe::store
