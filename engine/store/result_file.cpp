#include "store/result_file.h"

#include <chrono>
#include <optional>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/progress.h"
#include "propagation/memory_store.h"
#include "store/earlier_result.h"
#include "store/identity.h"
#include "store/origin.h"
#include "store/place.h"
#include "store/results_writer.h"
#include "store/sample_datasets.h"
#include "store/sample_file.h"

namespace gumshoe::store {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t few = std::uint64_t{16} << 20; ///< bytes
/// What a run may lose that is killed.
constexpr auto unmarked = std::chrono::milliseconds(250);

/// Whether so many bytes take a disk less than about a tenth of the time that it took to compute them.
bool disk_keeps_up(std::uint64_t bytes, Clock::duration computed) {
  constexpr double disk = 1e8; // bytes per second
  return static_cast<double>(bytes) / disk < 0.1 * std::chrono::duration<double>(computed).count();
}

/// A power failure may take what the disk does not have yet; digests then show it. So a large file that is soon
/// computed again is not waited for.
bool worth_waiting(std::uint64_t bytes, Clock::duration computed) {
  return bytes < few || disk_keeps_up(bytes, computed);
}

} // namespace

struct ResultFile::Impl {
  const Claim& claim;
  Identity identity;
  std::vector<propagation::Output> outputs;
  std::vector<std::string> labels;
  std::optional<propagation::MemoryStore> early; ///< the samples, before there is a file
  SampleFile samples;                            ///< without rows in a complete file that does not keep them
  SampleFile studies;                            ///< of a shard that has a part of studies
  std::uint64_t study_done = 0;
  std::uint64_t done = 0;
  Clock::time_point begun = Clock::now(), marked_at = begun, synced_at = begun;
  Clock::duration sync_took{};
  std::uint64_t synced_bytes = 0;
  bool finished = false;
  std::string remark;

  Impl(const Claim& where, const Identity& run, const std::vector<propagation::Output>& rows,
       const std::vector<std::string>& readings)
      : claim(where), identity(run), outputs(rows), labels(readings) {}

  /// The samples, all of them in the file.
  const SampleFile& whole() {
    samples.flush();
    return samples;
  }
  std::uint64_t bytes_of(std::uint64_t count) const { return count * (8 * outputs.size() + 1); }
  std::uint64_t reserve() const { return (1u << 20) + 65536 * outputs.size(); } ///< for what comes last
  /// A new run: in memory, if that is enough.
  void begin();
  /// Puts the samples that are in memory into a file.
  void spill();
  /// A new file; `before`: the samples so far, which it takes over; `results`: complete with these. HDF5 changes a file
  /// in many writes, between which it is no file to read: so none that stands at the path is changed but in its
  /// samples, their digests and its marker, which have their place from the start.
  void create(Impl* before = nullptr, const analysis::Results* results = nullptr, int threads = 1);
  Record build(const std::string& name, const analysis::Results* results) const;
  void copy_to(SampleFile& other, std::uint64_t count, int threads);
  void require_room(bool before, bool keeps) const;
  /// Whether the file at the path is an unfinished one of the same run, which then goes on.
  bool resume();
  /// The same run with another number of samples, and no file yet.
  std::unique_ptr<Impl> successor(std::uint64_t count) const;
  void mark();
};

/// All but the samples; closed and sealed.
Record ResultFile::Impl::build(const std::string& name, const analysis::Results* results) const {
  hdf5::Handle file = open_file(name, H5F_ACC_TRUNC);
  Record record = write_identity(file, identity, results != nullptr);
  if (!results || identity.store_samples)
    create_samples(file, outputs, identity.samples, labels, identity.method == "virtual_experiment", record);
  if (identity.study_values > 0) create_study_values(file, identity.study_values, record);
  if (results) write_results(file, *results);
  close_file(file);
  seal(name, record);
  return record;
}

void ResultFile::Impl::begin() {
  if (bytes_of(identity.samples) > few) return create();
  require_room(false, true);
  early.emplace(outputs.size(), identity.samples);
}

void ResultFile::Impl::spill() {
  if (!early) return;
  auto next = successor(identity.samples);
  next->create(this);
  samples = std::move(next->samples);
  studies = std::move(next->studies);
  early.reset();
  marked_at = Clock::now();
}

void ResultFile::Impl::copy_to(SampleFile& other, std::uint64_t count, int threads) {
  if (!early) return whole().copy_to(other, count, threads);
  std::vector<const double*> rows;
  for (std::size_t row = 0; row < outputs.size(); ++row) rows.push_back(early->values(row).data());
  other.write(0, rows, early->status().first(count));
}

/// Samples are written once while they are drawn, and once more into the complete file.
void ResultFile::Impl::require_room(bool before, bool keeps) const {
  const double copies = before ? keeps : 1.0 + identity.store_samples;
  require_space(claim.target(),
                copies * static_cast<double>(bytes_of(identity.samples)) + static_cast<double>(reserve()));
}

void ResultFile::Impl::create(Impl* before, const analysis::Results* results, int threads) {
  const bool keeps = !results || identity.store_samples;
  require_room(before, keeps);
  Draft draft;
  const std::string name = draft.add(claim);
  const Record record = build(name, results);
  claim_space(name, reserve());
  RawFile file(name, O_RDWR);
  if (before) done = std::min(before->done, identity.samples);
  if (keeps) {
    samples = SampleFile(std::move(file), record);
    if (before) before->copy_to(samples, done, threads);
    samples.mark(done, false);
    if (identity.study_values > 0) studies = SampleFile::of_studies(RawFile(name, O_RDWR), record);
  } else {
    file.write(&done, sizeof done, record.places.at("samples_done").offset);
  }
  finished = results != nullptr;
  std::optional<EarlierResult> earlier;
  if (!finished) earlier.emplace(claim.target());
  draft.publish(before &&
                worth_waiting(keeps ? bytes_of(done) : 0, Clock::now() - begun)); // nothing is in it otherwise
  if (earlier)
    earlier->settle();
  else
    EarlierResult::remove(claim.target());
}

bool ResultFile::Impl::resume() {
  const Record record = read_record(claim.target());
  if (record.complete || record.identity.command != identity.command) return false;
  RawFile file(claim.target(), O_RDWR);
  SampleFile old(std::move(file), record);
  const std::uint64_t marked = old.marked();
  if (!same_numbers(record.identity, identity) || record.rows != rows_of(outputs)) {
    if (marked > 0)
      remark = fmt::format("'{}' held {} samples of an unfinished run with other settings; this run replaces it",
                           claim.path(), marked);
    return false;
  }
  samples = std::move(old);
  identity.samples = record.identity.samples;
  done = samples.sound();
  if (identity.study_values > 0) {
    studies = SampleFile::of_studies(RawFile(claim.target(), O_RDWR), record);
    study_done = studies.sound();
  }
  if (done < marked / digest_samples * digest_samples) // the last block may have been cut by the interruption
    remark = fmt::format(
        "'{}' is damaged: of {} samples only the first {} are as they were written; the run goes on from there",
        claim.path(), marked, done);
  return true;
}

std::unique_ptr<ResultFile::Impl> ResultFile::Impl::successor(std::uint64_t count) const {
  auto next = std::make_unique<Impl>(claim, identity, outputs, labels);
  next->identity.samples = count;
  next->remark = remark;
  next->begun = begun;
  return next;
}

/// A sync takes at most about a tenth of the time, however slow the disk.
void ResultFile::Impl::mark() {
  const auto now = Clock::now();
  const Clock::duration passed = now - synced_at;
  const bool durable = disk_keeps_up(bytes_of(done) - synced_bytes, passed) && passed > 10 * sync_took;
  samples.mark(done, durable);
  marked_at = Clock::now();
  if (!durable) return;
  synced_at = marked_at;
  sync_took = marked_at - now;
  synced_bytes = bytes_of(done);
}

ResultFile::ResultFile(const std::string& path, const Identity& identity,
                       const std::vector<propagation::Output>& outputs, const std::vector<std::string>& reading_labels,
                       bool force) {
  const Lock lock(hdf5::library());
  survive_size_limit();
  claim_ = claim_result(path, {identity.command, identity.scenario_file, identity.scenario_hash,
                               identity.scenario_place, force, identity.shard});
  naming(path, [&] {
    impl_ = std::make_unique<Impl>(claim_, identity, outputs, reading_labels);
    if (!resumed()) impl_->begin();
  });
}

/// Whether the run goes on in the file that stands there.
bool ResultFile::resumed() {
  try {
    return impl_->resume();
  } catch (const OutputError&) { // nothing there, or nothing readable that may be replaced
    return false;
  }
}

ResultFile::~ResultFile() {
  try {
    if (impl_->finished || (impl_->early && impl_->done == 0)) return;
    if (impl_->early) {
      const Lock lock(hdf5::library());
      impl_->spill();
    }
    impl_->mark();
    impl_->studies.mark(impl_->study_done, false);
  } catch (...) { // the marker stays where it was: the file is good up to there
  }
}

std::string ResultFile::remark() const { return claim_.remark + impl_->remark; }

std::uint64_t ResultFile::samples_done() const { return impl_->done; }

std::uint64_t ResultFile::samples() const { return impl_->identity.samples; }

void ResultFile::resize(std::uint64_t samples) {
  Impl& f = *impl_;
  if (samples == f.identity.samples) return;
  if (samples <= f.done) { // the file keeps more; the complete one will not
    f.identity.samples = f.done = samples;
    if (f.early) f.early->resize(samples);
    return;
  }
  if (f.early && f.bytes_of(samples) <= few) {
    f.early->resize(samples);
    f.identity.samples = samples;
    return;
  }
  const Lock lock(hdf5::library());
  naming(f.claim.path(), [&] {
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
  naming(f.claim.path(), [&] {
    f.early ? f.early->write(block) : f.samples.write(block);
    f.done += block.samples;
    if (Clock::now() - f.marked_at < unmarked) return;
    const Lock lock(hdf5::library());
    f.spill();
    f.mark();
  });
}

void ResultFile::write_study_values(std::uint64_t first, std::span<const double> values) {
  Impl& f = *impl_;
  if (f.early || first > f.study_done || first + values.size() > f.identity.study_values)
    throw std::logic_error("values of studies must come in order");
  const auto fresh = values.subspan(std::min<std::size_t>(f.study_done - first, values.size()));
  if (fresh.empty()) return;
  naming(f.claim.path(), [&] {
    f.studies.write(f.study_done, {fresh.data()}, std::vector<std::uint8_t>(fresh.size()));
    f.study_done += fresh.size();
    if (Clock::now() - f.marked_at < unmarked) return;
    f.studies.mark(f.study_done, false);
    f.marked_at = Clock::now();
  });
}

std::uint64_t ResultFile::study_values_done() const { return impl_->study_done; }

std::vector<double> ResultFile::read(std::size_t output, std::uint64_t first, std::uint64_t count) const {
  const Impl& f = *impl_;
  if (f.early) return f.early->read(output, first, count);
  if (output >= f.samples.rows() || first > f.done || count > f.done - first)
    throw std::out_of_range("samples that are not there");
  std::vector<double> values(count);
  naming(f.claim.path(), [&] { impl_->whole().read(output, first, count, values.data()); });
  return values;
}

std::vector<std::uint8_t> ResultFile::read_status(std::uint64_t first, std::uint64_t count) const {
  const Impl& f = *impl_;
  if (f.early) return f.early->read_status(first, count);
  if (f.samples.rows() == 0 || first > f.done || count > f.done - first)
    throw std::out_of_range("samples that are not there");
  std::vector<std::uint8_t> status(count);
  naming(f.claim.path(), [&] { impl_->whole().read_status(first, count, status.data()); });
  return status;
}

analysis::Samples ResultFile::view() const {
  const Impl& f = *impl_;
  if (f.early) return analysis::view_of(*f.early);
  naming(f.claim.path(), [&] { impl_->whole(); }); // before several threads read
  const auto column = [&f](std::size_t output) {
    return analysis::Column(
        f.done,
        [&f, output](std::size_t first, std::span<double> out) {
          naming(f.claim.path(), [&] { f.samples.read(output, first, out.size(), out.data()); });
        },
        f.samples.place(output, 0));
  };
  return {column, f.done, [&f](std::size_t first, std::span<std::uint8_t> out) {
            naming(f.claim.path(), [&] { f.samples.read_status(first, out.size(), out.data()); });
          }};
}

void ResultFile::settle() {
  const Lock lock(hdf5::library());
  naming(impl_->claim.path(), [&] {
    impl_->spill();
    impl_->samples.settle(impl_->done);
    if (impl_->study_done > 0) impl_->studies.settle(impl_->study_done);
  });
}

void ResultFile::finish(const analysis::Results& results, int threads) {
  Impl& f = *impl_;
  if (f.done != f.identity.samples) throw std::logic_error("finished before the last sample");
  progress::stage("result file");
  const Lock lock(hdf5::library());
  naming(f.claim.path(), [&] {
    if (!f.early) f.mark();
    auto next = f.successor(f.done);
    next->create(&f, &results, threads);
    std::swap(impl_, next);
  });
}

} // namespace gumshoe::store
