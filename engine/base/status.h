#pragma once
/// Why a sample has no value: the one list that solvers, models, runs and files share.
#include <cstdint>

namespace gumshoe {

/// Outcome of one sample. Written to result files as CF flags; a number keeps its meaning for ever.
enum class Status : std::uint8_t {
  ok = 0,
  never_covered = 1, ///< the shadow cannot cover the share of the beam at which the trigger fires
  not_converged = 2,
  out_of_domain = 3,   ///< a drawn value is impossible: a fillet larger than the rod
  no_solution = 4,     ///< the geometry or the data admit no answer
  not_finite = 5,      ///< a formula has no finite value: a division by zero, the logarithm of a negative number
  model_failed = 6,    ///< a plugin or a command gives no value
  already_covered = 7, ///< the tool stands in the beam before it moves
};

/// Number of statuses; they are 0 to statuses - 1.
inline constexpr int statuses = 8;

/// The number of a status, as kernels and files hold it.
constexpr std::uint8_t code(Status status) { return static_cast<std::uint8_t>(status); }

/// "never_covered" and so on, as in files and tables.
const char* status_name(Status status);

} // namespace gumshoe
