// Notes of a scenario on what may be a slip: no value, more scatter than declared, another unit than the column's name.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "unit/scenario_fixture.h"

using namespace scenario_fixture;
using Catch::Contains;

namespace {

std::string notes(const std::string& text) { return fmt::format("{}", fmt::join(read_text(text).notes, "\n")); }

/// L = standard + d.
std::string sum(const std::string& standard, const std::string& d = "{ value = \"0.25 um\", u = \"20 nm\" }") {
  return "schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\nL = \"standard + d\"\n[quantities]\nstandard "
         "= " +
         standard + "\nd = " + d + '\n';
}

std::string readings(const std::string& values, const std::string& declared) {
  return head + "[indications.spindle_z]\nreadings = [" + values + "]\n" + declared + '\n';
}
/// s = 1.708 um with 3 degrees of freedom.
std::string four(const std::string& declared) { return readings(R"("1 um", "3 um", "2 um", "5 um")", declared); }

} // namespace

TEST_CASE("uncertain quantities without a value are noted", "[scenario][notes]") {
  CHECK(notes(sum("{ U = \"60 nm\", k = 2 }")) == "standard has no value: its estimate is taken as 0 nm");
  CHECK(notes(sum("{ u = \"60 nm\" }", "{ distribution = \"rectangular\", half_width = \"1 um\" }")) ==
        "standard, d have no value: their estimates are taken as 0 nm, 0 um");
  CHECK_THAT(notes(sum("{ components = [{ u = \"1 um\" }, { distribution = \"rectangular\", low = \"-1 um\", high = "
                       "\"1 um\" }] }")),
             Contains("standard has no value: its estimate is taken as 0 um"));
  CHECK_THAT(notes(sum("{ u = 1 }", "{ value = 1 }")), Contains("its estimate is taken as 0") && !Contains("0 1"));
}

TEST_CASE("a quantity whose distribution or fit says where it lies needs no value", "[scenario][notes]") {
  for (const char* placed :
       {"{ value = 0, u = 1 }", "{ distribution = \"rectangular\", low = 1, high = 2 }",
        "{ observations = [1, 2, 3, 4] }", "{ components = [{ observations = [1, 2, 3, 4] }, { u = 1 }] }",
        "{ distribution = \"empirical\", values = [1, 2, 3] }",
        "{ distribution = \"lognormal\", median = 1, sigma = 0.1 }",
        "{ distribution = \"gamma\", shape = 2, scale = 1 }", "{ estimated = true, u = 1 }"}) {
    INFO(placed);
    CHECK_THAT(notes(sum(placed, "{ value = 1 }")), !Contains("no value"));
  }
  // The card of a model has a default value.
  CHECK_THAT(notes(head + one_reading + "[quantities]\nrod_radius = { u = \"1 um\" }\n"), !Contains("no value"));
}

TEST_CASE("repeats that scatter by more than declared are noted", "[scenario][notes]") {
  CHECK_THAT(notes(four("u = \"0.1 um\"")),
             Contains("spindle_z: repeats scatter by s = 1.71 um (3 degrees of freedom)") &&
                 Contains("(u = 0.1 um; p < 0.001)"));
  CHECK_THAT(notes(four("repeatability = { s = \"0.1 um\", degrees_of_freedom = 20 }")),
             Contains("s = 0.1 um (20 degrees of freedom); p < 0.001"));
  // Chi-squared of 3 degrees of freedom: 16.27 at 0.001, reached at u = 0.7335 um.
  CHECK_THAT(notes(four("u = \"0.73 um\"")), Contains("repeats scatter"));
  CHECK_THAT(notes(four("u = \"0.74 um\"")), !Contains("repeats scatter"));
  CHECK_THAT(notes(four("repeatability = { s = \"0.74 um\" }")), !Contains("repeats scatter"));
  // F of 3 and 4 degrees of freedom: 56.18, reached at s = 0.2278 um; of 3 and 20: 8.098, at 0.6001 um.
  for (const auto& [freedom, noted, allowed] : {std::tuple{4, "0.225", "0.23"}, std::tuple{20, "0.595", "0.605"}}) {
    const std::string form = "repeatability = {{ s = \"{} um\", degrees_of_freedom = {} }}";
    CHECK_THAT(notes(four(fmt::format(fmt::runtime(form), noted, freedom))), Contains("repeats scatter"));
    CHECK_THAT(notes(four(fmt::format(fmt::runtime(form), allowed, freedom))), !Contains("repeats scatter"));
  }
}

TEST_CASE("the scatter of several readings is judged together, and rounding counts", "[scenario][notes]") {
  const std::string two = notes(head + "[indications.spindle_z]\nu = \"0.1 um\"\nrows = [\n"
                                       "{ setup = \"1\", values = [\"1 um\", \"2 um\"] },\n"
                                       "{ setup = \"2\", values = [\"9 um\", \"9 um\"] } ]\n");
  CHECK_THAT(two, Contains("s = 0.5 um (2 degrees of freedom)"));
  CHECK(two.find("repeats scatter") == two.rfind("repeats scatter"));
  // A display between two steps shows either: half a step of scatter.
  std::string steps;
  for (int i = 0; i < 20; ++i) steps += fmt::format("{}\"{} um\"", i == 0 ? "" : ", ", 1 + i % 2);
  CHECK_THAT(notes(readings(steps, "u = \"0.05 um\"\nresolution = \"1 um\"")), !Contains("repeats scatter"));
  CHECK_THAT(notes(readings(steps, "u = \"0.05 um\"")), Contains("repeats scatter"));
}

TEST_CASE("no test of scatter that the data themselves state, or where nothing is declared", "[scenario][notes]") {
  for (const char* stated :
       {"repeatability = \"readings\"", "repeatability = { pooled = true }", "resolution = \"0.1 um\"", ""})
    CHECK_THAT(notes(four(stated)), !Contains("repeats scatter"));
  CHECK_THAT(notes(readings("\"1 um\"", "u = \"0.1 um\"")), !Contains("repeats scatter"));
}

namespace {

/// The same readings, from a column of this name that is read in this unit.
std::string column_notes(const std::string& column, const std::string& unit) {
  const Folder folder;
  folder.write("r.csv", column + ",id\n1001,1\n1003,2\n");
  const std::string text =
      head + "[indications.spindle_z]\nrepeatability = { s = \"1 m\" }\nreadings = { file = \"r.csv\", column = \"" +
      column + "\", unit = \"" + unit + "\" }\n";
  return fmt::format("{}", fmt::join(scenario::read(folder.write("s.toml", text), catalogue()).notes, "\n"));
}

std::string observed_notes(const std::string& unit) {
  const Folder folder;
  folder.write("o.csv", "d [um]\n1\n3\n2\n5\n");
  const std::string text =
      head + one_reading +
      "[quantities.rod_length]\nobservations = { file = \"o.csv\", column = \"d [um]\", unit = \"" + unit + "\" }\n";
  return fmt::format("{}", fmt::join(scenario::read(folder.write("s.toml", text), catalogue()).notes, "\n"));
}

} // namespace

TEST_CASE("a column that is read in another unit than its name states is noted", "[scenario][notes]") {
  CHECK_THAT(column_notes("x_um", "mm"), Contains("r.csv: column 'x_um' is read in mm, but its name states um"));
  CHECK_THAT(column_notes("x (mm)", "um"), Contains("column 'x (mm)' is read in um"));
  CHECK_THAT(observed_notes("mm"), Contains("column 'd [um]' is read in mm"));
  for (const auto& [column, unit] : {std::pair{"x_mm", "mm"}, std::pair{"x", "mm"}, std::pair{"x_min", "mm"},
                                     std::pair{"T_in", "mm"}, std::pair{"x (1)", "mm"}}) {
    INFO(column << " in " << unit);
    CHECK_THAT(column_notes(column, unit), !Contains("is read in"));
  }
  CHECK_THAT(observed_notes("um"), !Contains("is read in"));
}

TEST_CASE("corrections in degC are read in K without a note", "[scenario][notes]") {
  const Folder folder;
  folder.write("b.csv", "b_degC\n-0.15\n-0.12\n");
  const std::string text =
      "schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\ny = \"b\"\n[indications.b]\n"
      "repeatability = { s = \"1 K\" }\n"
      "readings = { file = \"b.csv\", column = \"b_degC\", unit = \"K\" }\n";
  CHECK(scenario::read(folder.write("s.toml", text), catalogue()).notes.empty());
}
