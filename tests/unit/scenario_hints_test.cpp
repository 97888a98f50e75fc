// Messages that name the cause: sections, columns without a unit, the place of a unit, the column of a cell.
#include <catch2/catch.hpp>

#include "unit/scenario_fixture.h"

using namespace scenario_fixture;
using Catch::Contains;

namespace {

std::string formula(const std::string& y) {
  return "schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\ny = " + y + '\n';
}

/// What the parser says of a scenario next to r.csv.
std::string said(const std::string& text, const std::string& csv = "x_um,id\n1001,1\n1003,2\n") {
  const Folder folder;
  folder.write("r.csv", csv);
  try {
    scenario::read(folder.write("s.toml", text), catalogue());
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

const std::string without_unit = "[indications.r]\nreadings = { file = \"r.csv\", column = \"x_um\" }\n";
const std::string hint = "tate the unit of the column 'x_um', without which r is a plain number";

} // namespace

TEST_CASE("a misspelt section is named together with what follows from it", "[scenario][hints]") {
  const std::string a = "[quantitis.a]\nvalue = \"1 mm\"\n", b = "[quantities.b]\nvalue = \"1 mm\"\n";
  const std::string both = said(formula("\"a + b\"") + a + b);
  CHECK_THAT(both, Contains("s.toml:6:2: error: unknown key 'quantitis'. Did you mean 'quantities'?") &&
                       Contains("'a' is not a quantity"));
  CHECK_THAT(said("schema = 1\n[modle]\nname = \"rod\"\n"),
             Contains("unknown key 'modle'. Did you mean 'model'?") && Contains("model is missing"));
  // Once, where everything else is read.
  const std::string once = said(head + one_reading + "[runn]\n");
  CHECK(once.find("unknown key 'runn'") != std::string::npos);
  CHECK(once.find("unknown key 'runn'") == once.rfind("unknown key 'runn'"));
}

TEST_CASE("a misspelt distribution is named", "[scenario][hints]") {
  const std::string a = "[quantities.a]\nvalue = \"1 mm\"\nhalf_width = \"1 um\"\n";
  CHECK_THAT(said(formula("\"a\"") + a + "distribtuion = \"rectangular\"\n"),
             Contains("'distribtuion' is no key") && Contains("Did you mean 'distribution'?"));
  CHECK_THAT(said(formula("\"a\"") + a), Contains("Try: distribution = \"rectangular\""));
}

TEST_CASE("a sum with a column without a unit names the column", "[scenario][hints]") {
  const std::string b = "[quantities.b]\nvalue = \"1 mm\"\n";
  CHECK_THAT(said(formula("\"r + b\"") + without_unit + b), Contains("a plain number plus a length") && Contains(hint));
  CHECK_THAT(said(formula("{ formula = \"r\", unit = \"mm\" }") + without_unit),
             Contains("is not a plain number") && Contains(hint));
  CHECK_THAT(
      said("schema = 1\n[model]\nname = \"expression\"\n[model.intermediates]\nz = \"2 * r\"\n[model.measurands]\n"
           "y = \"z + b\"\n" +
           without_unit + b),
      Contains(hint));
  CHECK_THAT(said(formula("\"c + b\"") + without_unit + b + "[quantities.c]\nvalue = 1\n"),
             Contains("a plain number plus a length") && !Contains("unit of the column"));
  CHECK_THAT(said(formula("\"t * b + r\"") +
                  "[conditions]\n[indications.r]\nreadings = { file = \"r.csv\", column = \"x_um\", "
                  "unit = \"um\", conditions = { t = \"id\" } }\n" +
                  "[quantities.b]\nvalue = \"1 N\"\n"),
             !Contains("unit of the column")); // a force plus a length: no plain number is to blame
}

TEST_CASE("an unknown unit stands at its own place", "[scenario][hints]") {
  CHECK_THAT(said(formula("\"a\"") + "[quantities.a]\nvalue = \"1 mmm\"\nu = \"0.1 mm\"\n"),
             Contains("s.toml:7:9: error: quantities.a: 'mmm' is not a unit"));
  CHECK_THAT(said(formula("\"a\"") + "[quantities]\na = { u = \"0.1 mmm\", value = 1 }\n"),
             Contains("s.toml:7:11: error: quantities.a: 'mmm' is not a unit"));
}

TEST_CASE("a value give or take something is told which keys say so", "[scenario][hints]") {
  for (const char* text : {"100 mm +- 2 um", "100 mm +/- 2 um", "100 mm \u00b1 2 um", "100\u00b12 um"})
    CHECK_THAT(said(formula("\"a\"") + "[quantities]\na = \"" + text + "\"\n"),
               Contains("s.toml:7:5: error: quantities.a: ") && Contains("u = \"2 um\" if that is the standard") &&
                   Contains("half_width = \"2 um\""));
}

TEST_CASE("a bad cell is told with its column", "[scenario][hints]") {
  const std::string readings =
      head + "[indications.spindle_z]\nreadings = { file = \"r.csv\", column = \"x_um\", unit = \"um\"";
  CHECK_THAT(said(readings + " }\n", "id,x_um\n1,2\n2,o\n"),
             Contains("r.csv:3:3: error: 'o' is not a number (column 'x_um')."));
  CHECK_THAT(said(readings + ", labels = { rod = \"id\" } }\n", "id,x_um\n1,2\n,3\n"),
             Contains("the label 'rod' is empty (column 'id')."));
  CHECK_THAT(said(head + one_reading +
                      "[quantities]\nrod_length = { observations = { file = \"r.csv\", column = \"x_um\", unit = "
                      "\"um\" } }\n",
                  "id,x_um\n1,2\n2,o\n"),
             Contains("'o' is not a number (column 'x_um')."));
}

TEST_CASE("an array of coefficients is a matrix", "[scenario][hints]") {
  CHECK_THAT(
      said(head + one_reading +
           "[quantities]\nrod_radius = { u = \"1 um\" }\nrod_length = { u = \"1 um\" }\n"
           "[[correlations]]\nquantities = [\"rod_radius\", \"rod_length\"]\nkind = \"pearson\"\n"
           "coefficient = [[1, 0.5], [0.5, 1]]\n"),
      Contains("correlations[1].coefficient: one number is expected, not an array (several coefficients are a matrix). "
               "Try: matrix = [[1, 0.5], [0.5, 1]]"));
}
