#pragma once
/// Made-up readings of two rods in eight set-ups at four feeds, with an effect in them and one that is found.
#include <cstddef>
#include <functional>

#include "made/traces.h"

namespace gumshoe::made {

inline constexpr double um = 1e-6, mm = 1e-3, ms = 1e-3;
inline constexpr double noise_u = 0.4 * um;         ///< of a reading
inline constexpr double feeds[] = {4, 20, 60, 120}; ///< mm/min
inline constexpr int setups = 8, first_final = 7;   ///< set-ups 7 and 8 are held out

using Effect = std::function<double(const scenario::Scenario&, std::size_t)>; ///< SI, of a reading

double feed_at(const scenario::Scenario& s, std::size_t reading);
double time_at(const scenario::Scenario& s, std::size_t reading);

/// A standard normal value for each i < 192, in a shuffled order.
double normal(std::size_t i);
/// The scenario, with its readings.
scenario::Scenario rods();
/// The scenario, its residuals and their root mean squares: `there` is in the readings, `found` is subtracted after.
Traced traced_rods(const Effect& there, const Effect& found);

} // namespace gumshoe::made
