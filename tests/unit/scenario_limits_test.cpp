// Distributions that cannot be drawn are refused where they are stated.
#include <catch2/catch.hpp>

#include "unit/scenario_fixture.h"

using namespace scenario_fixture;
using Catch::Contains;

namespace {

/// What the parser says of one quantity, whose table begins at line 8.
std::string said(const std::string& quantity) {
  const Folder folder;
  try {
    scenario::read(folder.write("s.toml", "schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\n"
                                          "y = \"x\"\n\n\n[quantities.x]\n" +
                                              quantity),
                   catalogue());
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

} // namespace

TEST_CASE("a distribution that cannot be drawn is refused at its line", "[scenario][distributions]") {
  CHECK_THAT(said("value = 1\nu = 1\ndegrees_of_freedom = 0.01\n"),
             Contains("s.toml:11:22: error: quantities.x.degrees_of_freedom: 0.01 must be at least 0.25") &&
                 Contains("State 1"));
  CHECK_THAT(said("value = 1\nu = 1\ndistribution = \"t\"\ndegrees_of_freedom = 0.01\n"),
             Contains("s.toml:12:22: error: quantities.x.degrees_of_freedom: 0.01 must be at least 0.25"));
  for (const char* few : {"0.2", "0", "-1"}) { // once, for whatever distribution
    const std::string degrees = std::string("degrees_of_freedom = ") + few;
    for (const char* family : {"normal", "t", "rectangular"}) {
      const std::string width = std::string(family) == "rectangular" ? "half_width = 1\n" : "u = 1\n";
      const std::string text = said("value = 1\n" + width + "distribution = \"" + family + "\"\n" + degrees + "\n");
      CHECK_THAT(text, Contains("must be at least 0.25"));
      CHECK(text.find("must be") == text.rfind("must be"));
    }
  }
  CHECK_THAT(said("distribution = \"gamma\"\nshape = 1e15\nscale = 1\n"),
             Contains("s.toml:8:") &&
                 Contains("shape must be at most 1e+09; a larger one makes the distribution normal"));
  CHECK(said("value = 1\nu = 1\ndegrees_of_freedom = 0.25\n").empty());
  CHECK(said("value = 1\nu = 1\ndegrees_of_freedom = 1e12\n").empty());
  CHECK(said("distribution = \"gamma\"\nshape = 1e9\nscale = 1\n").empty());
}
