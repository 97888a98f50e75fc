#pragma once
/// Interfaces of a run: its blocks of samples, its outputs, and the stores that receive them.
#include <cstdint>
#include <string>
#include <vector>

#include "base/status.h"
#include "quantities/input_quantity.h"

namespace gumshoe::propagation {

/// Model outputs of one block of samples, rows in output order: outputs[row * samples + i], SI.
/// A failed sample has a status and the canonical NaN in every row.
struct ResultBlock {
  std::uint64_t first_sample = 0;
  std::size_t samples = 0;
  std::vector<double> outputs;
  std::vector<std::uint8_t> status;
};

/// Takes blocks in sample order. Propagation owns this interface; files implement it.
class Sink {
public:
  virtual ~Sink() = default;
  virtual void write(const ResultBlock& block) = 0;
};

/// A sink whose samples can be read again and whose size can change, as an adaptive run needs.
class SampleStore : public Sink {
public:
  virtual std::uint64_t samples_done() const = 0;
  virtual std::uint64_t samples() const = 0; ///< capacity
  /// Changes the capacity; samples beyond it are discarded.
  virtual void resize(std::uint64_t samples) = 0;
  /// Values of one output row (SI, NaN where failed), samples [first, first + count).
  virtual std::vector<double> read(std::size_t output, std::uint64_t first, std::uint64_t count) const = 0;
  virtual std::vector<std::uint8_t> read_status(std::uint64_t first, std::uint64_t count) const = 0;
};

/// One row of outputs: a measurand at a reading, or a measurand of a joint evaluation.
struct Output {
  std::string name;      ///< "laser_z" or "laser_z[rod 1, setup 2]"; in a virtual experiment "error of laser_z"
  std::string measurand; ///< name on the model's card
  std::size_t reading = 0; ///< 0 for a joint evaluation
  std::string unit; ///< shown to people
  std::string si_unit;
  quantities::Labels labels{}; ///< labels of the reading; none for a joint evaluation
  bool diagnostic = false;     ///< no measurand, but a figure that says how the evaluation went
};

} // namespace gumshoe::propagation
