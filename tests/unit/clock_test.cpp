#include <catch2/catch.hpp>

#include "base/clock.h"
#include "base/error.h"

using gumshoe::ClockFormat;

namespace {

double between(const std::string& format, const std::string& from, const std::string& to) {
  const ClockFormat clock(format);
  const auto a = clock.parse(from), b = clock.parse(to);
  REQUIRE(a);
  REQUIRE(b);
  return b->since(*a);
}

} // namespace

TEST_CASE("days of a spreadsheet", "[clock]") {
  // 61 is 1900-03-01: after the leap day that 1900 had not. 45292 is 2024-01-01.
  CHECK(ClockFormat("excel").parse("25569")->seconds == 0);
  CHECK(ClockFormat("excel").parse("45292")->seconds == ClockFormat("iso").parse("2024-01-01T00:00")->seconds);
  CHECK(between("excel", "46056.25", "46056,75") == 43200);
  CHECK(between("excel", "46056.999988426", "46057") == Approx(1).margin(1e-4)); // nine digits of a day: 0.1 ms
  for (const char* wrong : {"", "0.5", "-3", "1e5", "46056.5 ", "46056:30", "99999999"})
    CHECK_FALSE(ClockFormat("excel").parse(wrong));
  CHECK(ClockFormat("excel").has_date());
  CHECK(ClockFormat("excel").parse(ClockFormat("excel").example()));
}

TEST_CASE("clock times of ISO 8601", "[clock]") {
  CHECK(between("iso", "2026-02-03T10:00:00", "2026-02-03T10:00:00.125") == 0.125);
  CHECK(between("iso", "2026-02-28 23:59", "2026-03-01 00:00") == 60);  // no leap year
  CHECK(between("iso", "2024-02-28 23:59", "2024-03-01 00:00") == 86460);
  CHECK(between("iso", "20260203T100000", "20260203T100001,5") == 1.5);
  CHECK(between("iso", "2026-02-03T10:00:00Z", "2026-02-03T12:00:00+02:00") == 0); // one moment in two zones
  CHECK(between("iso", "2026-02-03T10:00:00Z", "2026-02-03T10:00:00-0530") == 5.5 * 3600);
  CHECK(ClockFormat("iso").parse("1970-01-02T00:00:00Z")->seconds == 86400);
  CHECK(between("iso", "2024-02-29", "2024-03-01 00:00") == 86400);
  CHECK(between("iso", "2026-02-03T24:00", "2026-02-04T00:00") == 0);
  for (const char* wrong :
       {"2026-02-30T10:00:00", "2026-02-30", "2026-13-01 10:00", "10:00:00", "20260203", "2026-02-03T",
        "2026-02-03T10:00:00x", "2026-02-03T25:00:00", "2026-02-03T24:30", "2026-02-03T24:00:00.5", "2026-02-03T10:00+15:00",
        "2026-02-03T10:00:00+02:75", "2026-02-03T10:61", "2026-02-03T10:00:", ""})
    CHECK_FALSE(ClockFormat("iso").parse(wrong));
}

TEST_CASE("clock times of patterns", "[clock]") {
  CHECK(between("%d.%m.%Y %H:%M:%S", "3.2.2026 9:59:59", "03.02.2026   10:00:00.25") == 1.25);
  CHECK(between("%m/%d/%y %I:%M:%S %p", "12/31/69 11:59:59 PM", "01/01/70 12:00:00 am") ==
        -(100 * 365.25 * 86400) + 1 + 0 * 86400); // %y: 2069, then 1970: 25 leap years, 1972 to 2068
  CHECK(between("%d-%b-%Y %H:%M", "03-Feb-2026 10:00", "03-MAR-2026 10:00") == 28 * 86400);
  CHECK(between("%s", "1770112800", "1770112800.001") == Approx(0.001).epsilon(1e-12)); // kept apart from the seconds
  CHECK(between("T%H%M%S%%", "T235959%", "T000000%") == -86399);
  CHECK(between("%Y-%m-%d", "2026-02-03", "2026-03-03") == 28 * 86400); // midnight
  CHECK(ClockFormat("%H:%M").has_date() == false);
  CHECK(ClockFormat("%d.%m.%Y %H:%M").has_date());
  CHECK(ClockFormat("%d.%m.%Y %H:%M:%S").example() == "03.02.2026 10:00:00");
  CHECK_FALSE(ClockFormat("%H:%M").parse("10:00:00"));
  CHECK_FALSE(ClockFormat("%I:%M %p").parse("13:00 PM"));
  CHECK_FALSE(ClockFormat("%H:%M").parse("10-00"));
  CHECK_THROWS_WITH(ClockFormat("%Q"), Catch::Contains("'%Q' is no field of a clock time"));
  CHECK_THROWS_WITH(ClockFormat("%Y-%m"),
                    Catch::Contains("is no form of a clock time (it has neither hours nor a day)"));
}
