/// The verdict of `gumshoe trace` for programs: its keys are a public interface.
#include <limits>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "made/traces.h"
#include "tracing/findings/verdict_json.h"

using namespace gumshoe;
using namespace gumshoe::tracing;
using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) names.push_back(name);
  return names;
}

/// The published keys stand first and in the published order; what is added follows them.
void starts_with(const Json& object, const std::vector<std::string>& published) {
  auto found = keys(object);
  REQUIRE(found.size() >= published.size());
  found.resize(published.size());
  CHECK(found == published);
}

Json of(const Trace& t) { return Json::parse(verdict_json(t)); }

} // namespace

TEST_CASE("the verdict has the published keys, whatever was found", "[tracing][verdict]") {
  for (const std::string& name : made::trace_names()) {
    CAPTURE(name);
    const Trace t = made::trace(name).trace;
    const Json json = of(t);
    starts_with(json, {"verdict", "findings", "rms", "detection_limits", "tried"});
    starts_with(json["rms"],
                {"unit", "before", "after", "noise", "holdout_before", "holdout_after", "worst_block_after"});
    for (const Json& finding : json["findings"]) {
      starts_with(finding, {"kind", "name", "members", "p_value", "depends_on", "suggestion", "quantities"});
      for (const Json& q : finding["quantities"]) starts_with(q, {"name", "value", "unit", "u", "interval95"});
    }
    for (const Json& d : json["detection_limits"])
      CHECK(keys(d) == std::vector<std::string>{"effect", "quantity", "value", "unit"});
    CHECK(json["tried"] == t.tried);
  }
}

TEST_CASE("the verdict is the first finding's kind, else that there is none", "[tracing][verdict]") {
  const std::pair<const char*, const char*> expected[] = {{"named", "named"},
                                                          {"class", "class"},
                                                          {"scatter", "scatter"},
                                                          {"not_in_catalogue", "not_in_catalogue"},
                                                          {"two_findings", "named"},
                                                          {"vetoed", "nothing_found"},
                                                          {"nothing_found", "nothing_found"},
                                                          {"insufficient_data", "insufficient_data"}};
  for (const auto& [name, word] : expected) CHECK(of(made::trace(name).trace)["verdict"] == word);
  CHECK(of(made::trace("two_findings").trace)["findings"][1]["kind"] == "not_in_catalogue");
}

TEST_CASE("sizes are in the unit shown, root mean squares in SI", "[tracing][verdict]") {
  Trace t = made::trace("named").trace;
  Json json = of(t);
  const Json& delay = json["findings"][0]["quantities"][0];
  CHECK(delay["unit"] == "ms"); // 1.52e-3 s inside
  CHECK(delay["value"].get<double>() == Approx(1.52));
  CHECK(delay["u"].get<double>() == Approx(0.041));
  CHECK(delay["interval95"][0].get<double>() == Approx(1.43));
  CHECK(delay["interval95"][1].get<double>() == Approx(1.61));
  CHECK(json["rms"]["unit"] == "m");
  CHECK(json["rms"]["before"] == t.rms.before);
  CHECK(json["detection_limits"][0]["value"].get<double>() == Approx(0.11));

  // A temperature that stands in the scenario is a point: 293.15 K is 20 degC, its uncertainty of 0.5 K is 0.5 degC.
  // What scatters by label is a difference: 0.5 K, not -272.65 degC.
  t.findings[0].quantities = {{"temperature", "degC", "K", 293.15, 0.5, 292.15, 294.15, "rod_expansion.at", {}},
                              {"standard deviation", "degC", "K", 0.5, 0.1, 0.3, 0.7, "", {}}};
  json = of(t)["findings"][0]["quantities"];
  CHECK(json[0]["value"].get<double>() == Approx(20));
  CHECK(json[0]["u"].get<double>() == Approx(0.5));
  CHECK(json[0]["interval95"][1].get<double>() == Approx(21));
  CHECK(json[1]["value"].get<double>() == Approx(0.5));
}

TEST_CASE("what is no number is null, and any text is valid JSON", "[tracing][verdict]") {
  const Json none = of(made::trace("insufficient_data").trace);
  CHECK(none["rms"]["before"].is_null());
  CHECK(none["rms"]["holdout_after"].is_null());
  CHECK(none["p_anything"].is_null());

  Trace t = made::trace("named").trace;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CHECK(of(t)["detection_limits"][2]["value"].is_null()); // infinite: not by these data
  t.findings[0].quantities[0].high95 = infinity;
  t.findings[0].quantities[0].unit = "no unit at all";
  t.findings[0].quantities[0].labels = {{"rod", "a \"b\"\n\\"}, {"latin", "\xe9"}};
  t.findings[0].suggestion = "tab\there";
  const Json q = of(t)["findings"][0]["quantities"][0];
  CHECK(q["interval95"][1].is_null());
  CHECK(q["unit"] == "s"); // a unit that does not convert loses no result
  CHECK(q["value"].get<double>() == Approx(1.52e-3));
  CHECK(q["labels"]["rod"] == "a \"b\"\n\\");
  CHECK(of(t)["findings"][0]["suggestion"] == "tab\there");
}
