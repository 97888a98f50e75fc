#pragma once
/// [conditions]: what was commanded, for all readings alike or one value a reading.
#include "scenario/reader.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

/// A scenario has no more.
inline constexpr std::int64_t most_readings = 100'000;

/// What one reading was taken under. Conditions that differ between readings are labels too: "start_angle 30 deg".
struct Commanded {
  quantities::Labels labels;
  std::vector<double> values; ///< SI, by position in the model's card, defaults filled in
};

struct Conditions {
  std::vector<Commanded> readings; ///< at least one
  std::vector<Spread> spreads;
  bool listed = false; ///< one value a reading
};

/// "30 mm/min": what a label says that names a condition.
std::string condition_text(double value, const VariableCard& card);

/// Shape of one condition.
Shape condition_shape();

/// A value ("30 mm/min"), a list of values, one a reading, or { spread = [first, last], readings = n }: n values evenly
/// from first on, last excluded. Lists go side by side and are of one length.
Conditions read_conditions(std::optional<Table> table, const ModelCard& model);

/// n readings instead of those there are, their conditions spread anew; all else is as in the first reading, its other
/// labels included. For a virtual experiment: what was read is dropped. Without a spread the readings are labelled as
/// repeats.
void take_readings(Scenario& scenario, const ModelCard& model, std::size_t n);

/// Makes `alone` what `all` is at one reading: the reading itself, and whatever is stated by reading. Everything else
/// is left as it is, so that `alone` is a copy of `all`, taken once for any number of readings.
void narrow_to_reading(Scenario& alone, const Scenario& all, std::size_t reading);

/// Loadings of the stated effects at the readings as they are now, after their conditions or the columns of [trace]
/// changed. NaN where a table has no value. What reads columns is left as it is where these have no value at every
/// reading.
void update_loadings(Scenario& scenario);

} // namespace gumshoe::scenario
