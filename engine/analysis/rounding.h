#pragma once
/// Rounding for people: GUM 7.2.6.
#include <string>

namespace gumshoe::analysis {

/// Decimals at which `uncertainty` shows two significant digits; 0 for 10 and more, 6 at the least sense.
int decimals_for(double uncertainty);
/// "-509.8661" with that many decimals.
std::string fixed(double value, int decimals);

} // namespace gumshoe::analysis
