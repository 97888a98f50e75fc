#include <catch2/catch.hpp>

#include "unit/scenario_fixture.h"

using namespace scenario_fixture;
using Catch::Contains;

namespace {
std::string with(const std::string& section) { return complaint(head + one_reading + section); }
std::string of_file(const std::string& path) {
  try {
    scenario::read(path, catalogue());
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}
} // namespace

TEST_CASE("problems come all at once, each with its place", "[scenario][errors]") {
  CHECK(complaint("schema = 1\n"
                  "[model]\n"
                  "name = \"rod\"\n"
                  "[indications.spindle_z]\n"
                  "readings = [\"1 mm\"]\n"
                  "[quantities.rod_radius]\n"
                  "distribution = \"rectangular\"\n"
                  "low    = \"4 N\"\n"
                  "high   = \"5 mm\"\n"
                  "hihg   = \"5 mm\"\n"
                  "[quantities]\n"
                  "rod_lenght = \"5 mm\"\n") ==
        "s.toml:8:10: error: quantities.rod_radius.low: '4 N' is not a length (must convert to m). Use mm or um.\n"
        "s.toml:10:1: error: quantities.rod_radius: unknown key 'hihg'. Did you mean 'high'?\n"
        "s.toml:12:1: error: quantities: unknown key 'rod_lenght'. Did you mean 'rod_length'?");
}

TEST_CASE("a catalogue without results has none to read", "[scenario][errors]") {
  CHECK_THAT(with("[quantities]\nrod_radius = { from = \"a.h5:y\" }\n"),
             Contains("s.toml:6:23: error: quantities.rod_radius.from: results cannot be read here"));
}

TEST_CASE("unknown names anywhere are refused with the nearest", "[scenario][errors]") {
  CHECK_THAT(with("[runn]\n"), Contains("s.toml:5:2: error: unknown key 'runn'. Did you mean 'run'?"));
  CHECK_THAT(with("[run]\nsampels = 3\n"), Contains("run: unknown key 'sampels'. Did you mean 'samples'?"));
  CHECK_THAT(with("[quantities.rod_radius]\nvalue = \"5 mm\"\nuu = \"1 um\"\n"), Contains("unknown key 'uu'. Did you mean 'u'?"));
  CHECK_THAT(with("[effects.trigger_latncy]\ndelay = \"1 ms\"\n"), Contains("Did you mean 'trigger_latency'?"));
  CHECK_THAT(with("[effects.trigger_latency]\ndelya = \"1 ms\"\n"), Contains("Did you mean 'delay'?"));
  CHECK_THAT(with("[effects.orientation]\ndelay = \"1 ms\"\n"), Contains("rod cannot carry it (it has no stage 'spindle')"));
  CHECK_THAT(with("[conditions]\nfeeed = \"1 mm/min\"\n"), Contains("Did you mean 'feed'?"));
  CHECK_THAT(with("[quantities.rod_radius]\ndistribution = \"rectangle\"\nlow = \"1 mm\"\n"),
             Contains("Did you mean 'rectangular'?"));
  CHECK_THAT(with("[analysis]\nsensitivity = { soboll = 3 }\n"), Contains("Did you mean 'sobol'?"));
  CHECK_THAT(with("[analysis]\ncomparisons = [ { measurand = \"laserz\", between = \"rod\" } ]\n"),
             Contains("Did you mean 'laser_z'?") && Contains("no reading has the label 'rod'"));
  CHECK_THAT(complaint("schema = 1\nmodel = { name = \"rods\" }\n"),
             Contains("s.toml:2:18: error: model.name: 'rods' is unknown. Did you mean 'rod'?"));
  CHECK_THAT(complaint("schema = 2\nmodel = { name = \"rod\" }\n" + one_reading),
             Contains("s.toml:1:10: error: schema: this program does not know version 2 of the format (Gumshoe ") &&
                 Contains(" reads version 1). Use a newer Gumshoe, or write schema = 1 if the scenario is of version 1."));
  // What is unknown here may be known there: only the version is told.
  CHECK_THAT(complaint("schema = 3\n[newer]\nx = 1\n"), !Contains("newer]") && !Contains("unknown"));
  CHECK_THAT(complaint("schema = 0\nmodel = { name = \"rod\" }\n" + one_reading), Contains("Write schema = 1."));
  CHECK_THAT(complaint("title = \"x\"\n"), Contains("schema is missing") && Contains("model is missing"));
}

TEST_CASE("wrong types and units", "[scenario][errors]") {
  CHECK_THAT(with("[quantities]\nrod_radius = 5\n"), Contains("5 is not a length"));
  CHECK_THAT(with("[quantities]\nrod_radius = \"5\"\n"), Contains("'5' is not a length"));
  CHECK_THAT(with("[quantities]\nrod_radius = \"5 foo\"\n"), Contains("'foo' is not a unit"));
  CHECK_THAT(with("[quantities]\nrod_radius = true\n"), Contains("true or false is not a length"));
  CHECK_THAT(with("[quantities]\nbeam_pitch = \"0.1\"\n"), Contains("is not an angle"));
  CHECK_THAT(with("[quantities]\ntrigger_fraction = \"0.5 deg\"\n"), Contains("is not a plain number"));
  CHECK_THAT(with("[quantities]\nrod_radius = \"nan mm\"\n"), Contains("not finite"));
  CHECK_THAT(with("[quantities]\ntrigger_fraction = nan\n"), Contains("the number is not finite"));
  CHECK_THAT(with("[quantities]\ntrigger_fraction = inf\n"), Contains("the number is not finite"));
  CHECK_THAT(with("[run]\nsamples = \"many\"\n"), Contains("a number without a unit is expected"));
  CHECK_THAT(with("[run]\nsamples = 1.5\n"), Contains("not a whole number"));
  CHECK_THAT(with("[run]\nsamples = 0\n"), Contains("must lie between"));
  CHECK_THAT(with("run = 3\n"), Contains("unknown key 'run'")); // inside the table of indications, as TOML has it
  CHECK_THAT(complaint("run = 3\n" + head + one_reading),
             Contains("s.toml:1:7: error: run: a table is expected, not an integer"));
  CHECK_THAT(with("[analysis]\ncoverage_probability = 1\n"), Contains("must lie between 0 and 1"));
}

TEST_CASE("impossible values are refused with the limit", "[scenario][errors]") {
  CHECK_THAT(with("[quantities]\nrod_radius = \"-5 mm\"\n"),
             Contains("s.toml:6:14: error: quantities.rod_radius: -5 mm is impossible (must be above 0 mm)"));
  CHECK_THAT(with("[quantities]\ntrigger_fraction = 1\n"),
             Contains("(must be below 1 1)") || Contains("(must be below 1)"));
  CHECK_THAT(with("[quantities]\ntrigger_fraction = 0.0\n"), Contains("is impossible (must be above 0"));
  CHECK_THAT(with("[effects.trigger_latency]\ndelay = \"20 ms\"\n"), Contains("must be at most"));
  CHECK_THAT(with("[quantities.rod_radius]\ndistribution = \"rectangular\"\nvalue = \"1 mm\"\nhalf_width = \"2 mm\"\n"),
             Contains("the distribution reaches -1 mm (must be above 0 mm)"));
  CHECK(with("[quantities.trigger_fraction]\ndistribution = \"rectangular\"\nlow = 0\nhigh = 1\n")
            .empty()); // ends are never drawn
}

TEST_CASE("statements of uncertainty that say too little or too much", "[scenario][errors]") {
  const auto radius = [](const std::string& text) {
    return with("[quantities.rod_radius]\nvalue = \"5 mm\"\n" + text);
  };
  CHECK_THAT(radius("u = \"-1 um\"\n"), Contains("s.toml:7:5: error: quantities.rod_radius.u: must be above 0"));
  CHECK_THAT(radius("U = \"1 um\"\n"), Contains("coverage factor is missing"));
  CHECK_THAT(radius("U = \"1 um\"\nk = 0\n"), Contains("must be above 0"));
  CHECK_THAT(radius("u = \"1 um\"\nk = 2\n"), Contains("k belongs to an expanded uncertainty"));
  CHECK_THAT(radius("u = \"1 um\"\nU = \"1 um\"\nk = 2\n"), Contains("both u and U are given"));
  CHECK_THAT(radius("distribution = \"rectangular\"\nhalf_width = \"0 mm\"\n"),
             Contains("half_width: must be above 0"));
  CHECK_THAT(radius("distribution = \"rectangular\"\n"), Contains("half_width is missing"));
  CHECK_THAT(radius("distribution = \"rectangular\"\nlow = \"1 mm\"\nhigh = \"6 mm\"\n"),
             Contains("value is given together with low and high"));
  CHECK_THAT(radius("distribution = \"t\"\nu = \"1 um\"\n"), Contains("degrees_of_freedom is missing"));
  CHECK_THAT(radius("distribution = \"trapezoid\"\nhalf_width = \"1 um\"\ntop_ratio = 2\n"), Contains("top_ratio"));
  CHECK_THAT(radius("distribution = \"normal\"\nu = \"1 um\"\nhalf_width = \"1 um\"\n"),
             Contains("the key 'half_width' means nothing together with the others"));
  CHECK_THAT(radius("u = \"1 um\"\ncomponents = [ { u = \"1 um\" } ]\n"), Contains("'u' is given together with components"));
  CHECK_THAT(radius("components = [ { source = \"?\" } ]\n"), Contains("the distribution is missing"));
  CHECK_THAT(radius("components = [ { u = \"1 um\", name = \"a\" }, { u = \"1 um\", name = \"a\" } ]\n"),
             Contains("is already used"));
  CHECK_THAT(radius("components = [ { observations = [\"1 mm\"] } ]\n"), Contains("cannot show any scatter"));
  CHECK_THAT(radius("u = \"1 um\"\nper = \"setup\"\n"), Contains("no reading has the label 'setup'"));
  CHECK_THAT(with("[quantities.rod_length]\ndistribution = \"discrete\"\nvalues = [\"1 mm\", \"2 mm\"]\nprobabilities "
                  "= [0.5, 0.6]\n"),
             Contains("add up to 1.1"));
  CHECK_THAT(with("[quantities.rod_length]\ndistribution = \"rectangular\"\nlow = \"2 mm\"\nhigh = \"1 mm\"\n"),
             Contains("low must be below high"));
}

TEST_CASE("labels that no reading has, and readings that no label value covers", "[scenario][errors]") {
  const std::string rows = head + "[indications.spindle_z]\nrows = [ { rod = \"rod 1\", values = [\"1 mm\"] }, { rod = "
                                  "\"rod 2\", values = [\"1 mm\"] } ]\n";
  CHECK_THAT(complaint(rows + "[quantities.rod_length.by.rod]\n\"rod 1\" = \"1 mm\"\n\"rod 3\" = \"1 mm\"\n"),
             Contains("no reading has rod = 'rod 3'") && Contains("no value for rod = 'rod 2'"));
  // Rod 3 was not measured. That is no mistake, because no rod that was measured lacks a value.
  CHECK_THAT(
      complaint(rows +
                "[quantities.rod_length.by.rod]\n\"rod 1\" = \"1 mm\"\n\"rod 2\" = \"1 mm\"\n\"rod 3\" = \"1 mm\"\n"),
      !Contains("rod 3"));
  CHECK_THAT(complaint(rows + "[quantities.rod_length.by.rood]\n\"rod 1\" = \"1 mm\"\n"),
             Contains("Did you mean 'rod'?"));
  CHECK_THAT(
      complaint(rows +
                "[quantities.rod_length]\nvalue = \"1 mm\"\nby.rod = { \"rod 1\" = \"1 mm\", \"rod 2\" = \"1 mm\" }\n"),
      Contains("the key 'value' means nothing together with the others"));
}

TEST_CASE("data files that are missing or wrong", "[scenario][errors]") {
  const Folder folder;
  const auto reading = [&](const std::string& rest) {
    return of_file(
        folder.write("s.toml", head + "[indications.spindle_z]\nreadings = { file = \"d.csv\", " + rest + " }\n"));
  };
  const std::string good = "column = \"z\", unit = \"mm\"";
  CHECK_THAT(reading(good), Contains("s.toml:4:21: error: indications.spindle_z.readings.file:") &&
                                Contains("d.csv': the file does not exist"));
  folder.write("d.csv", "rod,z\na,1\nb,one\n");
  CHECK_THAT(reading(good), Contains("d.csv:3:3: error: 'one' is not a number"));
  CHECK_THAT(reading("column = \"zz\", unit = \"mm\""), Contains("has no column 'zz'. Did you mean 'z'?"));
  CHECK_THAT(reading("column = \"z\""), Contains("unit is missing"));
  CHECK_THAT(reading("column = \"z\", unit = \"s\""), Contains("'s' is not a length"));
  folder.write("d.csv", "rod,z\na,1\nb,2\n");
  CHECK_THAT(reading(good + ", labels = { rod = \"rood\" }"), Contains("Did you mean 'rod'?"));
  CHECK_THAT(reading(good + ", labels = { rod = \"rod\" }, where = { rod = \"c\" }"), Contains("has rod = 'c'"));
  CHECK_THAT(reading(good + ", labels = { rod = \"rod\" }, where = { rood = \"a\" }"), Contains("'rood' is neither a label of these readings nor a column"));
  CHECK_THAT(reading(good + ", labels = { rod = \"rod\" }, where = { rod = 1 }"),
             Contains("text is expected, not an integer"));
  CHECK_THAT(reading(good + ", wheer = { rod = \"a\" }"), Contains("Did you mean 'where'?"));
  folder.write("d.csv", "rod,z\na,1,2\n");
  CHECK_THAT(reading(good), Contains("d.csv:2:1: error: the row has 3 cells, the header 2"));
  folder.write("d.csv", std::string("z\n\0\n", 4));
  CHECK_THAT(reading(good), Contains("NUL bytes"));
}

TEST_CASE("files that are no scenario", "[scenario][errors]") {
  const Folder folder;
  CHECK_THAT(of_file(folder.write("a.toml", "")), Contains("the scenario is empty"));
  CHECK_THAT(of_file(folder.write("a.toml", "# nothing\n")), Contains("the scenario is empty"));
  CHECK_THAT(of_file(folder.write("a.toml", std::string("a = 1\n\0\x01", 8))), Contains("not text"));
  CHECK_THAT(of_file(folder.write("a.toml", std::string(10'000'000, 'x'))), Contains("too large"));
  CHECK_THAT(of_file(folder.write("a.toml", std::string(3'000'000, 'x'))), Contains("error:"));
  CHECK_THAT(of_file(folder.write("a.toml", "a = " + std::string(100'000, '['))), Contains("a.toml:1:"));
  CHECK_THAT(of_file(folder.write("a.toml", "\xff\xfe\x80")), Contains("error:"));
  // A control character where a key begins reaches an assertion inside toml++ 3.3.
  CHECK_THAT(of_file(folder.write("a.toml", "[\x19"
                                            "analysis]\n")),
             Contains("the file is not valid TOML"));
  CHECK_THAT(of_file(folder.path()), Contains("a directory"));
  CHECK_THAT(of_file(folder.path() + "/none.toml"), Contains("the file does not exist"));
  CHECK_THAT(complaint("schema = 1\nschema = 1\n"),
             Contains("s.toml:2:10: error: cannot redefine existing integer 'schema'"));
  CHECK_THAT(with("[quantities]\nrod_radius = \"5 mm\"\nrod_radius = \"6 mm\"\n"),
             Contains("s.toml:7:14: error: cannot redefine"));
}

TEST_CASE("a scenario without fault has no complaint", "[scenario][errors]") { CHECK(with("").empty()); }

TEST_CASE("Sobol' indices of correlated inputs are refused when the scenario is read", "[scenario][errors]") {
  const std::string tied = "[[correlations]]\nquantities = [\"rod_radius\", \"rod_length\"]\nkind = \"copula\"\n"
                           "matrix = [[1, 0.5], [0.5, 1]]\n[analysis]\n";
  CHECK_THAT(with(tied + "sensitivity = { sobol = 1024 }\n"),
             Contains("s.toml:10:25: error: analysis.sensitivity.sobol: the inputs are correlated") &&
                 Contains("Try: sensitivity = { shapley = 4096 }"));
  CHECK_THAT(with(tied + "sensitivity = { shapley = 1024 }\n"), !Contains("correlated"));
}
