#pragma once
/// What a run is and where its samples go.
#include <cstdint>
#include <string>
#include <vector>

namespace gumshoe::propagation {

/// Why a sample has no value. Kept by index, written to the file as CF flags, never dropped silently.
enum class Status : std::uint8_t {
  ok = 0,
  never_covered = 1, ///< the beam can never be covered that much
  not_converged = 2,
  out_of_domain = 3, ///< a drawn value that the solve reads is impossible: a fillet larger than the rod
  no_solution = 4,   ///< the geometry or the data admit no answer
  not_finite = 5,    ///< the formula has no finite value: a division by zero, the logarithm of a negative number
};

/// "never_covered" and so on, as in files and tables.
const char* status_name(Status status);

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

/// One row of outputs: a measurand at a reading.
struct Output {
  std::string name;      ///< "laser_z" or "laser_z[rod 1, setup 2]"; in a virtual experiment "error of laser_z"
  std::string measurand; ///< by the model's card
  std::size_t reading = 0;
  std::string unit; ///< shown to people
  std::string si_unit;
};

} // namespace gumshoe::propagation
