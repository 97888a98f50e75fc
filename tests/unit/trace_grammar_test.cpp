#include <catch2/catch.hpp>

#include "base/units.h"
#include "unit/scenario_fixture.h"

using namespace scenario_fixture;
using Catch::Contains;

namespace {

const std::string csv = "rod,setup,feed,t,T,z\n"
                        "a,1,10,0,20,1.0\n"
                        "a,1,10,0,21,1.2\n"
                        "b,1,20,10,22,2.0\n"
                        "a,2,10,20,20,1.1\n"
                        "b,2,20,30,19,2.1\n";
const std::string readings =
    "[indications.spindle_z]\n"
    "readings = { file = \"r.csv\", column = \"z\", unit = \"mm\", labels = { rod = \"rod\", setup = \"setup\" }, "
    "conditions = { feed = { column = \"feed\", unit = \"mm/min\" }, time = { column = \"t\", unit = \"s\" } } }\n";
const std::string columns = "[trace.columns]\ntemperature = { column = \"T\", unit = \"degC\" }\n";

/// Lines 1 to 4 are the head and the readings: `more` starts at line 5.
scenario::Scenario read(const std::string& more, const std::string& data = csv) {
  const Folder folder;
  folder.write("r.csv", data);
  return scenario::read(folder.write("s.toml", head + readings + more), catalogue());
}
std::string wrong(const std::string& more, const std::string& data = csv) {
  try {
    read(more, data);
  } catch (const InputError& error) {
    std::string out;
    for (Problem p : error.problems()) {
      p.where.file = std::filesystem::path(p.where.file).filename().string();
      out += format(p) + '\n';
    }
    return out;
  }
  return {};
}
std::string effect(const std::string& formula, const std::string& unit, const std::string& more = "") {
  return "[stated_effects.film]\nformula = \"" + formula + "\"\nunit = \"" + unit + "\"\n" + more;
}

} // namespace

TEST_CASE("what [trace] says", "[scenario][trace]") {
  CHECK_FALSE(read("").trace.stated);
  const auto plain = read("[trace]\n").trace;
  CHECK(plain.stated);
  CHECK(plain.order.empty());
  CHECK(plain.draws == 999);
  CHECK_FALSE(plain.redone); // every label may be an act
  REQUIRE(read("[trace]\nredone = []\n").trace.redone);
  CHECK(read("[trace]\nredone = []\n").trace.redone->empty()); // none is
  const auto t = read("[trace]\nblocks = \"setup\"\nfinal = [\"2\"]\norder = \"time\"\nredone = [[\"rod\", \"setup\"], "
                      "\"rod\"]\nalpha = 0.01\ndraws = 1_999\nseed = 7\n" +
                      columns)
                     .trace;
  CHECK(t.blocks == "setup");
  CHECK(t.final_blocks == std::vector<std::string>{"2"});
  CHECK(t.order == std::vector<double>{0, 10, 20, 30});
  CHECK(t.redone == std::vector<std::vector<std::string>>{{"rod", "setup"}, {"rod"}});
  CHECK(t.alpha == 0.01);
  CHECK(t.draws == 1999);
  CHECK(t.seed == 7);
  // Two readouts of the first reading: their mean, in SI.
  REQUIRE(t.columns.size() == 1);
  CHECK(t.columns[0].si_unit == "K");
  REQUIRE(t.columns[0].values.size() == 4);
  CHECK(t.columns[0].values[0] == Approx(293.65).epsilon(1e-14));
  CHECK(t.columns[0].values[3] == Approx(292.15).epsilon(1e-14));
  const auto jumping = read("[trace]\njumping = { rod_radius = \"2 um\" }\n").trace.jumping;
  REQUIRE(jumping.size() == 1);
  CHECK(jumping[0].first == "rod_radius");
  CHECK(jumping[0].second == Approx(2e-6));
  CHECK(read("[trace]\norder = \"temperature\"\n" + columns).trace.order == t.columns[0].values);
}

TEST_CASE("columns do not regroup the readings", "[scenario][trace]") {
  const auto bare = read(""), with = read("[trace]\n" + columns);
  REQUIRE(with.readings.size() == bare.readings.size());
  for (std::size_t r = 0; r < bare.readings.size(); ++r) {
    CHECK(with.readings[r].indications == bare.readings[r].indications);
    CHECK(with.readings[r].repeats == bare.readings[r].repeats);
  }
}

TEST_CASE("mistakes in [trace] are located", "[scenario][trace][errors]") {
  const std::pair<std::string, std::string> cases[] = {
      {"blocks = \"setpu\"",
       "s.toml:6:10: error: trace.blocks: no reading has the label 'setpu'. Did you mean 'setup'?"},
      {"blocks = \"setup\"\nfinal = [\"2\", \"3\"]", "s.toml:7:15: error: trace.final: no reading has setup = '3'"},
      {"blocks = \"setup\"\nfinal = [\"1\", \"2\"]", "s.toml:7:9: error: trace.final: every block is held out"},
      {"blocks = \"setup\"\nfinal = [\"2\", \"2\"]", "s.toml:7:15: error: trace.final: '2' is listed twice"},
      {"blocks = \"setup\"\nfinal = []", "s.toml:7:9: error: trace.final: empty"},
      {"blocks = \"setup\"\nfinal = [2]", "s.toml:7:10: error: trace.final: text is expected, not an integer"},
      {"final = [\"2\"]", "s.toml:6:9: error: trace.final: there are no blocks"},
      {"order = \"tiem\"",
       "s.toml:6:9: error: trace.order: 'tiem' is neither a condition nor a column. Did you mean 'time'?"},
      {"order = \"temperatur\"\n" + columns, "Did you mean 'temperature'?"},
      {"redone = [[\"rod\", \"setpu\"]]", "s.toml:6:19: error: trace.redone[1]: no reading has the label 'setpu'"},
      {"redone = [[]]", "s.toml:6:11: error: trace.redone[1]: empty"},
      {"redone = [[\"rod\", \"rod\"]]", "s.toml:6:19: error: trace.redone[1]: 'rod' is listed twice"},
      {"alpha = 0", "s.toml:6:9: error: trace.alpha: 0 must lie between 0 and 1"},
      {"alpha = 1.5", "s.toml:6:9: error: trace.alpha: 1.5 must lie between 0 and 1"},
      {"alpha = nan", "s.toml:6:9: error: trace.alpha: the number is not finite"},
      {"draws = 98", "s.toml:6:9: error: trace.draws: 98 must lie between 99 and 1000000"},
      {"block = \"setup\"", "s.toml:6:1: error: trace: unknown key 'block'. Did you mean 'blocks'?"},
      {"jumping = { rod_radios = \"2 um\" }",
       "s.toml:6:13: error: trace.jumping: unknown key 'rod_radios'. Did you mean 'rod_radius'?"},
      {"jumping = { rod_radius = \"-2 um\" }", "s.toml:6:26: error: trace.jumping.rod_radius: must be above 0"},
      {"jumping = { rod_radius = \"2 mrad\" }", "s.toml:6:26: error: trace.jumping.rod_radius"},
      {"[trace.columns]\nt = { column = \"Tt\" }", "has no column 'Tt'. Did you mean"},
      {"[trace.columns]\nt = { unit = \"s\" }", "s.toml:7:5: error: trace.columns.t.column is missing"},
      {"[trace.columns]\nt = { column = \"T\", unit = \"degX\" }", "'degX' is not a unit"},
      {"[trace.columns]\nfeed = { column = \"T\" }",
       "s.toml:7:1: error: trace.columns.feed: the name already has a meaning"},
      {"[trace.columns]\n\"t x\" = { column = \"T\" }", "a formula cannot use this name"},
      {"[trace.columns]\nx = { column = \"rod\" }", "r.csv:2:1: error: 'a' is not a number"},
      {"[trace.columns]\nx = { column = \"z\" }", "s.toml:7:1: error: trace.columns.x: 'z' holds readings"},
  };
  for (const auto& [text, message] : cases) {
    CAPTURE(text);
    CHECK_THAT(wrong("[trace]\n" + text + '\n'), Contains(message));
  }
  CHECK_THAT(complaint(head + one_reading + "[trace]\n" + columns), Contains("the readings are not in a data file"));
}

TEST_CASE("cells without a number are refused at their place", "[scenario][trace][errors]") {
  const std::string trace = "[trace]\norder = \"time\"\n" + columns;
  for (const std::string cell : {"nan", "inf", "-inf", "NaN", "", "1,0,2"}) {
    CAPTURE(cell);
    const auto broken = [&](const std::string& row) { return wrong(trace, csv + row + '\n'); };
    if (cell == "1,0,2") {
      CHECK_THAT(broken("b,3,20,40,20,1,0,2"), Contains("r.csv:7:1: error: the row has 8 cells, the header 6"));
      continue;
    }
    CHECK_THAT(broken("b,3,20,40,20," + cell), Contains("r.csv:7:14: error: '" + cell + "' is not a number"));
    CHECK_THAT(broken("b,3,20," + cell + ",20,1"), Contains("r.csv:7:8: error: '" + cell + "' is not a number"));
    CHECK_THAT(broken("b,3,20,40," + cell + ",1"), Contains("r.csv:7:11: error: '" + cell + "' is not a number"));
  }
  // A formula does not complain of a column that is named but has a bad cell.
  CHECK_THAT(wrong(trace + effect("temperature", "um/K"), csv + "b,3,20,40,x,1\n"), !Contains("film"));
}

TEST_CASE("a stated effect is loaded at each reading", "[scenario][trace]") {
  const auto s =
      read("[trace]\n" + columns + effect("1 / feed", "um*mm/min", "meaning = \"film\"\n") +
           "[stated_effects.growth]\nformula = \"temperature\"\nunit = \"um/K\"\nindication = \"spindle_z\"\n");
  REQUIRE(s.stated_effects.size() == 2);
  const auto& film = s.stated_effects[0];
  CHECK(film.name == "film");
  CHECK(film.meaning == "film");
  CHECK(film.parts[0].target == 0);
  CHECK_FALSE(film.freed);
  REQUIRE(film.parts[0].loading.size() == 4);
  for (std::size_t r = 0; r < 4; ++r) CHECK(film.parts[0].loading[r] == Approx(1 / s.readings[r].conditions[0]).epsilon(1e-15));
  CHECK(units::to_si(1, "um*mm/min", film.si_unit) == Approx(1e-9 / 60).epsilon(1e-14));
  CHECK(s.stated_effects[1].parts[0].loading == s.trace.columns[0].values);
  // At null it is no quantity, and nothing else changes.
  CHECK(s.quantities.size() == read("").quantities.size());
}

TEST_CASE("a stated effect with a size is the last quantity", "[scenario][trace]") {
  const auto s =
      read(effect("1 / feed", "um*mm/min", "size = { value = \"3 um*mm/min\", u = \"1 um*mm/min\" }\n") +
           "[[correlations]]\nquantities = [\"film.size\", \"rod_radius\"]\nkind = \"copula\"\ncoefficient = 0.5\n"
           "[quantities]\nrod_radius = { u = \"1 um\" }\n");
  REQUIRE(s.quantities.size() == read("").quantities.size() + 1);
  const auto& q = s.quantities.back();
  CHECK(q.name == "film.size");
  CHECK(q.unit == "um*mm/min");
  CHECK(q.entries[0].value == Approx(3e-9 / 60).epsilon(1e-14));
  CHECK(s.stated_effects[0].freed);
  CHECK(s.correlations.size() == 1);
  CHECK(read(effect("1", "um", "size = { estimated = true, by.setup = { 1 = \"0 um\", 2 = \"1 um\" } }\n"))
            .quantities.back()
            .entries.size() == 2);
}

TEST_CASE("mistakes in stated effects are located at the character", "[scenario][trace][errors]") {
  CHECK_THAT(wrong(effect("1 / feed", "um")), Contains("s.toml:6:12: error: stated_effects.film: the formula gives") &&
                                                  Contains("spindle_z is a length") &&
                                                  Contains("Try: unit = \"m2.s-1\""));
  CHECK_THAT(wrong(effect("time + feed", "um")),
             Contains("s.toml:6:17: error: stated_effects.film: a time plus a speed"));
  CHECK_THAT(
      wrong(effect("time * spindle_z", "um")),
      Contains("s.toml:6:19: error: stated_effects.film: 'spindle_z' is an indication (a signature computed from "
               "what was measured explains itself)"));
  CHECK_THAT(wrong(effect("time * rod_radius", "um")), Contains("s.toml:6:19: error: stated_effects.film: 'rod_radius' "
                                                                "is a quantity of the model"));
  CHECK_THAT(
      wrong(effect("tiem", "um/s")),
      Contains(
          "s.toml:6:12: error: stated_effects.film: 'tiem' is neither a condition nor a column. Did you mean 'time'?"));
  CHECK_THAT(wrong(effect("1 +", "um")), Contains("s.toml:6:15: error"));
  CHECK_THAT(wrong(effect("1 / time", "um*s")), Contains("no finite value at reading 1 (rod = a, setup = 1)"));
  CHECK_THAT(wrong(effect("time", "um/fortnit")), Contains("s.toml:7:8: error: stated_effects.film.unit: "));
  CHECK_THAT(wrong("[stated_effects.film]\nunit = \"um\"\n"),
             Contains("stated_effects.film: it has neither a formula nor a table"));
  CHECK_THAT(wrong("[stated_effects.film]\nformula = 1\n"), Contains("stated_effects.film.unit is missing"));
  CHECK_THAT(wrong(effect("1", "um", "indication = \"spindel_z\"\n")), Contains("Did you mean 'spindle_z'?"));
  CHECK_THAT(wrong(effect("1", "um", "size = \"1 s\"\n")), Contains("stated_effects.film.size: '1 s' is not a length"));
  CHECK_THAT(wrong(effect("1", "um", "amount = \"1 um\"\n")), Contains("unknown key 'amount'"));
  for (const std::string name : {"trigger_latency", "feed", "rod_radius", "spindle_z"})
    CHECK_THAT(wrong("[stated_effects." + name + "]\nformula = 1\nunit = \"um\"\n"), Contains("has this name"));
  CHECK_THAT(wrong("[stated_effects.\"a film\"]\nformula = 1\nunit = \"um\"\n"),
             Contains("the name cannot be used for an effect"));
}

TEST_CASE("another data file for the same scenario", "[scenario][trace]") {
  const Folder folder;
  folder.write("r.csv", csv);
  const std::string file = folder.write("s.toml", head + readings + "[trace]\n" + columns);
  const auto with = [&](const std::string& data) { return scenario::read(file, catalogue(), {data}); };
  const auto said = [&](const std::string& data) {
    try {
      with(data);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto old = scenario::read(file, catalogue()), same = with(folder.path() + "/r.csv");
  CHECK(same.hash == old.hash); // the same text and the same bytes
  CHECK(same.data == folder.path() + "/r.csv");
  const auto other = with(folder.write("other.csv", csv + "a,3,10,40,20,5\n"));
  CHECK(other.hash != old.hash);
  CHECK(other.readings.size() == old.readings.size() + 1);
  CHECK(other.trace.columns[0].values.size() == other.readings.size());
  // The scenario's own file need not be there.
  std::filesystem::remove(folder.path() + "/r.csv");
  CHECK(with(folder.path() + "/other.csv").hash == other.hash);
  CHECK(said(folder.path() + "/none.csv") == folder.path() + "/none.csv: error: the file does not exist.");
  const std::string lacking = said(folder.write("lacking.csv", "rod,setup,feed,z\na,1,10,1\n"));
  CHECK_THAT(lacking,
             Contains("s.toml:4:") && Contains("lacking.csv' has no column 't'") && Contains("has no column 'T'"));
  const std::string inline_file = folder.write("i.toml", head + one_reading);
  CHECK_THROWS_WITH(scenario::read(inline_file, catalogue(), {folder.path() + "/other.csv"}),
                    Contains("i.toml:4:12: error: indications.spindle_z: there is no data file for --data to replace"));
}
