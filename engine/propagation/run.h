#pragma once
/// What a run is and where its samples go.
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

/// A sink that gives back what it took and changes its size: what an adaptive run needs.
class SampleStore : public Sink {
public:
  virtual std::uint64_t samples_done() const = 0;
  virtual std::uint64_t samples() const = 0; ///< room for so many
  /// Room for `samples`; values beyond are given up.
  virtual void resize(std::uint64_t samples) = 0;
  /// Values of one output row (SI, NaN where failed), samples [first, first + count).
  virtual std::vector<double> read(std::size_t output, std::uint64_t first, std::uint64_t count) const = 0;
  virtual std::vector<std::uint8_t> read_status(std::uint64_t first, std::uint64_t count) const = 0;
};

/// One row of outputs: a measurand at a reading, or of a joint evaluation.
struct Output {
  std::string name;      ///< "laser_z" or "laser_z[rod 1, setup 2]"; in a virtual experiment "error of laser_z"
  std::string measurand; ///< by the model's card
  std::size_t reading = 0; ///< 0 of a joint evaluation
  std::string unit; ///< shown to people
  std::string si_unit;
  quantities::Labels labels{}; ///< of the reading; none of a joint evaluation
};

} // namespace gumshoe::propagation
