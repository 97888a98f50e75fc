#include "tracing/findings/verdict_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "base/units.h"

namespace gumshoe::tracing {

namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
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

Json finding_json(const Finding& f) {
  Json alternatives = Json::array();
  for (std::size_t i = 0; i < f.alternatives.size(); ++i)
    alternatives.push_back(
        {{"name", i < f.members.size() ? f.members[i] : ""}, {"quantities", quantities_json(f.alternatives[i])}});
  return {{"kind", name(f.kind)},
          {"name", f.name},
          {"members", f.members},
          {"p_value", number(f.p_value)},
          {"depends_on", f.depends_on},
          {"suggestion", f.suggestion},
          {"quantities", quantities_json(f.quantities)},
          {"alternatives", alternatives},
          {"removed_share", number(f.removed_share)},
          {"remarks", f.remarks}};
}

Json rms_json(const Rms& r) {
  return {{"unit", r.si_unit},
          {"before", number(r.before)},
          {"after", number(r.after)},
          {"noise", number(r.noise)},
          {"holdout_before", number(r.holdout_before)},
          {"holdout_after", number(r.holdout_after)},
          {"worst_block_after", number(r.worst_block_after)},
          {"noise_interval95", pair(r.noise_low, r.noise_high)},
          {"holdout_noise", number(r.holdout_noise)},
          {"holdout_noise_interval95", pair(r.holdout_noise_low, r.holdout_noise_high)},
          {"worst_block_before", number(r.worst_block_before)},
          {"worst_block", r.worst_block},
          {"worst_point_before", number(r.worst_point_before)},
          {"worst_point_after", number(r.worst_point_after)},
          {"worst_point", r.worst_point},
          {"share_removed", number(r.share_removed)},
          {"holdout", r.holdout}};
}

Json limits_json(const std::vector<DetectionLimit>& limits) {
  Json list = Json::array();
  for (const DetectionLimit& d : limits) {
    const ShownSize s = shown(d);
    list.push_back({{"effect", d.effect}, {"quantity", d.quantity}, {"value", number(s.value)}, {"unit", s.unit}});
  }
  return list;
}

} // namespace

std::string verdict(const Trace& t) {
  if (!t.findings.empty()) return name(t.findings.front().kind);
  return t.outcome == Outcome::insufficient_data ? "insufficient_data" : "nothing_found";
}

ShownSize shown(const SizedQuantity& q) {
  using units::Kind;
  const Kind kind = q.scenario_name.empty() ? Kind::difference : Kind::point;
  try {
    const auto convert = [&](double x, Kind k) { return units::from_si(x, q.unit, q.si_unit, k); };
    return {q.unit, convert(q.value, kind), convert(q.u, Kind::difference), convert(q.low95, kind),
            convert(q.high95, kind)};
  } catch (const InputError&) {
    return {q.si_unit, q.value, q.u, q.low95, q.high95};
  }
}

ShownSize shown(const DetectionLimit& d) {
  return shown(SizedQuantity{d.quantity, d.unit, d.si_unit, d.value, 0, 0, 0, "", {}});
}

std::string verdict_json(const Trace& t) {
  Json findings = Json::array();
  for (const Finding& f : t.findings) findings.push_back(finding_json(f));
  const Json out{{"verdict", verdict(t)},
                 {"findings", findings},
                 {"rms", rms_json(t.rms)},
                 {"detection_limits", limits_json(t.detection_limits)},
                 {"tried", t.tried},
                 {"p_anything", number(t.p_anything)},
                 {"alpha", t.alpha},
                 {"draws", t.draws},
                 {"vetoed", t.vetoed},
                 {"noise",
                  {{"scale", number(t.noise.scale)},
                   {"declared", t.noise.declared},
                   {"correlation", number(t.noise.correlation)},
                   {"scatter", t.noise.scatter},
                   {"scatter_u", number(t.noise.scatter_u)},
                   {"chi_squared_p", number(t.noise.chi_squared_p)},
                   {"outliers", t.noise.outliers}}},
                 {"statements", t.statements},
                 {"plain", t.plain}};
  return out.dump(2, ' ', false, Json::error_handler_t::replace); // labels need not be UTF-8
}

} // namespace gumshoe::tracing
