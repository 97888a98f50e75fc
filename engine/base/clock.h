#pragma once
/// Clock times as logs write them.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gumshoe {

/// Seconds since 1970-01-01 00:00 (of UTC where the text states a zone, else of the clock), or since midnight where the
/// format has no date. Whole seconds and their fraction are kept apart: differences are exact to the last digit
/// written.
struct Moment {
  std::int64_t seconds = 0;
  double fraction = 0;
  bool zoned = false; ///< the text states its zone
  double since(const Moment& other) const {
    return static_cast<double>(seconds - other.seconds) + (fraction - other.fraction);
  }
};

/// How a clock time is written: "iso" (ISO 8601, 2026-02-03T10:00:00.125Z; a blank may stand for the T, seconds and
/// zone may be left out), "excel" (days since 1899-12-30), or a pattern of %Y %y %m %d %b (Jan, Feb, ...) %H %I %M %S
/// (with or without decimals) %p (AM or PM) %s (seconds since a fixed moment) and %%. A blank stands for any number of
/// blanks, every other character for itself. %y is in 1970 to 2069. A date without hours is its midnight.
class ClockFormat {
public:
  /// Throws InputError: an unknown field, or neither hours, a day nor %s.
  explicit ClockFormat(std::string pattern);
  bool has_date() const;
  /// Nothing if the text is not of this form, or names no moment (February 30).
  std::optional<Moment> parse(std::string_view text) const;
  /// An example of the form: "03.02.2026 10:00:00".
  std::string example() const;

private:
  std::string pattern_;
};

} // namespace gumshoe
