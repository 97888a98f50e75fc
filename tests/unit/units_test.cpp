#include <cstring>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "base/unit_definition.h"
#include "base/units.h"

using namespace gumshoe;
using units::Kind;

namespace {
constexpr double pi = 3.14159265358979323846;
double si(const char* text, const char* unit, Kind kind = Kind::point) {
  const auto m = units::parse(text);
  return units::to_si(m.number, m.unit, unit, kind);
}
} // namespace

TEST_CASE("decimal units are the nearest double, not a rounded factor", "[units]") {
  CHECK(si("-329.932 mm", "m") == -329.932 / 1000);
  CHECK(si("0.6 um", "m") == 0.6 / 1e6);
  CHECK(si("0.6 \xC2\xB5m", "m") == 0.6 / 1e6);
  CHECK(si("4 mm/min", "m/s") == 4.0 / 60000);
  CHECK(si("8 um/m/K", "1/K") == 8.0 / 1e6);
  CHECK(si("50 %", "1") == 0.5);
  CHECK(si("0.5", "1") == 0.5);
  CHECK(si("1.5 ms", "s") == 1.5 / 1000);
}

TEST_CASE("the table of common units is the database's, to the bit", "[units]") {
  for (const std::string& name : units::common_unit_names()) {
    INFO(name);
    const auto ours = units::common_unit(name), database = units::unit_of_database(name);
    REQUIRE(ours.has_value());
    REQUIRE(database.has_value());
    CHECK(ours->base == database->base);
    CHECK(std::memcmp(&ours->factor, &database->factor, sizeof(double)) == 0);
    CHECK(std::memcmp(&ours->offset, &database->offset, sizeof(double)) == 0);
    CHECK(ours->radians == database->radians);
    CHECK(ours->ratio == database->ratio);
  }
  CHECK_FALSE(units::common_unit("inch"));
}

TEST_CASE("angles", "[units]") {
  // 1 ulp of the factor pi/180; udunits' fifteen printed digits would miss by 4e-15 relative.
  CHECK(si("90 deg", "rad") == Approx(pi / 2).epsilon(3e-16));
  CHECK(si("1 arcsec", "rad") == Approx(pi / 648000).epsilon(3e-16));
  CHECK(si("1000 rpm", "rad/s") == Approx(2 * pi * 1000 / 60).epsilon(5e-16));
  CHECK(si("60 rev/min", "rad/s") == Approx(2 * pi).epsilon(5e-16));
  CHECK(si("8 um/m", "rad") == 8.0 / 1e6); // a small slope is an angle
  CHECK_FALSE(units::convertible("1", "rad"));
  CHECK_FALSE(units::convertible("deg", "1"));
  CHECK_FALSE(units::convertible("mrad", "1"));
  CHECK_FALSE(units::convertible("Hz", "rad/s")); // 2 pi apart
  CHECK_FALSE(units::convertible("deg", "rad/s"));
  CHECK(units::convertible("deg/min", "rad/s"));
}

TEST_CASE("a plain number has no unit behind it", "[units]") {
  CHECK("5" + units::suffix("mm") == "5 mm");
  CHECK("5" + units::suffix("1") == "5");
  CHECK("5" + units::suffix("1/min") == "5 1/min"); // nothing but "1" is a plain number
}

TEST_CASE("units of today's values", "[units]") {
  CHECK(si("1 eV", "J") == Approx(1.602176634e-19).epsilon(1e-14)); // exact since 2019
  CHECK(si("2 keV", "J") == Approx(2 * 1.602176634e-16).epsilon(1e-14));
  CHECK(si("2 electronvolt", "J") == Approx(2 * 1.602176634e-19).epsilon(1e-14));
  CHECK(si("2 kiloelectronvolt", "J") == Approx(2 * 1.602176634e-16).epsilon(1e-14));
  CHECK(si("3 meV", "J") == Approx(3 * 1.602176634e-22).epsilon(1e-14));
  CHECK(si("5 mTorr", "Pa") == Approx(5 * 101.325 / 760).epsilon(1e-14));
  CHECK(si("4 kNm", "J") == 4000);
  CHECK(si("1 u", "kg") == Approx(1.66053906892e-27).epsilon(1e-14)); // CODATA 2022
  CHECK(si("760 torr", "Pa") == Approx(101325).epsilon(1e-14));
  CHECK(si("100 gon", "rad") == Approx(pi / 2).epsilon(5e-16));
  CHECK(si("3 Nm", "J") == 3);
  CHECK(si("2 kWh", "J") == Approx(7.2e6).epsilon(1e-14));
  CHECK(si("1 Ah", "A s") == Approx(3600).epsilon(1e-14));
}

TEST_CASE("what may be two units is none, and it is said what to write", "[units][errors]") {
  for (const char* unit : {"ct", "oz", "gal", "dB"}) CHECK_FALSE(units::convertible(unit, "kg"));
  for (const char* unit : {"oz/m", "m/ct", "dB/km"}) CHECK_THROWS_AS(units::si_unit_of(unit), InputError);
  CHECK_THROWS_WITH(units::to_si(1, "ct", "kg"), Catch::Contains("rite carat"));
  CHECK_THROWS_WITH(units::to_si(1, "Kg", "kg"), Catch::Contains("did you mean 'kg'?", Catch::CaseSensitive::No));
  CHECK_THROWS_WITH(units::to_si(1, "KHz", "1/s"), Catch::Contains("did you mean 'kHz'?", Catch::CaseSensitive::No));
}

TEST_CASE("constants that are units have the values of the SI since 2019, whatever their name", "[units]") {
  CHECK(si("1 e", "A s") == Approx(1.602176634e-19).epsilon(1e-14));
  CHECK(si("1 amu", "kg") == si("1 u", "kg"));
  CHECK(si("1 AMU", "kg") == si("1 u", "kg"));
  CHECK(si("2 electronvolts", "J") == Approx(2 * 1.602176634e-19).epsilon(1e-14));
  CHECK(si("2 kiloelectronvolts", "J") == Approx(2 * 1.602176634e-16).epsilon(1e-14));
  CHECK(si("1 molecule", "mol") == Approx(1 / 6.02214076e23).epsilon(1e-14));
  CHECK(si("3 1e-6", "1") == 3e-6); // its e is no charge
}

TEST_CASE("names that begin like a prefix are what people mean by them", "[units]") {
  CHECK(si("1 nmi", "m") == 1852);
  CHECK(si("1 mph", "m/s") == Approx(0.44704).epsilon(1e-14));
  CHECK(si("36 kph", "m/s") == Approx(10).epsilon(1e-14));
  CHECK(si("1 ha", "m2") == 10000);
  CHECK(si("1 t", "kg") == 1000);
  CHECK(si("1 tonne", "kg") == 1000);
  CHECK(si("3 uin", "m") == Approx(3 * 25.4e-9).epsilon(1e-14)); // of surfaces; no other prefix goes with the inch
  CHECK(si("3 Kilometer", "m") == 3000);
  CHECK(si("2 cmH2O", "Pa") == Approx(196.133).epsilon(1e-14));
  CHECK(si("4 m\xC2\xB2", "m2") == 4);
  CHECK(si("4 N\xC2\xB7m", "J") == 4);
  CHECK(si("9 mdeg", "deg") == Approx(0.009).epsilon(1e-14));
  CHECK(si("10 mgon", "deg") == Approx(0.009).epsilon(1e-14));
  CHECK(si("3 \xE2\x80\xB0", "1") == Approx(0.003).epsilon(1e-14));
  CHECK(si("2 cP", "Pa.s") == Approx(0.002).epsilon(1e-14));
  CHECK(si("1 kft", "m") == Approx(304.8).epsilon(1e-14));
  CHECK(si("3 mdegC", "K") == Approx(273.153).epsilon(1e-14));
}

TEST_CASE("a prefix has one unit behind it, which people use with prefixes", "[units][errors]") {
  for (const char* unit : {"kkg", "mkg", "kkeV", "Min", "kin", "mmi", "mft", "mmin", "kday", "kton", "k", "da"}) {
    INFO(unit);
    CHECK_THROWS_WITH(units::si_unit_of(unit), Catch::Contains("is not a unit"));
  }
  CHECK_THROWS_WITH(units::si_unit_of("Min"), Catch::Contains("Did you mean 'min'?"));
  CHECK_THROWS_WITH(units::si_unit_of("MPH"), Catch::Contains("Did you mean 'mph'?"));
}

TEST_CASE("what udunits would read as something else is refused", "[units][errors]") {
  for (const char* unit : {"ton", "TON", "tons", "m/ton"})
    CHECK_THROWS_WITH(units::si_unit_of(unit), Catch::Contains("write t", Catch::CaseSensitive::No));
  for (const char* unit : {"g0", "a0", "m^0", "kg/m0"})
    CHECK_THROWS_WITH(units::si_unit_of(unit), Catch::Contains("power of zero"));
  // A gauge pressure is no bar times gram.
  for (const char* unit : {"bar(g)", "mm(abs)"})
    CHECK_THROWS_WITH(units::si_unit_of(unit), Catch::Contains("say elsewhere what is meant by"));
  CHECK(units::si_unit_of("bar.g") == units::si_unit_of("g bar"));
  CHECK(si("1 m10", "m10") == 1);
  for (const char* unit : {"\xC2\xB0 C", "deg C", "degrees C", "um/m/deg C"})
    CHECK_THROWS_WITH(units::si_unit_of(unit), Catch::Contains("Write degC"));
  for (const char* text : {"1d3 mm", "1D3 mm", "1d-3 mm"})
    CHECK_THROWS_WITH(units::parse(text), Catch::Contains("the exponent is written with e"));
  CHECK(units::parse("1d").unit == "d");
  CHECK(units::parse("1dm").unit == "dm");
}

TEST_CASE("points and differences on a scale with an offset", "[units]") {
  CHECK(si("20 degC", "K") == Approx(293.15).epsilon(1e-15));
  CHECK(si("20 degC", "K", Kind::difference) == 20);
  CHECK(si("68 degF", "K") == Approx(293.15).epsilon(1e-14));
  CHECK(si("9 degF", "K", Kind::difference) == Approx(5).epsilon(1e-14));
  CHECK(units::from_si(293.15, "degC", "K") == Approx(20).epsilon(1e-13));
  CHECK(units::from_si(1, "degC", "K", Kind::difference) == 1);
}

TEST_CASE("from_si inverts to_si", "[units]") {
  struct {
    const char* unit;
    const char* si;
  } rows[] = {{"mm", "m"},       {"um", "m"},    {"deg", "rad"}, {"mm/min", "m/s"}, {"um/h", "m/s"},
              {"um/m/K", "1/K"}, {"um/m", "1"},  {"min", "s"},   {"rpm", "rad/s"},  {"degC", "K"},
              {"um/K", "m/K"},   {"1/K", "1/K"}, {"1", "1"}};
  for (const auto& row : rows)
    for (const double x : {0.1, 160.591, -329.932, 1e-7})
      CHECK(
          units::from_si(units::to_si(x, row.unit, row.si), row.unit, row.si) ==
          Approx(x).epsilon(1e-15).margin(std::string(row.si) == "K" ? 1e-13 : 0)); // the offset of 273.15 costs digits
}

TEST_CASE("what is no number with a unit is refused", "[units]") {
  for (const char* text :
       {"", " ", "mm", "five mm", "nan mm", "inf mm", "-inf", "1e400 mm", "0,5 mm", "1_000 mm", "1.5.2 mm", "+-5 mm"})
    CHECK_THROWS_AS(units::parse(text), InputError);
  const auto m = units::parse("  +5.25e-1mm ");
  CHECK(m.number == 0.525);
  CHECK(m.unit == "mm");
  CHECK(units::parse("7").unit == "1");
}

TEST_CASE("what is no unit is refused, though udunits would take it", "[units]") {
  for (const char* unit : {"foo", "mm 3", "3 mm", "mm@3", "lg(re mm)", "mm since 1990", "m#", "", "mm)", "(mm", "mm/",
                           "mm*", "mm^", "."}) {
    INFO(unit);
    CHECK_FALSE(units::convertible(unit, "m"));
  }
  CHECK_THROWS_WITH(units::to_si(1, "foo", "m"), Catch::Contains("'foo' is not a unit"));
  CHECK(units::to_si(1, "um/(1/min)", "m.s") == Approx(60e-6)); // of a slope against a speed
  for (const char* not_a_unit : {"um/(1)", "um/(1 min)", "um/(2/min)"})
    CHECK_THROWS_WITH(units::to_si(1, not_a_unit, "m"), Catch::Contains("is not a unit"));
  CHECK_THROWS_WITH(units::to_si(1, "N", "m"), "error: 'N' is not a length (must convert to m). Use mm or um.");
}
