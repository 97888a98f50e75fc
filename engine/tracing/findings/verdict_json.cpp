#include "tracing/findings/verdict_json.h"

#include "analysis/fields_json.h"
#include "base/json_text.h"
#include "base/units.h"
#include "tracing/findings/trace_fields.h"

namespace gumshoe::tracing {

namespace {

using analysis::Json;
using analysis::number;

Json pair(double low, double high) { return Json::array({number(low), number(high)}); }

Json quantities_json(const std::vector<SizedQuantity>& quantities) {
  Json list = Json::array();
  for (const SizedQuantity& q : quantities) {
    const ShownSize s = shown(q);
    Json labels = Json::object();
    for (const auto& [label, value] : q.labels) labels[label] = value;
    list.push_back({{"name", q.name},
                    {"value", number(s.value)},
                    {"unit", s.unit},
                    {"u", number(s.u)},
                    {"interval95", pair(s.low95, s.high95)},
                    {"scenario_name", q.scenario_name},
                    {"labels", labels}});
  }
  return list;
}

/// Published keys stand first, in the published order; the tables of fields fill them in.
Json finding_json(const Finding& f) {
  Json alternatives = Json::array();
  for (std::size_t i = 0; i < f.alternatives.size(); ++i)
    alternatives.push_back(
        {{"name", i < f.members.size() ? f.members[i] : ""}, {"quantities", quantities_json(f.alternatives[i])}});
  Json out{{"kind", nullptr},           {"name", nullptr},
           {"members", f.members},      {"p_value", nullptr},
           {"depends_on", f.depends_on}, {"suggestion", nullptr},
           {"quantities", quantities_json(f.quantities)}, {"alternatives", alternatives},
           {"removed_share", nullptr},  {"remarks", f.remarks}};
  add_json(out, finding_fields, f);
  return out;
}

Json rms_json(Rms r) {
  const std::string unit = r.si_unit; // empty where nothing was fitted
  r.unit = r.si_unit = unit.empty() ? "1" : unit;
  Json out = json(rms_fields, r);
  out["unit"] = unit;
  return out;
}

Json limits_json(const std::vector<DetectionLimit>& limits) {
  Json list = Json::array();
  for (DetectionLimit d : limits) {
    if (!units::convertible(d.unit, d.si_unit)) d.unit = d.si_unit;
    list.push_back({{"effect", nullptr}, {"quantity", nullptr}, {"value", nullptr}, {"unit", nullptr}});
    add_json(list.back(), limit_fields, d);
  }
  return list;
}

} // namespace

std::string verdict(const Trace& t) {
  if (!t.findings.empty()) return name(t.findings.front().kind);
  if (t.lack_of_fit.found) return "lack_of_fit";
  if (!t.anomalous_blocks.empty()) return "anomalous_block";
  return t.outcome == Outcome::insufficient_data ? "insufficient_data" : "nothing_found";
}

ShownSize shown(const SizedQuantity& q) {
  using units::Kind;
  const Kind kind = q.shift || q.scenario_name.empty() ? Kind::difference : Kind::point;
  try {
    const auto convert = [&](double x, Kind k) { return units::from_si(x, q.unit, q.si_unit, k); };
    return {q.unit, convert(q.value, kind), convert(q.u, Kind::difference), convert(q.low95, kind),
            convert(q.high95, kind)};
  } catch (const InputError&) {
    return {q.si_unit, q.value, q.u, q.low95, q.high95};
  }
}

ShownSize shown(const DetectionLimit& d) {
  return shown(SizedQuantity{d.quantity, d.unit, d.si_unit, d.value, 0, 0, 0, "", {}, false});
}

std::string verdict_json(const Trace& t) {
  Json findings = Json::array();
  for (const Finding& f : t.findings) findings.push_back(finding_json(f));
  Json out{{"verdict", nullptr},
           {"findings", findings},
           {"rms", rms_json(t.rms)},
           {"detection_limits", limits_json(t.detection_limits)}};
  add_json(out, trace_fields, t);
  const std::string unit = t.rms.si_unit.empty() ? "1" : t.rms.si_unit; // empty where nothing was fitted
  if (!t.of_indications.empty()) out["of_indications"] = Json::array();
  for (const IndicationError& e : t.of_indications) out["of_indications"].push_back(json(indication_error_fields, e));
  out["lack_of_fit"] = json(lack_of_fit_fields, LackOfFitRow{t.lack_of_fit, unit, unit});
  out["lack_of_fit"]["depends_on"] = t.lack_of_fit.depends_on;
  out["anomalous_blocks"] = Json::array();
  for (const AnomalousBlock& b : t.anomalous_blocks)
    out["anomalous_blocks"].push_back(json(anomalous_block_fields, AnomalousBlockRow{b, unit, unit}));
  out["outliers"] = Json::array();
  for (const Outlier& o : t.outliers) out["outliers"].push_back(json(outlier_fields, o));
  out["noise"] = json(noise_fields, t.noise);
  out["statements"] = t.statements;
  out["plain"] = t.plain;
  return json_text(out);
}

} // namespace gumshoe::tracing
