#pragma once
/// Rounding for people: GUM 7.2.6.
#include <string>

namespace gumshoe::analysis {

/// Decimals at which `uncertainty` shows two significant digits; below 0 for 100 and more (1234: -2, shown as 1200); 6
/// if it is zero or no number.
int decimals_for(double uncertainty);
/// "-509.8661" with that many decimals; below 0: rounded to tens, hundreds, ...
std::string fixed(double value, int decimals);

} // namespace gumshoe::analysis
