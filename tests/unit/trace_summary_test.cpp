/// What a trace says to a machinist.
#include <algorithm>
#include <string>
#include <tuple>

#include <catch2/catch.hpp>

#include "made/traces.h"
#include "tracing/findings/findings.h"

using namespace gumshoe;
using namespace gumshoe::tracing;

TEST_CASE("scatter names what may be there in its place", "[tracing][verdict]") {
  const std::pair<const char*, const char*> expected[] = {
      {"step:time after reading 27", "or something changed after reading 27"},
      {"pulse:time about reading 9", "or something came and went about reading 9"},
      {"shift:time about reading 9", "or something changed about reading 9"},
      {"step:setup 3", "or setup 3 differs from the others, which agree"},
      {"line:time", "or the readings follow time"},
      {"thermal_drift", "or thermal_drift is there"}};
  for (const auto& [shape, words] : expected) {
    Trace t = made::trace("scatter").trace;
    t.findings[0].members = {"scatter:setup", shape};
    CAPTURE(shape);
    summarise(t);
    CHECK(std::ranges::any_of(t.plain, [&](const std::string& line) { return line.find(words) != line.npos; }));
  }
}

TEST_CASE("readings that scatter more than declared do not agree", "[tracing][verdict]") {
  Trace t = made::trace("nothing_found").trace;
  t.noise.scale = 2.7;
  for (const double p : {0.5, 0.02}) {
    t.noise.chi_squared_p = p;
    summarise(t);
    CAPTURE(p, t.plain[0]);
    const bool larger =
        t.plain[0].find(
            "2.7 times as large as declared, but noise as declared gives residuals this large in only 2 %") !=
        std::string::npos;
    CHECK(larger == (p < t.alpha));
    CHECK((t.plain[0].find("agree with the model") == std::string::npos) == larger);
  }
}

TEST_CASE("scatter that the noise holds is told where nothing is found", "[tracing][verdict]") {
  Trace t = made::trace("nothing_found").trace;
  const double noise = t.rms.noise;
  for (const double share : {0.0, 0.4, 0.6}) {
    t.noise.scatter = share > 0 ? "day,operator" : "";
    t.noise.scatter_u = share * noise;
    summarise(t);
    CAPTURE(share, t.plain[0]);
    CHECK((t.plain[0].find("from one day and operator to the next, which may be chance") != std::string::npos) ==
          (share > 0.5));
  }
}

TEST_CASE("what the held-out readings do not confirm is nothing to correct for yet", "[tracing][verdict]") {
  for (const char* name : {"named", "two_findings"}) {
    Trace t = made::trace(name).trace;
    for (const bool unconfirmed : {false, true}) {
      t.unconfirmed = unconfirmed;
      summarise(t);
      CAPTURE(name, unconfirmed);
      CHECK(unconfirmed == std::ranges::any_of(t.plain, [](const std::string& line) {
              return line.find("measure another block before you correct for anything") != line.npos;
            }));
    }
  }
}

TEST_CASE("where nothing is found, the sentence says how seldom noise alone gives such residuals",
          "[tracing][verdict]") {
  Trace t = made::trace("nothing_found").trace;
  t.outliers.clear();
  t.rms.holdout_after_winsorised = 0;
  t.rms.noise_high = 0.68e-6;
  for (const auto& [p, before, words] :
       {std::tuple(0.019, 2.3e-6,
                   "in 95 % of cases): noise alone gives residuals like these in only 1.9 % of cases: the model"),
        std::tuple(0.2, 2.3e-6, "in 95 % of cases): the model or the declared noise lacks"), // far beyond one in forty
        std::tuple(0.2, 0.7e-6, "noise alone gives as much in one case of forty, or the model")}) {
    t.p_anything = p;
    t.rms.before = t.rms.after = before;
    summarise(t);
    CAPTURE(t.plain[0]);
    CHECK(t.plain[0].find(words) != std::string::npos);
  }
}

TEST_CASE("a sentence names what these data cannot distinguish from it", "[tracing][verdict]") {
  const auto said = [](const char* shape, const char* depends_on, std::vector<RivalShape> rivals) {
    Trace t = made::trace("not_in_catalogue").trace;
    t.findings.resize(1);
    Finding& f = t.findings[0];
    f.described_by = shape;
    f.depends_on = {depends_on};
    f.rivals = std::move(rivals);
    summarise(t);
    return t.plain[0];
  };
  CHECK(said("step:operator Bob", "operator",
             {{"step:machine M2", true}, {"step:order with operator Ann after reading 2", false}}) ==
        "operator Bob or machine M2, which are never apart in these data, differs from the others by a constant.");
  CHECK(said("polynomial:time", "time",
             {{"polynomial:temp", false}, {"drift:temp (saturating, time constant 9 s)", false}}) ==
        "An unknown effect changes the readings with time; these data cannot distinguish it from an effect of temp.");
  CHECK(said("step:machine M1", "machine", {{"step:operator Ann, machine M1", true}, {"step:operator Bob", false}}) ==
        "machine M1 differs from the others by a constant; these data cannot distinguish it from a constant difference "
        "of operator Bob.");
  CHECK(said("step:time after reading 9", "time", {{"step:machine M2", false}, {"polynomial:1/temp^2", false}}) ==
        "Something changed after reading 9: from then on the readings differ by a constant; these data cannot "
        "distinguish it from a constant difference of machine M2 or an effect of temp.");
  CHECK(
      said("drift:time", "time",
           {{"while:order from reading 9 to reading 20", false}, {"bend:order with tool T2 after reading 4", false}}) ==
      "An unknown effect changes the readings with time; these data cannot distinguish it from a difference from "
      "reading 9 to reading 20.");
  // What is the same in every reading is of another sort than a group: it is told apart from the subject.
  CHECK(said("step:operator Bob", "operator", {{"polynomial:load", true}}) ==
        "operator Bob differs from the others by a constant; these data cannot distinguish it from an effect of load.");
}

TEST_CASE("limits are spoken of where there are some", "[tracing][verdict]") {
  Trace t = made::trace("nothing_found").trace;
  summarise(t);
  CHECK(t.plain.back().find("the table lists those limits") != std::string::npos);
  t.detection_limits.clear();
  summarise(t);
  CHECK(t.plain.back().find("limits") == std::string::npos);
  CHECK(t.plain.back().find("small compared with the noise") != std::string::npos);
}
