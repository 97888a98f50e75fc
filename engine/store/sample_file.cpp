#include "store/sample_file.h"

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "base/hash.h"
#include "propagation/parallel.h"

namespace gumshoe::store {

static_assert(std::endian::native == std::endian::little, "files hold numbers as this computer does");

namespace {

/// Most statuses are 0: only the others count.
std::uint64_t digest_of_status(const std::uint8_t* status, std::uint64_t count, std::uint64_t first) {
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < count; ++i)
    if (status[i] != 0) sum += mix64(mix64(first + i) + status[i]);
  return sum;
}

/// Samples that are gathered: 64 KiB of a row, 1 MiB of all.
std::size_t most_gathered(std::size_t rows) { return std::min<std::size_t>(8192, (std::size_t{1} << 17) / rows); }

/// Digest term of a block itself: a place that was never written then has no valid digest.
std::uint64_t empty_digest(std::uint64_t block) { return mix64(~block); }

Span place_of(const Record& record, const std::string& name) {
  const auto at = record.places.find(name);
  if (at == record.places.end()) throw OutputError("it holds no samples");
  return at->second;
}

void require(bool holds) {
  if (!holds) throw OutputError("the record of its samples contradicts itself");
}

/// Calls action(block, first, count) for the parts of [first, first + count) in each digest's block.
template <class Action> void by_block(std::uint64_t first, std::uint64_t count, Action action) {
  for (const std::uint64_t end = first + count; first < end;) {
    const std::uint64_t block = first / digest_samples, next = std::min(end, (block + 1) * digest_samples);
    action(block, first, next - first);
    first = next;
  }
}

} // namespace

std::vector<std::pair<std::string, std::uint64_t>> rows_of(const std::vector<propagation::Output>& outputs) {
  std::vector<std::pair<std::string, std::uint64_t>> rows;
  for (const auto& output : outputs) rows.emplace_back(output.measurand, output.reading);
  return rows;
}

SampleFile::SampleFile(RawFile file, const Record& record) : file_(std::move(file)), samples_(record.identity.samples) {
  for (const auto& [measurand, reading] : record.rows) {
    const Span values = place_of(record, "outputs/" + measurand);
    const std::uint64_t row = 8 * samples_;
    require(samples_ > 0 && values.bytes % row == 0 && reading < values.bytes / row);
    rows_.push_back(values.offset + reading * row);
  }
  require_whole(place_of(record, "outputs/status"), place_of(record, "digests"), place_of(record, "samples_done"));
}

SampleFile SampleFile::of_studies(RawFile file, const Record& record) {
  SampleFile out;
  out.file_ = std::move(file);
  out.samples_ = record.identity.study_values;
  out.has_status_ = false;
  const Span values = place_of(record, "studies/values");
  require(values.bytes == 8 * out.samples_);
  out.rows_.push_back(values.offset);
  out.require_whole({}, place_of(record, "studies/digests"), place_of(record, "studies/values_done"));
  return out;
}

void SampleFile::require_whole(const Span& status, const Span& digests, const Span& marker) {
  require(samples_ > 0 && status.bytes == (has_status_ ? samples_ : 0) && marker.bytes == 8);
  require(digests.bytes == 8 * digest_blocks(samples_) * width());
  status_ = status.offset, digests_at_ = digests.offset, marker_ = marker.offset;
  file_.read(&marked_, 8, marker_);
}

void SampleFile::hold(std::uint64_t blocks) {
  for (std::uint64_t block = held_ + digests_.size() / width(); block < blocks; ++block)
    digests_.insert(digests_.end(), width(), empty_digest(block));
}

void SampleFile::read(std::size_t row, std::uint64_t first, std::uint64_t count, double* values) const {
  file_.read(values, 8 * count, place(row, first));
}

void SampleFile::read_status(std::uint64_t first, std::uint64_t count, std::uint8_t* status) const {
  has_status_ ? file_.read(status, count, status_ + first) : void(std::fill_n(status, count, std::uint8_t{0}));
}

void SampleFile::write(const propagation::ResultBlock& b) {
  std::vector<const double*> rows;
  for (std::size_t row = 0; row < rows_.size(); ++row) rows.push_back(b.outputs.data() + row * b.samples);
  write(b.first_sample, rows, std::span(b.status).first(b.samples));
}

void SampleFile::write(std::uint64_t begin, const std::vector<const double*>& rows,
                       std::span<const std::uint8_t> status) {
  const std::size_t samples = status.size();
  hold(digest_blocks(begin + samples));
  by_block(begin, samples, [&](std::uint64_t block, std::uint64_t first, std::uint64_t count) {
    for (std::size_t row = 0; row < rows_.size(); ++row)
      digest(block, row) += digest64(rows[row] + (first - begin), count, first);
    digest(block, rows_.size()) += digest_of_status(status.data() + (first - begin), count, first);
  });
  Gathered& g = gathered_;
  if (g.most == 0) g.most = most_gathered(std::max<std::size_t>(1, rows_.size()));
  if (begin != g.first + g.count || g.count + samples > g.most) flush();
  if (samples >= g.most) return put(begin, rows, status);
  if (g.count == 0) g.first = begin;
  g.values.resize(rows_.size() * g.most), g.status.resize(g.most);
  for (std::size_t row = 0; row < rows_.size(); ++row)
    std::copy_n(rows[row], samples, &g.values[row * g.most + g.count]);
  std::ranges::copy(status, g.status.begin() + static_cast<std::ptrdiff_t>(g.count));
  g.count += samples;
}

void SampleFile::flush() {
  if (gathered_.count == 0) return;
  std::vector<const double*> rows;
  for (std::size_t row = 0; row < rows_.size(); ++row) rows.push_back(&gathered_.values[row * gathered_.most]);
  put(gathered_.first, rows, std::span(gathered_.status).first(gathered_.count));
  gathered_.count = 0;
}

void SampleFile::put(std::uint64_t first, const std::vector<const double*>& rows,
                     std::span<const std::uint8_t> status) {
  for (std::size_t row = 0; row < rows_.size(); ++row) file_.write(rows[row], 8 * status.size(), place(row, first));
  if (has_status_) file_.write(status.data(), status.size(), status_ + first);
}

void SampleFile::mark(std::uint64_t done, bool durable) {
  flush();
  if (done <= marked_) return;
  const std::uint64_t counted = std::min<std::uint64_t>((digest_blocks(done) - held_) * width(), digests_.size());
  file_.write(digests_.data(), 8 * counted, digests_at_ + 8 * width() * held_);
  if (durable) file_.sync();
  file_.write(&done, 8, marker_);
  marked_ = done;
  const std::uint64_t whole = done / digest_samples - held_; // those blocks do not change any more
  digests_.erase(digests_.begin(), digests_.begin() + static_cast<std::ptrdiff_t>(whole * width()));
  held_ += whole;
}

void SampleFile::settle(std::uint64_t done) {
  mark(done, true);
  file_.sync();
}

std::uint64_t SampleFile::sound() {
  std::uint64_t sound = std::min(marked_, samples_);
  constexpr std::uint64_t blocks = 64, part = blocks * digest_samples;
  std::vector<double> values(part);
  std::vector<std::uint8_t> status(part);
  std::vector<std::uint64_t> written(blocks * width());
  for (std::uint64_t begin = 0; begin < sound; begin += part) {
    const std::uint64_t n = std::min(part, sound - begin), from = begin / digest_samples;
    file_.read(written.data(), 8 * width() * digest_blocks(n), digests_at_ + 8 * width() * from);
    for (std::size_t row = 0; row <= rows_.size(); ++row) {
      row < rows_.size() ? read(row, begin, n, values.data()) : read_status(begin, n, status.data());
      by_block(begin, n, [&](std::uint64_t block, std::uint64_t first, std::uint64_t count) {
        const std::uint64_t found =
            empty_digest(block) + (row < rows_.size() ? digest64(&values[first - begin], count, first)
                                                      : digest_of_status(&status[first - begin], count, first));
        if (found != written[(block - from) * width() + row]) sound = std::min(sound, first);
      });
    }
  }
  marked_ = sound;
  held_ = sound / digest_samples;
  digests_.clear();
  if (sound % digest_samples == 0) return sound;
  digests_.resize(width());
  file_.read(digests_.data(), 8 * width(), digests_at_ + 8 * width() * held_);
  return sound;
}

void SampleFile::copy_to(SampleFile& other, std::uint64_t count, int threads) const {
  constexpr std::uint64_t part = std::uint64_t{1} << 20;
  const auto copy = [&](std::uint64_t from, std::uint64_t to, std::uint64_t length) {
    propagation::parallel_for((length + part - 1) / part, threads, [&](std::size_t i) {
      thread_local std::vector<char> bytes(part);
      const std::uint64_t at = i * part, n = std::min(part, length - at);
      file_.read(bytes.data(), n, from + at);
      other.file_.write(bytes.data(), n, to + at);
    });
  };
  for (std::size_t row = 0; row < rows_.size(); ++row) copy(place(row, 0), other.place(row, 0), 8 * count);
  copy(status_, other.status_, count);
  const std::uint64_t whole = count / digest_samples, there = std::min(whole, held_);
  copy(digests_at_, other.digests_at_, 8 * width() * there);
  other.file_.write(digests_.data(), 8 * width() * (whole - there), other.digests_at_ + 8 * width() * there);
  other.held_ = whole;
  other.digests_.clear();
  const std::uint64_t first = count / digest_samples * digest_samples, rest = count - first;
  if (rest == 0) return;
  propagation::ResultBlock last{first, rest, std::vector<double>(rows_.size() * rest), std::vector<std::uint8_t>(rest)};
  for (std::size_t row = 0; row < rows_.size(); ++row) read(row, first, rest, &last.outputs[row * rest]);
  read_status(first, rest, last.status.data());
  other.write(last);
}

} // namespace gumshoe::store
