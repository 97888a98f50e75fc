#include <catch2/catch.hpp>

#include <algorithm>

#include "unit/scenario_fixture.h"

using namespace scenario_fixture;
using quantities::Family;

namespace {
/// A scenario with one quantity stated as given.
scenario::Scenario with(const std::string& section) { return read_text(head + one_reading + section); }
const quantities::Entry& entry(const scenario::Scenario& s, const std::string& name) {
  return quantity(s, name).entries.at(0);
}
} // namespace

TEST_CASE("every quantity is there, in card order, then freed effects, then noise", "[scenario]") {
  const auto s = with("[quantities]\nrod_length = \"160.591 mm\"\n[effects.trigger_latency]\ndelay = \"1.5 "
                      "ms\"\n[effects.rod_runout]\nx = { u = \"2 um\" }\n");
  std::vector<std::string> names;
  for (const auto& q : s.quantities) names.push_back(q.name);
  CHECK(names == std::vector<std::string>{"rod_radius", "rod_length", "beam_pitch", "trigger_fraction", "rod_runout.x",
                                          "rod_runout.y", "trigger_latency.delay", "spindle_z"});
  CHECK(entry(s, "rod_length").value == 160.591 / 1000);
  CHECK(entry(s, "rod_radius").value == 5e-3);
  CHECK(entry(s, "rod_radius").components.empty());
  CHECK(entry(s, "trigger_latency.delay").value == 1.5 / 1000);
  CHECK(entry(s, "rod_runout.x").value == 0); // its null, where the scenario says only how uncertain
  CHECK(entry(s, "rod_runout.y").components.empty());
}

TEST_CASE("defaults of a scenario", "[scenario]") {
  const auto s = with("");
  CHECK(s.method == scenario::Method::propagation);
  CHECK(s.evaluation == "full");
  CHECK(s.run.samples == 1'000'000);
  CHECK(s.analysis.coverage_probability == 0.95);
  REQUIRE(s.readings.size() == 1);
  CHECK(s.readings[0].conditions == std::vector<double>{4e-3 / 60, 0});
  CHECK(s.readings[0].indications == std::vector<double>{-329.932 / 1000});
}

TEST_CASE("a single distribution becomes a value and a deviation", "[scenario]") {
  SECTION("normal from U and k") {
    const auto s = with("[quantities.rod_length]\nvalue = \"160 mm\"\nU = \"2 um\"\nk = 4\nsource = { certificate = "
                        "\"12\", date = 2026-01-15 }\n");
    const auto& c = entry(s, "rod_length").components.at(0);
    CHECK(c.name == "c1");
    CHECK(c.distribution.family == Family::normal);
    CHECK(c.distribution.parameters[1] == Approx(0.5e-6).epsilon(1e-15));
    CHECK(c.source == "certificate: 12, date: 2026-01-15");
    CHECK(c.evaluation == 'B');
  }
  SECTION("rectangular from its ends") {
    const auto s =
        with("[quantities.rod_radius]\ndistribution = \"rectangular\"\nlow = \"4.9 mm\"\nhigh = \"5.3 mm\"\n");
    const auto& e = entry(s, "rod_radius");
    CHECK(e.value == Approx(5.1e-3).epsilon(1e-15));
    CHECK(e.components.at(0).distribution.parameters[0] == Approx(-0.2e-3).epsilon(1e-13)); // difference of two ends
    CHECK(e.components.at(0).distribution.parameters[1] == -e.components.at(0).distribution.parameters[0]);
  }
  SECTION("a width about the value, a shape parameter") {
    const auto s = with("[quantities.trigger_fraction]\ndistribution = \"trapezoid\"\nvalue = 0.5\nhalf_width = "
                        "0.02\ntop_ratio = 0.25\n");
    const auto& d = entry(s, "trigger_fraction").components.at(0).distribution;
    CHECK(d.parameters == std::array<double, 4>{-0.02, 0.02, 0.25, 0});
  }
  SECTION("t carries its degrees of freedom, and the scale as u") {
    const auto s = with("[quantities.beam_pitch]\ndistribution = \"t\"\nvalue = \"1 deg\"\nu = \"0.1 "
                        "deg\"\ndegrees_of_freedom = 9\nevaluation = \"A\"\n");
    const auto& c = entry(s, "beam_pitch").components.at(0);
    CHECK(c.distribution.parameters[1] == Approx(0.1 * degree).epsilon(1e-15));
    CHECK(c.distribution.parameters[2] == 9);
    CHECK(c.degrees_of_freedom == 9);
    CHECK(c.evaluation == 'A');
  }
  SECTION("a truncated normal's value is the mean that is left") {
    const auto s = with("[quantities.rod_radius]\ndistribution = \"truncated_normal\"\nvalue = \"5 mm\"\nu = \"1 "
                        "mm\"\nlow = \"5 mm\"\nhigh = \"50 mm\"\n");
    const auto& e = entry(s, "rod_radius");
    // Half a normal: mean = 5 mm + u sqrt(2/pi), JCGM-independent closed form.
    CHECK(e.value == Approx(5e-3 + 1e-3 * std::sqrt(2 / 3.14159265358979323846)).epsilon(1e-12));
    CHECK(e.value + e.components.at(0).distribution.support_low() == Approx(5e-3).epsilon(1e-14));
    CHECK(e.components.at(0).distribution.mean() == Approx(0).margin(1e-14));
  }
  SECTION("families without a centre keep their values") {
    const auto s = with("[quantities.rod_length]\ndistribution = \"discrete\"\nvalues = [\"161 mm\", \"160 "
                        "mm\"]\nprobabilities = [0.25, 0.75]\n");
    const auto& e = entry(s, "rod_length");
    CHECK(e.value == 0);
    CHECK(*e.components.at(0).distribution.values == std::vector<double>{0.160, 0.161});
    CHECK(*e.components.at(0).distribution.probabilities == std::vector<double>{0.75, 0.25});
  }
  SECTION("lognormal from its median") {
    const auto s = with("[quantities.rod_radius]\ndistribution = \"lognormal\"\nmedian = \"5 mm\"\nsigma = 0.1\n");
    CHECK(entry(s, "rod_radius").components.at(0).distribution.parameters[0] == Approx(std::log(5e-3)).epsilon(1e-15));
  }
}

TEST_CASE("components add up, each with its own scope", "[scenario]") {
  const auto s = read_text(
      head + "[indications.spindle_z]\nreadings = [\"1 mm\"]\nlabels = { rod = \"a\", setup = \"1\" }\n"
             "[quantities.beam_pitch]\nvalue = \"0.2836 deg\"\ncomponents = [\n"
             "  { distribution = \"t\", u = \"0.002 deg\", degrees_of_freedom = 9, evaluation = \"A\", per = "
             "[\"setup\", \"rod\"], source = \"10 settings\" },\n"
             "  { distribution = \"rectangular\", half_width = \"0.001 deg\", per = \"reading\", name = \"level\" },\n"
             "  { distribution = \"triangular\", low = \"-0.001 deg\", high = \"0.003 deg\" },\n]\n");
  const auto& c = entry(s, "beam_pitch").components;
  REQUIRE(c.size() == 3);
  CHECK(c[0].name == "c1");
  CHECK(c[0].per == std::vector<std::string>{"setup", "rod"});
  CHECK(c[1].name == "level");
  CHECK(c[1].per == std::vector<std::string>{"reading"});
  CHECK(c[2].name == "c3");
  CHECK(c[2].per.empty());
  CHECK(c[2].distribution.parameters[0] == Approx(-0.001 * degree).epsilon(1e-15)); // a deviation need not be centred
  CHECK(c[2].distribution.parameters[1] == Approx(0.003 * degree).epsilon(1e-15));
}

TEST_CASE("observations are a Type A evaluation", "[scenario]") {
  // 5.001, 5.002, 5.003 mm: mean 5.002, s = 1 um, scale 1/sqrt(3) um, t with 2 degrees of freedom.
  const auto s =
      with("[quantities.rod_radius]\ncomponents = [ { observations = [\"5.001 mm\", \"5.002 mm\", \"5.003 mm\"] } ]\n");
  const auto& e = entry(s, "rod_radius");
  CHECK(e.value == Approx(5.002e-3).epsilon(1e-14));
  const auto& c = e.components.at(0);
  CHECK(c.evaluation == 'A');
  CHECK(c.distribution.family == Family::t);
  CHECK(c.distribution.parameters[1] == Approx(1e-6 / std::sqrt(3.0)).epsilon(1e-9)); // 1e-6 of 5e-3 loses 4 digits
  CHECK(c.distribution.parameters[2] == 2);
  CHECK(std::any_of(s.notes.begin(), s.notes.end(),
                    [](const std::string& note) { return note.find("no standard uncertainty") != std::string::npos; }));

  const auto around = with("[quantities.rod_radius]\nvalue = \"5 mm\"\ncomponents = [ { observations = [\"5.001 mm\", "
                           "\"5.002 mm\", \"5.003 mm\"] } ]\n");
  CHECK(entry(around, "rod_radius").value == 5e-3);
}

TEST_CASE("observations from a column of a data file", "[scenario]") {
  const Folder folder;
  folder.write("o.csv", "rod;radius\n1;5,001\n1;5,002\n1;5,003\n2;7\n");
  const auto read = [&](const std::string& where) {
    return scenario::read(folder.write("s.toml", head + one_reading + "[quantities.rod_radius]\nobservations = { file = \"o.csv\", "
                                       "column = \"radius\", unit = \"mm\", decimal = \",\"" + where + " }\n"), catalogue());
  };
  const auto s = read(", where = { rod = \"1\" }"), inside = with("[quantities.rod_radius]\nobservations = [\"5.001 mm\", "
                                                                 "\"5.002 mm\", \"5.003 mm\"]\n");
  CHECK(entry(s, "rod_radius").value == entry(inside, "rod_radius").value);
  CHECK(entry(s, "rod_radius").components.at(0).distribution.parameters ==
        entry(inside, "rod_radius").components.at(0).distribution.parameters);
  CHECK(s.hash != inside.hash);
  CHECK(entry(read(""), "rod_radius").components.at(0).degrees_of_freedom == 3);
  CHECK_THROWS_WITH(read(", where = { rod = \"3\" }"), Catch::Contains("has rod = '3'"));
  CHECK_THROWS_WITH(read(", where = { rod = \"2\" }"), Catch::Contains("1 observation(s) cannot show any scatter"));
  CHECK_THROWS_WITH(read(", where = { rod = \"1\", radius = \"7\" }"), Catch::Contains("no row of") && Catch::Contains("is left"));
}

TEST_CASE("simultaneous observations: correlation and joint distribution from the data", "[scenario]") {
  // GUM, H.2: V, I and phi as if they were a radius, a length and a pitch. r as published to six digits.
  const Folder folder;
  folder.write("h2.csv", "V,I,phi\n5.007,19.663,1.0456\n4.994,19.639,1.0438\n5.005,19.640,1.0468\n4.990,19.685,1.0428\n4.999,19.678,1.0433\n");
  const auto column = [](const char* name, const char* unit) {
    return std::string("{ observations = { file = \"h2.csv\", column = \"") + name + "\", unit = \"" + unit + "\" } }\n";
  };
  const std::string tied = "[[correlations]]\nquantities = [\"rod_radius\", \"rod_length\", \"beam_pitch\"]\nkind = \"observations\"\n";
  const auto s = scenario::read(folder.write("s.toml", head + one_reading + "[quantities]\nrod_radius = " + column("V", "mm") +
                                                           "rod_length = " + column("I", "mm") + "beam_pitch = " + column("phi", "rad") + tied),
                                catalogue());
  REQUIRE(s.correlations.size() == 1);
  CHECK(s.correlations[0].kind == quantities::Correlation::Kind::multivariate_t);
  CHECK_THAT(scenario::explain(s, catalogue()), Catch::Contains("rod_radius, rod_length, beam_pitch (multivariate_t): 1 "));
  const auto& r = s.correlations[0].matrix;
  CHECK(std::fabs(r[1] - -0.355311) < 5e-7);
  CHECK(std::fabs(r[2] - 0.857624) < 5e-7);
  CHECK(std::fabs(r[5] - -0.645111) < 5e-7);
  for (const auto& [name, u] : {std::pair{"rod_radius", 0.00320936e-3}, {"rod_length", 0.00947101e-3}, {"beam_pitch", 0.000752064}}) {
    const auto& c = entry(s, name).components.at(0);
    // The law of propagation takes s / sqrt(n) with n - 1; the joint t has n - N = 2 and a scale sqrt(4 / 2) times as large.
    CHECK(c.distribution.standard_uncertainty() == Approx(u).epsilon(2e-6));
    CHECK(c.degrees_of_freedom == 4);
    CHECK(c.distribution.parameters[1] == Approx(u * std::sqrt(2.0)).epsilon(2e-6));
    CHECK(c.distribution.parameters[2] == 2);
  }
  const auto refused = [](const std::string& radius, const std::string& length, const std::string& more) {
    return complaint(head + one_reading + "[quantities]\nrod_radius = " + radius + "\nrod_length = " + length +
                     "\n[[correlations]]\nquantities = [\"rod_radius\", \"rod_length\"]\nkind = \"observations\"\n" + more);
  };
  const std::string two = "{ observations = [\"1 mm\", \"2 mm\"] }", three = "{ observations = [\"1 mm\", \"2 mm\", \"4 mm\"] }";
  CHECK(refused(three, three, "").empty()); // r = 1: drawn exactly
  CHECK_THAT(refused(three, two, ""), Catch::Contains("rod_radius has 3 observations, rod_length has 2 (simultaneous observations come in sets)"));
  CHECK_THAT(refused(two, two, ""), Catch::Contains("2 simultaneous observations of 2 quantities"));
  CHECK_THAT(refused(three, "{ value = \"1 mm\", u = \"1 um\" }", ""), Catch::Contains("'rod_length' has no observations that scatter"));
  CHECK_THAT(refused(three, three, "coefficient = 0.5\n"), Catch::Contains("coefficient: the observations give it"));
}

TEST_CASE("relative uncertainties refer to the value", "[scenario]") {
  const auto scale = [](const scenario::Scenario& s, const char* name) {
    return entry(s, name).components.at(0).distribution.parameters[1];
  };
  CHECK(scale(with("[quantities.rod_length]\nu = \"0.1 %\"\nvalue = \"160 mm\"\n"), "rod_length") == Approx(160e-6).epsilon(1e-14));
  CHECK(scale(with("[quantities.rod_length]\nvalue = \"160 mm\"\nU = \"0.2 %\"\nk = 2\n"), "rod_length") == Approx(160e-6).epsilon(1e-14));
  CHECK(scale(with("[quantities.rod_length]\nvalue = \"160 mm\"\ndistribution = \"rectangular\"\nhalf_width = \"50 ppm\"\n"), "rod_length") ==
        Approx(8e-6).epsilon(1e-14));
  CHECK(scale(with("[quantities.beam_pitch]\nvalue = \"-2 deg\"\ncomponents = [ { u = \"1 %\" } ]\n"), "beam_pitch") ==
        Approx(0.02 * degree).epsilon(1e-14));
  // A slope is an angle; a share of a plain number that is written as one is absolute; otherwise it is relative, and said so.
  CHECK(scale(with("[quantities.beam_pitch]\nvalue = \"2 deg\"\nu = \"8 um/m\"\n"), "beam_pitch") == Approx(8e-6).epsilon(1e-14));
  CHECK(scale(with("[quantities.trigger_fraction]\nvalue = \"50 %\"\nu = \"2 %\"\n"), "trigger_fraction") == Approx(0.02).epsilon(1e-14));
  const auto share = with("[quantities.trigger_fraction]\nvalue = 0.4\nu = \"2 %\"\n");
  CHECK(scale(share, "trigger_fraction") == Approx(0.008).epsilon(1e-14));
  CHECK_THAT(share.notes.back(), Catch::Contains("'2 %' is taken as a share of the value: 0.008"));

  const auto refused = [](const std::string& text) { return complaint(head + one_reading + text); };
  CHECK_THAT(refused("[quantities.rod_length]\nu = \"0.1 %\"\n"),
             Catch::Contains("quantities.rod_length.u: '0.1 %' is a share of the value (no value is stated here). Use mm or um."));
  CHECK_THAT(refused("[effects.rod_runout]\nx = { value = \"0 um\", u = \"0.1 %\" }\n"), Catch::Contains("(the value is zero)"));
  CHECK_THAT(refused("[quantities.rod_length]\nvalue = \"5 %\"\n"),
             Catch::Contains("'5 %' is not a length (must convert to m). Use mm or um; only u, U and half_width may be a percentage"));
  CHECK_THAT(complaint(head + one_reading + "components = [ { u = \"0.1 %\" } ]\n"), Catch::Contains("no value is stated here"));
}

TEST_CASE("values by label", "[scenario]") {
  const std::string rows = "[indications.spindle_z]\nrows = [ { rod = \"rod 1\", setup = \"1\", values = [\"1 mm\"] }, "
                           "{ rod = \"rod 2\", setup = \"1\", feed = \"8 mm/min\", values = [\"2 mm\", \"4 mm\"] } ]\n";
  const auto s = read_text(head + rows +
                           "[quantities.rod_length.by.rod]\n\"rod 2\" = { value = \"180 mm\", U = \"2 um\", k = 2 "
                           "}\n\"rod 1\" = \"160 mm\"\n"
                           "[quantities.beam_pitch.by.setup.1.by.rod]\n\"rod 1\" = \"1 deg\"\n\"rod 2\" = \"2 deg\"\n");
  REQUIRE(s.readings.size() == 2);
  CHECK(s.readings[1].repeats == 2);
  CHECK(s.readings[1].indications[0] == Approx(3e-3).epsilon(1e-15));
  CHECK(s.readings[1].conditions[0] == 8.0 / 60000);
  const auto& length = quantity(s, "rod_length").entries;
  REQUIRE(length.size() == 2);
  CHECK(length[0].labels == quantities::Labels{{"rod", "rod 2"}});
  CHECK(length[0].components.size() == 1);
  CHECK(length[1].value == 0.160);
  const auto& pitch = quantity(s, "beam_pitch").entries;
  REQUIRE(pitch.size() == 2);
  CHECK(pitch[1].labels == quantities::Labels{{"setup", "1"}, {"rod", "rod 2"}});
}

TEST_CASE("the row of a by-table for every other value", "[scenario]") {
  const auto of = [](const std::string& table) {
    return head + "[indications.spindle_z]\nrows = [ { rod = \"rod 1\", values = [\"1 mm\"] }, { rod = \"rod 2\", "
                  "values = [\"2 mm\"] }, { rod = \"rod 3\", values = [\"3 mm\"] } ]\n[quantities.rod_length.by.rod]\n" +
           table;
  };
  const auto s = read_text(of("\"rod 2\" = \"160 mm\"\n\"*\" = { value = \"150 mm\", u = \"2 mm\" }\n"));
  const auto& length = quantity(s, "rod_length").entries;
  REQUIRE(length.size() == 3); // each other rod has a draw of its own
  CHECK(length[0].labels == quantities::Labels{{"rod", "rod 2"}});
  CHECK(length[1].labels == quantities::Labels{{"rod", "rod 1"}});
  CHECK(length[2].labels == quantities::Labels{{"rod", "rod 3"}});
  CHECK(length[2].value == 0.150);
  CHECK(length[2].components.size() == 1);
  // Where every rod has its own the row says nothing, and is right or wrong all the same.
  const std::string all = "\"rod 1\" = \"1 mm\"\n\"rod 2\" = \"1 mm\"\n\"rod 3\" = \"1 mm\"\n";
  const auto none = read_text(of(all + "\"*\" = \"150 mm\"\n"));
  CHECK(quantity(none, "rod_length").entries.size() == 3);
  CHECK(none.notes.size() == read_text(of(all)).notes.size());
  CHECK_THAT(complaint(of(all + "\"*\" = \"150 deg\"\n")), Catch::Contains("quantities.rod_length.by.rod.*: '150 deg'"));
}

TEST_CASE("explain shows SI values, defaults and effects left out", "[scenario]") {
  const auto s = with("[quantities.beam_pitch]\nvalue = \"0.2836 deg\"\nu = \"0.002 deg\"\nsource = "
                      "\"level\"\n[effects.rod_runout]\nx = { u = \"2 um\" }\n");
  const std::string text = scenario::explain(s, catalogue());
  CHECK_THAT(text, Catch::Contains("rod_radius = 0.005 m (5 mm), default, exact"));
  CHECK_THAT(text, Catch::Contains("beam_pitch = 0.00494975375866 rad (0.2836 deg)"));
  CHECK_THAT(text, Catch::Contains("u 3.49066e-05 rad, Type B, one draw, source: level"));
  CHECK_THAT(text, Catch::Contains("feed 6.66666666667e-05 m/s (4 mm/min)"));
  CHECK_THAT(text, Catch::Contains("effects at their null value\n  trigger_latency\n"));
}

TEST_CASE("a correlation says of the rods that were measured what it said of all", "[scenario]") {
  const auto of = [](const std::string& quantities, const std::string& matrix) {
    return head + "[indications.spindle_z]\nrows = [ { rod = \"rod 1\", values = [\"1 mm\"] }, { rod = \"rod 3\", values = "
                  "[\"3 mm\"] } ]\n[quantities.rod_length.by.rod]\n\"rod 1\" = { value = \"1 mm\", u = \"1 um\" }\n"
                  "\"rod 2\" = { value = \"2 mm\", u = \"1 um\" }\n\"rod 3\" = { value = \"3 mm\", u = \"1 um\" }\n"
                  "[[correlations]]\nkind = \"pearson\"\nquantities = [" + quantities + "]\nmatrix = [" + matrix + "]\n";
  };
  const auto s = read_text(of("\"rod_length[rod 1]\", \"rod_length[rod 2]\", \"rod_length[rod 3]\"",
                              "[1, 0.5, 0.2], [0.5, 1, 0.3], [0.2, 0.3, 1]"));
  REQUIRE(s.correlations.size() == 1);
  CHECK(s.correlations[0].quantities == std::vector<std::string>{"rod_length[rod 1]", "rod_length[rod 3]"});
  CHECK(s.correlations[0].matrix == std::vector<double>{1, 0.2, 0.2, 1});
  CHECK(std::ranges::any_of(s.notes, [](const std::string& note) {
    return note.find("1 of 3 are left out, because no reading has them, such as 'rod_length[rod 2]'") != std::string::npos;
  }));
  // Nothing is left of a pair of which one was not measured.
  CHECK(read_text(of("\"rod_length[rod 1]\", \"rod_length[rod 2]\"", "[1, 0.5], [0.5, 1]")).correlations.empty());
  // A name that no table has is a mistake as before.
  CHECK_THAT(complaint(of("\"rod_length[rod 1]\", \"rod_length[rod 4]\"", "[1, 0.5], [0.5, 1]")),
             Catch::Contains("'rod_length[rod 4]' is not a quantity here"));
}

TEST_CASE("correlations name their kind", "[scenario]") {
  const std::string pair = "[quantities]\nrod_radius = { u = \"1 um\" }\nrod_length = { u = \"1 um\" "
                           "}\n[[correlations]]\nquantities = [\"rod_radius\", \"rod_length\"]\n";
  const auto s = with(pair + "kind = \"spearman\"\ncoefficient = -0.5\n");
  REQUIRE(s.correlations.size() == 1);
  CHECK(s.correlations[0].kind == quantities::Correlation::Kind::spearman);
  CHECK(s.correlations[0].matrix == std::vector<double>{1, -0.5, -0.5, 1});
  CHECK_THAT(scenario::explain(s, catalogue()), Catch::Contains("rod_radius, rod_length (spearman): 1 -0.5; -0.5 1"));
  std::string names;
  for (int i = 0; i < 3000; ++i) names += "\"unknown " + std::to_string(i) + "\", ";
  CHECK_THAT(complaint(head + one_reading + "[[correlations]]\nkind = \"copula\"\ncoefficient = 0.5\nquantities = [" + names + "]\n"),
             Catch::Contains("'unknown 0' is not a quantity here")); // and no matrix of nine million numbers
  CHECK_THAT(complaint(head + one_reading + pair + "coefficient = 0.5\n"),
             Catch::Contains("correlations[1].kind is missing"));
  CHECK_THAT(complaint(head + one_reading + pair + "kind = \"pearson\"\ncoefficient = 1.5\n"),
             Catch::Contains("must lie between -1 and 1"));
  CHECK_THAT(complaint(head + one_reading + pair + "kind = \"pearson\"\nmatrix = [[1, 0.5], [0.4, 1]]\n"),
             Catch::Contains("symmetric"));
}
