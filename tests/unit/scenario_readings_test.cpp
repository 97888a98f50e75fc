#include <catch2/catch.hpp>

#include "places.h"
#include "scenario/repeatability.h"
#include "unit/scenario_fixture.h"

using namespace scenario_fixture;
using quantities::Family;

namespace {

const std::string rods = std::string(GUMSHOE_SOURCE_DIR) + "/scenarios/data/rods.csv";

std::string from_rods(const std::string& where) {
  return head + "[indications.spindle_z]\nreadings = { file = \"" + rods +
         "\", column = \"spindle_z_mm\", unit = \"mm\", labels = { rod = \"rod\", setup = \"setup\" }" + where + " }\n";
}
std::string readings(const std::string& values, const std::string& rest) {
  return head + "[indications.spindle_z]\nreadings = [" + values + "]\n" + rest;
}
const std::vector<quantities::Component>& noise(const scenario::Scenario& s) {
  return quantity(s, "spindle_z").entries.at(0).components;
}
std::string notes(const scenario::Scenario& s) {
  std::string out;
  for (const auto& note : s.notes) out += note + '\n';
  return out;
}

} // namespace

TEST_CASE("rows of equal labels are repeats of one reading", "[scenario][readings]") {
  const auto all = read_text(from_rods(""));
  REQUIRE(all.readings.size() == 12);
  const auto& last = all.readings.back();
  CHECK(last.labels == quantities::Labels{{"rod", "rod2"}, {"setup", "3"}});
  CHECK(last.repeats == 3);
  // (330.271 + 330.270 + 330.270)/3; differences of 1 um from the first readout lose nothing.
  CHECK(last.indications[0] == Approx(-(330.270 + 1e-3 / 3) / 1000).epsilon(1e-15));
  const auto one = read_text(from_rods(", where = { rod = \"rod2\", setup = \"1\" }"));
  REQUIRE(one.readings.size() == 1);
  CHECK(one.readings[0].indications[0] == -329.932 / 1000);
}

TEST_CASE("listed conditions make one reading each", "[scenario][readings]") {
  const std::string listed = "[conditions]\nfeed = [\"4 mm/min\", \"8 mm/min\"]\n";
  const auto two = read_text(readings("\"-329 mm\", \"-330 mm\"", listed));
  REQUIRE(two.readings.size() == 2);
  CHECK(two.readings[0].conditions[0] == Approx(4e-3 / 60));
  CHECK(two.readings[1].conditions[0] == Approx(8e-3 / 60));
  CHECK(two.readings[1].indications[0] == -0.330);
  CHECK(two.readings[1].labels == quantities::Labels{{"feed", "8 mm/min"}});
  CHECK(complaint(readings("\"-329 mm\"", listed)).find("1 readings but 2 listed conditions") != std::string::npos);

  const auto spread =
      read_text(readings("\"-1 mm\", \"-2 mm\", \"-3 mm\"",
                         "[conditions]\ntime = { spread = [\"0 s\", \"6 s\"], readings = 3 }\nfeed = \"8 mm/min\"\n"));
  REQUIRE(spread.readings.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(spread.readings[i].conditions[1] == 2.0 * static_cast<double>(i));
    CHECK(spread.readings[i].conditions[0] == Approx(8e-3 / 60));
  }
  CHECK(complaint(readings("\"-1 mm\"", "[conditions]\ntime = { spread = [\"0 s\"], readings = 3 }\n"))
            .find("a first and a last value are needed") != std::string::npos);
  CHECK(complaint(readings("\"-1 mm\", \"-2 mm\"",
                           "[conditions]\ntime = { spread = [\"0 s\", \"1 s\"], readings = 3 }\nfeed = [\"8 mm/min\", "
                           "\"9 mm/min\"]\n"))
            .find("lists need equal lengths") != std::string::npos);
}

TEST_CASE("s pooled over all cells of the data, though one is read", "[scenario][readings]") {
  // Cells that scatter: (.513 .515 .513), (.460 .460 .461), (.271 .270 .270): squares (8 + 2 + 2)/3 um^2
  // = 4 um^2 over 12 cells x 2 degrees of freedom: s = sqrt(4/24) um = 0.408 um.
  const auto s =
      read_text(from_rods(", where = { rod = \"rod2\", setup = \"1\" }") + "repeatability = { pooled = true }\n");
  REQUIRE(noise(s).size() == 1);
  const auto& c = noise(s)[0];
  CHECK(c.name == "repeatability");
  CHECK(c.evaluation == 'A');
  CHECK(c.distribution.family == Family::t);
  CHECK(c.degrees_of_freedom == 24);
  CHECK(c.distribution.parameters[2] == 24);
  CHECK(c.distribution.parameters[1] ==
        Approx(std::sqrt(4.0 / 24) * 1e-6 / std::sqrt(3.0)).epsilon(1e-8)); // um of 0.3 m
  CHECK(c.per == std::vector<std::string>{"reading"});
}

TEST_CASE("of resolution and repeatability the larger counts, and a note says which", "[scenario][readings]") {
  const auto pooled = read_text(from_rods("") + "resolution = \"1 um\"\nrepeatability = { pooled = true }\n");
  REQUIRE(noise(pooled).size() == 1);
  CHECK(noise(pooled)[0].name == "resolution");
  CHECK(noise(pooled)[0].distribution.parameters[1] == Approx(0.5e-6).epsilon(1e-15));
  CHECK_THAT(notes(pooled), Catch::Contains("resolution used, not repeatability") && Catch::Contains("0.289 um") &&
                                Catch::Contains("0.236 um"));

  const auto scattered = read_text(
      readings("\"1 mm\"", "resolution = \"1 um\"\nrepeatability = { s = \"3 um\", degrees_of_freedom = 24 }\n"));
  REQUIRE(noise(scattered).size() == 1);
  CHECK(noise(scattered)[0].name == "repeatability");
  CHECK_THAT(notes(scattered), Catch::Contains("repeatability used, not resolution") && Catch::Contains("3 um"));
}

TEST_CASE("identical readouts have a Type A evaluation of zero", "[scenario][readings]") {
  const auto s =
      read_text(readings("\"1 mm\", \"1 mm\", \"1 mm\"", "resolution = \"1 um\"\nrepeatability = \"readings\"\n"));
  REQUIRE(noise(s).size() == 1);
  CHECK(noise(s)[0].name == "resolution");
  CHECK_THAT(notes(s), Catch::Contains("Type A uncertainty is zero"));
  CHECK(noise(read_text(readings("\"1 mm\", \"1 mm\"", "repeatability = \"readings\"\n"))).empty());
}

TEST_CASE("fewer than four readouts have no standard uncertainty of their own", "[scenario][readings]") {
  const auto three = read_text(readings("\"1 mm\", \"1.002 mm\", \"1.004 mm\"", "repeatability = \"readings\"\n"));
  CHECK(noise(three)[0].distribution.parameters[1] == Approx(2e-6 / std::sqrt(3.0)).epsilon(1e-10));
  CHECK(std::isinf(noise(three)[0].distribution.variance()));
  CHECK_THAT(notes(three), Catch::Contains("no standard uncertainty"));
  const auto four =
      read_text(readings("\"1 mm\", \"1.002 mm\", \"1.004 mm\", \"1 mm\"", "repeatability = \"readings\"\n"));
  CHECK(four.notes.empty());
  CHECK_THAT(complaint(readings("\"1 mm\"", "repeatability = \"readings\"\n")),
             Catch::Contains("cannot show any scatter"));
  CHECK_THAT(complaint(readings("\"1 mm\"", "repeatability = { pooled = true }\n")),
             Catch::Contains("nothing to pool"));
}

TEST_CASE("noise by labels where readings differ in their number of repeats", "[scenario][readings]") {
  const std::string rows =
      head + "[indications.spindle_z]\nrows = [ { rod = \"a\", values = [\"1 mm\"] }, { rod = \"b\", values = [\"1 "
             "mm\", \"1 mm\", \"1 mm\", \"1 mm\"] } ]\nrepeatability = { s = \"2 um\" }\n";
  const auto s = read_text(rows);
  const auto& entries = quantity(s, "spindle_z").entries;
  REQUIRE(entries.size() == 2);
  CHECK(entries[0].components[0].distribution.parameters[1] == Approx(2e-6).epsilon(1e-15));
  CHECK(entries[1].components[0].distribution.parameters[1] == Approx(1e-6).epsilon(1e-15));
  CHECK(entries[1].labels == quantities::Labels{{"rod", "b"}});
  CHECK_THAT(complaint(rows + "components = [ { u = \"1 um\", per = [] } ]\n"),
             Catch::Contains("shared by readings with different noise"));
}

TEST_CASE("noise of several readings states its scope", "[scenario][readings]") {
  const std::string rows = head + "[indications.spindle_z]\nrows = [ { rod = \"a\", values = [\"1 mm\"] }, { rod = \"b\", "
                                  "values = [\"1 mm\"] } ]\n";
  CHECK_THAT(complaint(rows + "components = [ { u = \"1 um\" } ]\n"),
             Catch::Contains("indications.spindle_z.components[1].per is missing") &&
                 Catch::Contains("share one draw") && Catch::Contains("per = \"reading\", or per = []"));
  for (const char* per : {"\"reading\"", "[]", "\"rod\""})
    CHECK(noise(read_text(rows + "components = [ { u = \"1 um\", per = " + per + " } ]\n")).size() == 1);
  // A single reading has nothing to share.
  CHECK(noise(read_text(readings("\"1 mm\"", "components = [ { u = \"1 um\" } ]\n"))).size() == 1);
}

TEST_CASE("where takes lists, exclusions and columns that are no labels", "[scenario][readings]") {
  const auto setups = [&](const std::string& where) {
    std::string out;
    for (const auto& r : read_text(from_rods(", where = { " + where + " }")).readings)
      out += *quantities::label_value(r.labels, "rod") + *quantities::label_value(r.labels, "setup") + ' ';
    return out;
  };
  CHECK(setups("setup = [\"1\", \"3\"], rod = \"rod2\"") == "rod21 rod23 ");
  CHECK(setups("setup = { not = \"2\" }, rod = { not = [\"standard\", \"rod1\"] }") == setups("setup = [\"0\", \"1\", \"3\"], rod = \"rod2\""));
  CHECK_THAT(complaint(from_rods(", where = { setup = [\"1\", \"9\"] }")), Catch::Contains("has setup = '9'"));
  CHECK_THAT(complaint(from_rods(", where = { setup = { not = \"9\" } }")), Catch::Contains("has setup = '9'"));
  CHECK_THAT(complaint(from_rods(", where = { setup = [] }")), Catch::Contains("no value is named"));
  CHECK_THAT(complaint(from_rods(", where = { stup = \"1\" }")),
             Catch::Contains("'stup' is neither a label of these readings nor a column") && Catch::Contains("Did you mean 'setup'?"));
  CHECK_THAT(complaint(from_rods(", where = { setup = { nto = \"1\" } }")), Catch::Contains("not is missing"));
}

TEST_CASE("data files with comments, semicolons and decimal commas", "[scenario][readings]") {
  const Folder folder;
  folder.write("z.csv", "# spindle heights\nname;z;feed\n a ;-1,5;4\n# b;-9,5;4\nb;-2,25;8\n");
  const std::string file = head + "[indications.spindle_z]\nreadings = { file = \"z.csv\", column = \"z\", unit = \"mm\", "
                                  "labels = { rod = \"name\" }, conditions = { feed = { column = \"feed\", unit = \"mm/min\" } }";
  const auto s = scenario::read(folder.write("s.toml", file + ", decimal = \",\" }\n"), catalogue());
  REQUIRE(s.readings.size() == 2);
  CHECK(s.readings[1].indications[0] == -2.25e-3);
  CHECK(s.readings[1].conditions[0] == Approx(8e-3 / 60));
  CHECK_THAT(notes(s), Catch::Contains("1 line(s) that look like rows begin with #"));
  CHECK_THROWS_WITH(
      scenario::read(folder.write("t.toml", file + " }\n"), catalogue()),
      Catch::Contains("z.csv:3:5: error: '-1,5' is not a number (column 'z': the decimal sign must be a point)") &&
          Catch::Contains("decimal = \",\""));
}

TEST_CASE("a virtual experiment needs no readouts", "[scenario][readings]") {
  const std::string virtual_head = "schema = 1\nmodel = { name = \"rod\", method = \"virtual_experiment\" }\n";
  const auto bare = read_text(virtual_head);
  REQUIRE(bare.readings.size() == 1);
  CHECK(bare.readings[0].indications.empty());
  const auto rows =
      read_text(virtual_head + "[indications.spindle_z]\nrows = [ { rod = \"a\", repeats = 4 }, { rod = \"b\", repeats "
                               "= 4 } ]\nrepeatability = { s = \"2 um\", degrees_of_freedom = 24 }\n");
  REQUIRE(rows.readings.size() == 2);
  CHECK(rows.readings[1].repeats == 4);
  CHECK(noise(rows)[0].distribution.parameters[1] == Approx(1e-6).epsilon(1e-15));
  CHECK_THAT(complaint(head), Catch::Contains("indications.spindle_z is missing"));
  CHECK_THAT(complaint(head + "[indications.spindle_z]\nresolution = \"1 um\"\n"),
             Catch::Contains("indications.spindle_z: no readings"));
}

TEST_CASE("conditions from a column; other rows than the labels say are other readings", "[scenario][readings]") {
  const Folder folder;
  folder.write("d.csv", "z,f\n1,4\n3,4\n5,8\n");
  const auto s = scenario::read(
      folder.write("s.toml", head + "[indications.spindle_z]\nreadings = { file = \"d.csv\", column = \"z\", unit = "
                                    "\"mm\", conditions = { feed = { column = \"f\", unit = \"mm/min\" } } }\n"),
      catalogue());
  REQUIRE(s.readings.size() == 2);
  CHECK(s.readings[0].indications[0] == Approx(2e-3).epsilon(1e-15));
  CHECK(s.readings[1].conditions[0] == 8.0 / 60000);
}

TEST_CASE("the hash follows the text and the data", "[scenario][readings]") {
  const Folder folder;
  const std::string text =
      head + "[indications.spindle_z]\nreadings = { file = \"d.csv\", column = \"z\", unit = \"mm\" }\n";
  const auto hash = [&](const std::string& scenario_text, const std::string& data) {
    folder.write("d.csv", data);
    return scenario::read(folder.write("s.toml", scenario_text), catalogue()).hash;
  };
  const std::string first = hash(text, "z\n1\n");
  CHECK(first.size() == 16);
  CHECK(hash(text, "z\n1\n") == first);
  CHECK(hash(text, "z\n2\n") != first);
  CHECK(hash(text + "# \n", "z\n1\n") != first);
}
