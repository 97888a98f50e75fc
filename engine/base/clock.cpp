#include "base/clock.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

namespace gumshoe {
namespace {

constexpr std::string_view fields = "YymdbHIMSps%";
/// Of %s: any two moments, and the days between them, have a difference.
constexpr std::int64_t last_second = 4'000'000'000'000'000'000;
constexpr std::array<std::string_view, 12> months{"jan", "feb", "mar", "apr", "may", "jun",
                                                  "jul", "aug", "sep", "oct", "nov", "dec"};

/// Reads a text from its front, piece by piece.
class Scanner {
public:
  explicit Scanner(std::string_view text) : text_(text) {}
  bool done() const { return text_.empty(); }
  bool at_digit() const { return !text_.empty() && digit(text_[0]); }
  bool blank() const { return !text_.empty() && (text_[0] == ' ' || text_[0] == '\t'); }
  void skip_blanks() {
    while (blank()) text_.remove_prefix(1);
  }
  bool take(char c) {
    if (text_.empty() || text_[0] != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  /// A whole number of `least` to `most` digits.
  std::optional<int> whole(std::size_t least, std::size_t most) {
    std::size_t n = 0;
    int value = 0;
    while (n < most && n < text_.size() && digit(text_[n])) value = 10 * value + (text_[n++] - '0');
    if (n < least) return std::nullopt;
    text_.remove_prefix(n);
    return value;
  }
  /// Digits after a point or a comma; 0 where there are none.
  double fraction() {
    if (text_.size() < 2 || (text_[0] != '.' && text_[0] != ',') || !digit(text_[1])) return 0;
    text_.remove_prefix(1);
    std::size_t n = 0;
    while (n < text_.size() && digit(text_[n])) ++n;
    const std::string number = "0." + std::string(text_.substr(0, n));
    double value = 0;
    std::from_chars(number.data(), number.data() + number.size(), value);
    text_.remove_prefix(n);
    return value;
  }
  /// A whole number, also below 0.
  std::optional<std::int64_t> seconds() {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc() || value < -last_second || value > last_second) return std::nullopt;
    text_.remove_prefix(static_cast<std::size_t>(stop - text_.data()));
    return value;
  }
  /// Three letters of a month, 1 to 12.
  std::optional<int> month() {
    for (std::size_t i = 0; i < months.size() && text_.size() >= 3; ++i)
      if (lower(text_[0]) == months[i][0] && lower(text_[1]) == months[i][1] && lower(text_[2]) == months[i][2]) {
        text_.remove_prefix(3);
        return static_cast<int>(i) + 1;
      }
    return std::nullopt;
  }
  /// True for PM.
  std::optional<bool> afternoon() {
    if (text_.size() < 2 || lower(text_[1]) != 'm' || (lower(text_[0]) != 'a' && lower(text_[0]) != 'p'))
      return std::nullopt;
    const bool pm = lower(text_[0]) == 'p';
    text_.remove_prefix(2);
    return pm;
  }
  /// Offset of the zone in seconds: Z, +02, +02:00, -0530.
  std::optional<int> zone() {
    if (take('Z') || take('z')) return 0;
    const bool west = !text_.empty() && text_[0] == '-';
    if (!take('+') && !take('-')) return std::nullopt;
    const auto hours = whole(2, 2);
    take(':');
    const auto minutes = done() ? std::optional(0) : whole(2, 2);
    constexpr int farthest = 14; // hours: the Line Islands
    if (!hours || !minutes || *hours > farthest || *minutes > 59) return std::nullopt;
    return (west ? -1 : 1) * (*hours * 3600 + *minutes * 60);
  }

private:
  static bool digit(char c) { return c >= '0' && c <= '9'; }
  static char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
  std::string_view text_;
};

struct Fields {
  int year = 1970, month = 1, day = 1, hour = 0, minute = 0, second = 0;
  double fraction = 0;
  std::optional<bool> afternoon = {};
  std::optional<std::int64_t> epoch = {};

  static bool put(int& to, std::optional<int> value) {
    to = value.value_or(to);
    return value.has_value();
  }
  bool read_year_of_two(Scanner& in) {
    if (!put(year, in.whole(2, 2))) return false;
    year += year < 70 ? 2000 : 1900;
    return true;
  }
  /// Reads the field of a pattern; false if the text has none here.
  bool read(char field, Scanner& in) {
    switch (field) {
    case 'Y':
      return put(year, in.whole(4, 4));
    case 'y':
      return read_year_of_two(in);
    case 'm':
      return put(month, in.whole(1, 2));
    case 'b':
      return put(month, in.month());
    case 'd':
      return put(day, in.whole(1, 2));
    case 'H':
    case 'I':
      return put(hour, in.whole(1, 2));
    case 'M':
      return put(minute, in.whole(2, 2));
    case 'S':
      return put(second, in.whole(2, 2)) && ((fraction = in.fraction()), true);
    case 'p':
      return (afternoon = in.afternoon()).has_value();
    case 's':
      return (epoch = in.seconds()).has_value() && ((fraction = in.fraction()), true);
    default:
      return in.take('%');
    }
  }
};

std::optional<Moment> moment_of(const Fields& f) {
  using namespace std::chrono;
  const year_month_day date{year{f.year}, month{static_cast<unsigned>(f.month)}, day{static_cast<unsigned>(f.day)}};
  const bool after_midnight = f.hour == 24 && (f.minute > 0 || f.second > 0 || f.fraction > 0);
  if (!date.ok() || f.hour > 24 || after_midnight || f.minute > 59 || f.second > 60)
    return std::nullopt; // a leap second, midnight as 24:00
  return Moment{sys_days{date}.time_since_epoch().count() * std::int64_t{86400} + std::int64_t{3600} * f.hour +
                    std::int64_t{60} * f.minute + f.second,
                f.fraction, false};
}

std::optional<Moment> parse_iso(std::string_view text) {
  Scanner in(text);
  Fields f;
  const auto put = [&](int& field, std::size_t digits) {
    const auto value = in.whole(digits, digits);
    if (value) field = *value;
    return value.has_value();
  };
  if (!put(f.year, 4)) return std::nullopt;
  const bool dashes = in.take('-');
  if (!put(f.month, 2) || (dashes && !in.take('-')) || !put(f.day, 2)) return std::nullopt;
  if (dashes && in.done()) return moment_of(f); // its midnight
  if (!in.take('T') && !in.take('t')) {
    if (!in.blank()) return std::nullopt;
    in.skip_blanks();
  }
  if (!put(f.hour, 2)) return std::nullopt;
  const bool colons = in.take(':');
  if (!put(f.minute, 2)) return std::nullopt;
  if (colons ? in.take(':') : in.at_digit()) {
    if (!put(f.second, 2)) return std::nullopt;
    f.fraction = in.fraction();
  }
  in.skip_blanks();
  auto moment = moment_of(f);
  if (!moment || in.done()) return moment;
  const auto zone = in.zone();
  if (!zone || !in.done()) return std::nullopt;
  moment->seconds -= *zone;
  moment->zoned = true;
  return moment;
}

/// Days since 30 December 1899, which Excel counts as if 1900 were a leap year.
std::optional<Moment> parse_excel(std::string_view text) {
  constexpr std::int64_t day = 86400, epoch = 25569, last = 2'958'465; // 1970-01-01, 9999-12-31
  Scanner in(text);
  const auto days = in.seconds();
  if (!days || *days < 1 || *days > last) return std::nullopt;
  const double rest = in.fraction() * static_cast<double>(day), whole = std::floor(rest);
  if (!in.done()) return std::nullopt;
  return Moment{(*days - epoch) * day + static_cast<std::int64_t>(whole), rest - whole, false};
}

} // namespace

ClockFormat::ClockFormat(std::string pattern) : pattern_(std::move(pattern)) {
  if (pattern_ == "iso" || pattern_ == "excel") return;
  bool moment = false; // of the day, or a day
  for (std::size_t i = 0; i < pattern_.size(); ++i) {
    if (pattern_[i] != '%') continue;
    const char field = ++i < pattern_.size() ? pattern_[i] : ' ';
    if (fields.find(field) == std::string_view::npos)
      throw InputError(fmt::format("'%{}' is no field of a clock time", field),
                       "the fields are %Y %y %m %d %b %H %I %M %S %p %s",
                       "use \"iso\", or a pattern such as \"%d.%m.%Y %H:%M:%S\"");
    moment |= field == 'H' || field == 'I' || field == 's' || field == 'd';
  }
  if (!moment)
    throw InputError(fmt::format("'{}' is no form of a clock time", pattern_), "it has neither hours nor a day",
                     "use \"iso\", or a pattern such as \"%d.%m.%Y %H:%M:%S\"");
}

bool ClockFormat::has_date() const {
  return pattern_ == "iso" || pattern_ == "excel" || pattern_.find("%d") != std::string::npos || pattern_.find("%s") != std::string::npos;
}

std::optional<Moment> ClockFormat::parse(std::string_view text) const {
  if (pattern_ == "iso") return parse_iso(text);
  if (pattern_ == "excel") return parse_excel(text);
  Scanner in(text);
  Fields f;
  for (std::size_t i = 0; i < pattern_.size(); ++i) {
    const char c = pattern_[i];
    if (c == ' ') {
      if (!in.blank()) return std::nullopt;
      in.skip_blanks();
    } else if (c == '%' ? !f.read(pattern_[++i], in) : !in.take(c)) {
      return std::nullopt;
    }
  }
  if (!in.done()) return std::nullopt;
  if (f.epoch) return Moment{*f.epoch, f.fraction, false};
  if (f.afternoon) {
    if (f.hour < 1 || f.hour > 12) return std::nullopt;
    f.hour = f.hour % 12 + (*f.afternoon ? 12 : 0);
  }
  return moment_of(f);
}

std::string ClockFormat::example() const {
  if (pattern_ == "iso") return "2026-02-03T10:00:00";
  if (pattern_ == "excel") return "46056.416667";
  std::string out;
  for (std::size_t i = 0; i < pattern_.size(); ++i) {
    if (pattern_[i] != '%') {
      out += pattern_[i];
      continue;
    }
    switch (pattern_[++i]) {
    case 'Y':
      out += "2026";
      break;
    case 'y':
      out += "26";
      break;
    case 'm':
      out += "02";
      break;
    case 'd':
      out += "03";
      break;
    case 'b':
      out += "Feb";
      break;
    case 'H':
    case 'I':
      out += "10";
      break;
    case 'M':
    case 'S':
      out += "00";
      break;
    case 'p':
      out += "AM";
      break;
    case 's':
      out += "1770112800.0";
      break;
    default:
      out += '%';
    }
  }
  return out;
}

} // namespace gumshoe
