#include "store/result_file.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "base/error.h"
#include "store/identity.h"
#include "store/place.h"
#include "store/results_writer.h"
#include "store/table.h"

namespace gumshoe::store {
namespace {

/// Runs `action` and puts the path into whatever OutputError it throws.
template <class Action> auto naming(const std::string& path, Action action) {
  try {
    return action();
  } catch (const OutputError& error) {
    const Problem& p = error.problems().front();
    if (p.what.find(path) != std::string::npos) throw;
    throw OutputError("'" + path + "': " + p.what, p.why, p.remedy);
  }
}

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
  struct Row {
    std::size_t dataset;
    hsize_t reading;
  };
  std::vector<std::string> measurands;
  std::vector<Row> rows;
  std::vector<propagation::Output> outputs;
  std::vector<std::string> labels;
  hdf5::Handle file, marker, status;
  std::vector<hdf5::Handle> datasets;
  std::vector<double> values;              ///< without a file's samples: row * samples + i
  std::vector<std::uint8_t> status_values; ///< the same for the status
  std::uint64_t done = 0, marked = 0;
  std::chrono::steady_clock::time_point marked_at = std::chrono::steady_clock::now();
  bool finished = false;
  std::string remark;

  void plan();
  /// A new file; `before`: the samples so far, which it takes over; `results`: complete with these. HDF5 changes a file
  /// in many writes, between which it is no file to read: so none that stands at the path is changed but in its samples
  /// and its marker, which have their place from the start.
  void create(Impl* before = nullptr, const analysis::Results* results = nullptr);
  bool resume();
  /// Of the same run, with another number of samples, and no file yet.
  std::unique_ptr<Impl> successor(std::uint64_t samples) const;
  void take_over(Impl& before);
  void open_datasets(hid_t from);
  void mark();
  void transfer(bool write, hid_t dataset, hid_t type, int rank, hsize_t reading, hsize_t first, hsize_t count,
                void* data) const;
};

void ResultFile::Impl::plan() {
  for (const auto& output : outputs) {
    if (output.reading >= labels.size()) throw std::logic_error("output of an unknown reading");
    const auto at = std::find(measurands.begin(), measurands.end(), output.measurand);
    rows.push_back({static_cast<std::size_t>(at - measurands.begin()), output.reading});
    if (at == measurands.end()) measurands.push_back(output.measurand);
  }
}

void ResultFile::Impl::create(Impl* before, const analysis::Results* results) {
  const std::string temporary = temporary_name(path);
  const std::uint64_t reserve = (1u << 20) + 65536 * rows.size(); // for what comes last
  if (identity.store_samples) { // once while they are drawn, and once more in the complete file
    const double once =
        static_cast<double>(identity.samples) * (8.0 * static_cast<double>(measurands.size() * labels.size()) + 1);
    require_space(path, (before ? 1 : 2) * once + static_cast<double>(reserve));
  }
  remove_leftovers(path);
  try {
    file = open_file(temporary, H5F_ACC_TRUNC);
    write_identity(file, identity);
    const std::uint64_t none = 0;
    marker = hdf5::create_dataset(file, "samples_done", H5T_STD_U64LE, {1}, "1", "samples written so far");
    hdf5::make_scale(marker, "samples_done");
    hdf5::require(H5Dwrite(marker, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &none), "write the marker");
    if (identity.store_samples) {
      const hdf5::Handle group = hdf5::create_group(file, "outputs");
      const hdf5::Handle sample = hdf5::create_dimension(group, "sample", identity.samples);
      const hdf5::Handle reading = hdf5::create_dataset(group, "reading", hdf5::text_type(), {labels.size()}, "1",
                                                        "label values of the reading");
      hdf5::write_texts(reading, labels);
      hdf5::make_scale(reading, "reading");
      for (std::size_t d = 0; d < measurands.size(); ++d) {
        const auto covered = std::count_if(rows.begin(), rows.end(), [&](const Row& r) { return r.dataset == d; });
        const auto& output =
            *std::find_if(outputs.begin(), outputs.end(), [&](const auto& o) { return o.measurand == measurands[d]; });
        std::string long_name = measurands[d];
        std::replace(long_name.begin(), long_name.end(), '_', ' ');
        const bool holes = static_cast<std::size_t>(covered) < labels.size();
        const hdf5::Handle dataset = hdf5::create_dataset(
            group, measurands[d], H5T_IEEE_F64LE, {labels.size(), identity.samples}, output.si_unit,
            (identity.method == "virtual_experiment" ? "error of " : "") + long_name + ", samples", holes);
        const Display shown = display(output.unit, output.si_unit);
        hdf5::write_attribute(dataset, "display_units", shown.units);
        hdf5::write_attribute(dataset, "display_factor", shown.factor);
        hdf5::write_attribute(dataset, "display_offset", shown.offset);
        hdf5::attach(dataset, 0, reading, "reading");
        hdf5::attach(dataset, 1, sample, "sample");
      }
      const hdf5::Handle flags =
          hdf5::create_dataset(group, "status", H5T_STD_U8LE, {identity.samples}, "1", "why a sample has no value");
      std::vector<std::uint8_t> flag_values;
      std::string flag_meanings;
      for (int k = 0; k < statuses; ++k) {
        flag_values.push_back(static_cast<std::uint8_t>(k));
        flag_meanings += (k ? " " : "") + std::string(status_name(static_cast<Status>(k)));
      }
      hdf5::write_attribute(flags, "flag_values", flag_values);
      hdf5::write_attribute(flags, "flag_meanings", flag_meanings);
      hdf5::attach(flags, 0, sample, "sample");
    }
    hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write the file");
    claim_space(temporary, reserve);
    open_datasets(file);
    if (before) take_over(*before);
    if (results) {
      write_results(file, *results);
      hdf5::write_attribute(file, "complete", 1);
      hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write results");
      finished = true;
    }
    // Only now does it take the place of an older result.
    if (std::rename(temporary.c_str(), path.c_str()) != 0) throw OutputError("cannot take its place");
  } catch (...) {
    datasets.clear();
    status.close();
    marker.close();
    file.close();
    std::remove(temporary.c_str());
    throw;
  }
}

void ResultFile::Impl::take_over(Impl& before) {
  constexpr std::uint64_t chunk = 1u << 18;
  done = std::min(before.done, identity.samples);
  if (!identity.store_samples) {
    for (std::size_t row = 0; row < rows.size(); ++row)
      std::copy_n(before.values.begin() + static_cast<std::ptrdiff_t>(row * before.identity.samples), done,
                  values.begin() + static_cast<std::ptrdiff_t>(row * identity.samples));
    std::copy_n(before.status_values.begin(), done, status_values.begin());
    return;
  }
  std::vector<double> some(chunk);
  std::vector<std::uint8_t> flags(chunk);
  for (std::uint64_t first = 0; first < done; first += chunk) {
    const std::uint64_t count = std::min(chunk, done - first);
    for (const Row& row : rows)
      for (const bool write : {false, true})
        (write ? this : &before)
            ->transfer(write, (write ? this : &before)->datasets[row.dataset], H5T_NATIVE_DOUBLE, 2, row.reading, first,
                       count, some.data());
    before.transfer(false, before.status, H5T_NATIVE_UINT8, 1, 0, first, count, flags.data());
    transfer(true, status, H5T_NATIVE_UINT8, 1, 0, first, count, flags.data());
  }
  mark();
}

bool ResultFile::Impl::resume() {
  hdf5::Handle old = open_file(path, H5F_ACC_RDWR);
  const Stored stored = read_stored(old);
  if (stored.complete || !identity.store_samples || !same_numbers(stored.identity, identity)) return false;
  const std::size_t readings = labels.size();
  const std::uint64_t room = stored.identity.samples;
  try {
    const hdf5::Handle group = hdf5::open_group(old, "outputs");
    for (std::size_t d = 0; d <= measurands.size(); ++d) {
      const bool status = d == measurands.size();
      const hdf5::Handle dataset = hdf5::own(H5Dopen2(group, status ? "status" : measurands[d].c_str(), H5P_DEFAULT),
                                             H5Dclose, "open a dataset");
      const hdf5::Handle space = hdf5::own(H5Dget_space(dataset), H5Sclose, "open a dataset");
      hsize_t shape[2] = {0, 0};
      if (H5Sget_simple_extent_ndims(space) != (status ? 1 : 2)) return false;
      H5Sget_simple_extent_dims(space, shape, nullptr);
      if (status ? shape[0] != room : shape[0] != readings || shape[1] != room) return false;
    }
  } catch (const OutputError&) {
    return false;
  }
  file = std::move(old);
  identity.samples = room;
  done = marked = stored.samples_done;
  open_datasets(file);
  return true;
}

void ResultFile::Impl::open_datasets(hid_t from) {
  const auto open = [](hid_t group, const char* name) {
    return hdf5::own(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, "open a dataset");
  };
  marker = open(from, "samples_done");
  if (!identity.store_samples) {
    values.resize(rows.size() * identity.samples);
    status_values.resize(identity.samples);
    return;
  }
  const hdf5::Handle group = hdf5::open_group(from, "outputs");
  datasets.clear();
  for (const std::string& measurand : measurands) datasets.push_back(open(group, measurand.c_str()));
  status = open(group, "status");
}

std::unique_ptr<ResultFile::Impl> ResultFile::Impl::successor(std::uint64_t samples) const {
  auto next = std::make_unique<Impl>();
  next->path = path;
  next->identity = identity;
  next->identity.samples = samples;
  next->outputs = outputs;
  next->labels = labels;
  next->remark = remark;
  next->plan();
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

void ResultFile::Impl::transfer(bool write, hid_t dataset, hid_t type, int rank, hsize_t reading, hsize_t first,
                                hsize_t count, void* data) const {
  if (count == 0) return;
  const hdf5::Handle space = hdf5::own(H5Dget_space(dataset), H5Sclose, "select samples");
  const hsize_t start[2] = {rank == 2 ? reading : first, first}, size[2] = {rank == 2 ? 1 : count, count};
  hdf5::require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, size, nullptr), "select samples");
  const hdf5::Handle memory = hdf5::own(H5Screate_simple(1, &count, nullptr), H5Sclose, "select samples");
  hdf5::require(write ? H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, data)
                      : H5Dread(dataset, type, memory, space, H5P_DEFAULT, data),
                write ? "write samples" : "read samples");
}

ResultFile::ResultFile(const std::string& path, const Identity& identity,
                       const std::vector<propagation::Output>& outputs, const std::vector<std::string>& reading_labels)
    : impl_(std::make_unique<Impl>()) {
  const Lock lock(hdf5::library());
  survive_size_limit();
  naming(path, [&] {
    impl_->path = destination(path);
    impl_->identity = identity;
    impl_->outputs = outputs;
    impl_->labels = reading_labels;
    impl_->plan();
    bool resumed = false;
    if (!empty_or_absent(impl_->path)) {
      const std::string remedy = "choose another name";
      if (!is_hdf5(impl_->path)) throw OutputError("not overwritten", "it is no result of ours", remedy);
      try {
        resumed = impl_->resume();
      } catch (const OutputError& error) {
        const Problem& p = error.problems().front();
        const std::string reason = p.what + (p.why.empty() ? "" : ", " + p.why);
        if (held_by_another(impl_->path))
          throw OutputError("not overwritten", "another program has it open: " + reason, "wait until it is closed");
        if (dynamic_cast<const NoResult*>(&error) || !was_ours(impl_->path))
          throw OutputError("not overwritten", "it is no result of ours: " + reason, remedy);
        impl_ = impl_->successor(identity.samples);
        impl_->remark = fmt::format("'{}' is a result of ours that cannot be read ({}): the run begins from the start",
                                    path, reason);
      }
    }
    if (!resumed) impl_->create();
  });
}

ResultFile::~ResultFile() {
  const Lock lock(hdf5::library());
  try {
    if (impl_->file && !impl_->finished) impl_->mark();
  } catch (...) { // the marker stays where it was: the file is good up to there
  }
  impl_->datasets.clear();
  impl_->status.close();
  impl_->marker.close();
  impl_->file.close();
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
      block.outputs.size() < f.rows.size() * block.samples || block.status.size() < block.samples)
    throw std::logic_error("blocks must come whole and in sample order");
  if (!f.identity.store_samples) {
    for (std::size_t row = 0; row < f.rows.size(); ++row)
      std::copy_n(block.outputs.begin() + static_cast<std::ptrdiff_t>(row * block.samples), block.samples,
                  f.values.begin() + static_cast<std::ptrdiff_t>(row * f.identity.samples + block.first_sample));
    std::copy_n(block.status.begin(), block.samples,
                f.status_values.begin() + static_cast<std::ptrdiff_t>(block.first_sample));
    f.done += block.samples;
    return;
  }
  const Lock lock(hdf5::library());
  naming(f.path, [&] {
    for (std::size_t row = 0; row < f.rows.size(); ++row)
      f.transfer(true, f.datasets[f.rows[row].dataset], H5T_NATIVE_DOUBLE, 2, f.rows[row].reading, block.first_sample,
                 block.samples, const_cast<double*>(block.outputs.data() + row * block.samples));
    f.transfer(true, f.status, H5T_NATIVE_UINT8, 1, 0, block.first_sample, block.samples,
               const_cast<std::uint8_t*>(block.status.data()));
    f.done += block.samples;
    if (std::chrono::steady_clock::now() - f.marked_at > std::chrono::milliseconds(250)) f.mark();
  });
}

std::vector<double> ResultFile::read(std::size_t output, std::uint64_t first, std::uint64_t count) const {
  const Impl& f = *impl_;
  if (output >= f.rows.size() || first > f.done || count > f.done - first)
    throw std::out_of_range("samples that are not there");
  std::vector<double> values(count);
  if (!f.identity.store_samples) {
    std::copy_n(f.values.begin() + static_cast<std::ptrdiff_t>(output * f.identity.samples + first), count,
                values.begin());
    return values;
  }
  const Lock lock(hdf5::library());
  naming(f.path, [&] {
    f.transfer(false, f.datasets.at(f.rows[output].dataset), H5T_NATIVE_DOUBLE, 2, f.rows[output].reading, first, count,
               values.data());
  });
  return values;
}

std::vector<std::uint8_t> ResultFile::read_status(std::uint64_t first, std::uint64_t count) const {
  const Impl& f = *impl_;
  if (first > f.done || count > f.done - first) throw std::out_of_range("samples that are not there");
  std::vector<std::uint8_t> values(count);
  if (!f.identity.store_samples) {
    std::copy_n(f.status_values.begin() + static_cast<std::ptrdiff_t>(first), count, values.begin());
    return values;
  }
  const Lock lock(hdf5::library());
  naming(f.path, [&] { f.transfer(false, f.status, H5T_NATIVE_UINT8, 1, 0, first, count, values.data()); });
  return values;
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
