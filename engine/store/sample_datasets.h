#pragma once
/// The group `outputs` of a result file: the samples of every output. Private to this folder; callers hold
/// hdf5::library().
#include <cstdint>
#include <string>
#include <vector>

#include "propagation/run.h"
#include "store/hdf5.h"

namespace gumshoe::store {

class SampleDatasets {
public:
  SampleDatasets() = default;
  /// `readings`: how many the file has, at least as many as the outputs know; throws std::logic_error if there are fewer.
  SampleDatasets(const std::vector<propagation::Output>& outputs, std::size_t readings);

  std::size_t measurands() const { return names_.size(); }

  /// Makes the group, with room for `samples`. `of_errors`: of a virtual experiment.
  void create(hid_t file, std::uint64_t samples, const std::vector<std::string>& reading_labels, bool of_errors) const;
  /// Opens a file's datasets. Throws OutputError if one is missing or too small for the outputs and `samples`; with
  /// `exactly` also if it is larger.
  void open(hid_t file, std::uint64_t samples, bool exactly = false);
  void close();

  /// Samples [first, first + count) of an output, or of the status.
  void read(std::size_t output, std::uint64_t first, std::uint64_t count, double* values) const;
  void read_status(std::uint64_t first, std::uint64_t count, std::uint8_t* status) const;
  void write(std::size_t output, std::uint64_t first, std::uint64_t count, const double* values) const;
  void write_status(std::uint64_t first, std::uint64_t count, const std::uint8_t* status) const;

private:
  /// Where an output stands: a dataset per measurand, a row per reading.
  struct Row {
    std::size_t dataset;
    hsize_t reading;
  };
  std::vector<propagation::Output> outputs_;
  std::vector<std::string> names_; ///< of the datasets
  std::vector<Row> rows_;
  std::size_t readings_ = 0;
  std::vector<hdf5::Handle> datasets_;
  hdf5::Handle status_;
};

} // namespace gumshoe::store
