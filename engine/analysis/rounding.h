#pragma once
/// Rounding for people: GUM 7.2.6.
#include <string>

namespace gumshoe::analysis {

/// Decimals at which `uncertainty` shows two significant digits; below 0 for 100 and more (1234: -2, shown as 1200); 6
/// if it is zero or no number.
int decimals_for(double uncertainty);
/// "-509.8661" with that many decimals; below 0: rounded to tens, hundreds, ...
std::string fixed(double value, int decimals);

/// A difference or an uncertainty with two digits and its unit, smaller than `unit` where that suits it: "0.052 um".
std::string with_suitable_unit(double si, const std::string& unit, const std::string& si_unit);

/// "12 effective degrees of freedom".
std::string effective_freedom(double n);

/// "1 %" or "0.015 %", with the direction of a bound where p is not resolved: "> 99.9997 %", "< 0.0003 %". `least`: a
/// probability or its complement below it is not known.
std::string probability_text(double p, double least);

/// A stated coverage probability in percent: "95 %", "99.999 %". Never 0 % or 100 %.
std::string coverage_text(double p);

/// "97 %" of a whole, in whole percent; "< 1 %" and "> 99 %" for what would round to nothing or to all.
std::string share_text(double share);

} // namespace gumshoe::analysis
