/// Inputs that nobody writes by hand, but a broken program or a wrong file does: each reader refuses them at once.
#include <catch2/catch.hpp>

#include "base/clock.h"
#include "base/csv.h"
#include "base/encoding.h"
#include "formula/compile.h"
#include "scenario/document.h"
#include "scenario/file_pattern.h"
#include "unit/scenario_fixture.h"

using namespace gumshoe;

namespace {

std::string times(std::size_t n, const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < n; ++i) out += text;
  return out;
}

/// Problems that `action` is refused with; none if it is not.
template <class Action> std::vector<Problem> problems_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

} // namespace

TEST_CASE("a line of very many columns is no header", "[csv]") {
  CHECK(problems_of([] { parse_csv(times(300'000, "a,") + "b\n", "t.csv"); }).size() ==
        20); // not a day, nor 300 000 lines
}

TEST_CASE("halves of pairs of UTF-16 stand for no character", "[csv]") {
  CHECK(as_utf8(std::string("\xFF\xFE\x3D\xD8"
                            "a\0\x00\xDE",
                            8)) == "\xEF\xBF\xBD"
                                   "a\xEF\xBF\xBD");
}

TEST_CASE("seconds that have no difference are no moment", "[clock]") {
  const ClockFormat format("%s");
  CHECK_FALSE(format.parse("9223372036854775807"));
  CHECK_FALSE(format.parse("-9223372036854775808"));
  const auto first = format.parse("-4000000000000000000"), last = format.parse("4000000000000000000");
  REQUIRE((first && last));
  CHECK(last->since(*first) == 8e18);
}

TEST_CASE("a pattern of many stars is compared at once", "[scenario]") {
  const fixture::Folder folder;
  folder.write(times(200, "a"), "x\n1\n");
  const auto matches = [&](const std::string& name) { return scenario::FilePattern(folder / name).matches(); };
  CHECK_THROWS_WITH(matches(times(100, "*a") + "*b"), Catch::Contains("no file has such a name"));
  CHECK(matches(times(100, "*a") + "*").size() == 1);
  CHECK(matches("a*{run}a").front().texts == std::vector<std::string>{times(198, "a")});
  CHECK_THROWS_WITH(matches(times(1'000'000, "*")), Catch::Contains("the file's name is too long"));
}

TEST_CASE("quotes at the end of a long text hide no nested keys", "[scenario][errors]") {
  const std::string keys = times(200'000, "b.") + "b";
  for (const char* text : {"\"\"\"y\"\"\"\"", "\"\"\"y\"\"\"\"\"", "'''y''''", "'''y'''''", "\"\"\"\\\"\"\"\"\""})
    CHECK_THROWS_WITH(scenario::parse_document(std::string("a = { x = ") + text + ", " + keys + " = 1 }\n", "s.toml"),
                      Catch::Contains("keys are nested more than"));
}

TEST_CASE("the problems of one formula are as many as people read", "[expression]") {
  formula::Statement s;
  s.quantities.push_back({"a", "1", "1", ""});
  formula::Stated y;
  y.formula.name = "y";
  y.formula.text = "a" + times(20'000, " + unknown");
  s.measurands.push_back(y);
  std::vector<std::string> notes;
  CHECK(problems_of([&] { formula::compile(s, notes); }).size() == 20);
}

TEST_CASE("repeats of one reading are counted as far as numbers go", "[scenario][errors]") {
  const std::string text = scenario_fixture::head + "[indications.spindle_z]\nrows = [" +
                           times(3000, "{ rod = \"1\", repeats = 1000000 }, ") + "]\n";
  CHECK_THAT(scenario_fixture::complaint(text),
             Catch::Contains("the rows of this reading have more than 1000000 in all"));
}
