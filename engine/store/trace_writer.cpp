#include "store/trace_writer.h"

#include <algorithm>

#include "store/results_writer.h"
#include "store/table.h"
#include "tracing/findings/verdict_json.h"

namespace gumshoe::store {

using namespace tracing;

namespace {

void write_display(hid_t object, const std::string& unit, const std::string& si_unit) {
  const Display shown = display(unit, si_unit);
  hdf5::write_attribute(object, "display_units", shown.units);
  hdf5::write_attribute(object, "display_factor", shown.factor);
  hdf5::write_attribute(object, "display_offset", shown.offset);
}

void write_attributes(hid_t group, const std::vector<std::pair<const char*, double>>& numbers) {
  for (const auto& [name, x] : numbers) hdf5::write_attribute(group, name, x);
}

/// The sizes of a finding; of a class those of every member, one after the other.
void write_quantities(hid_t finding, const Finding& f) {
  std::vector<SizedQuantity> rows = f.quantities;
  std::vector<std::string> members(rows.size(), f.members.empty() ? f.name : f.members.front());
  if (!f.alternatives.empty()) rows.clear(), members.clear();
  for (std::size_t i = 0; i < f.alternatives.size(); ++i)
    for (const SizedQuantity& q : f.alternatives[i]) {
      rows.push_back(q);
      members.push_back(i < f.members.size() ? f.members[i] : "");
    }
  if (rows.empty()) return;
  const hdf5::Handle group = hdf5::create_group(finding, "quantities");
  Table table(group, "quantity", rows.size());
  using Q = SizedQuantity;
  const auto si = column(rows, &Q::si_unit);
  const std::string units = common_units(si);
  table.texts("name", column(rows, &Q::name), "quantity");
  table.texts("member", members, "effect whose size it is");
  table.texts("scenario_name", column(rows, &Q::scenario_name),
              "where it stands in a scenario; empty: nowhere, and the value is a difference");
  table.texts("labels", column(rows, [](const Q& q) { return label_text(q.labels); }), "label values it holds for");
  table.units(si, column(rows, &Q::unit));
  table.numbers("value", column(rows, &Q::value), units, "estimate");
  table.numbers("standard_uncertainty", column(rows, &Q::u), units, "standard uncertainty");
  table.numbers("low", column(rows, &Q::low95), units, "lower end of the 95 % interval that allows for the search");
  table.numbers("high", column(rows, &Q::high95), units, "upper end of it");
}

void write_curve(hid_t group, const Curve& c) {
  hdf5::write_attribute(group, "against", c.against);
  hdf5::write_attribute(group, "indication", c.indication);
  hdf5::write_attribute(group, "units", c.si_unit);
  write_display(group, c.unit, c.si_unit);
  const Display shown = display(c.indication_unit, c.indication_si_unit);
  hdf5::write_attribute(group, "size_units", c.indication_si_unit);
  hdf5::write_attribute(group, "size_display_units", shown.units);
  hdf5::write_attribute(group, "size_display_factor", shown.factor);
  Table table(group, "point", c.y.size());
  if (!c.levels.empty())
    table.texts("level", c.levels, "value of the label " + c.against);
  else
    table.numbers("x", c.x, c.si_unit, c.against);
  table.numbers("y", c.y, c.indication_si_unit, "size of what is not in the catalogue, in " + c.indication);
  table.numbers("u", c.u, c.indication_si_unit, "its standard uncertainty");
}

void write_finding(hid_t group, const Finding& f) {
  const std::pair<const char*, std::string> texts[] = {
      {"kind", name(f.kind)}, {"name", f.name}, {"suggestion", f.suggestion}};
  for (const auto& [name, text] : texts) hdf5::write_attribute(group, name, text);
  write_attributes(group, {{"p_value", f.p_value}, {"removed_share", f.removed_share}});
  write_list(group, "members", f.members, "effects that these data cannot tell apart, the best first");
  write_list(group, "depends_on", f.depends_on, "conditions, columns or labels that it depends on");
  write_list(group, "remarks", f.remarks, "what a reader must know of it");
  write_quantities(group, f);
  write_numbered(group, "curves", f.curves, write_curve);
}

void write_candidates(hid_t parent, const std::vector<Candidate>& rows) {
  if (rows.empty()) return;
  const hdf5::Handle group = hdf5::create_group(parent, "candidates");
  Table table(group, "candidate", rows.size());
  using C = Candidate;
  table.texts("name", column(rows, &C::name), "candidate");
  table.texts("shape", column(rows, &C::shape), "what was held fixed");
  table.texts("family", column(rows, &C::family), "effect, declared, stated, shape, omnibus or scatter");
  table.numbers("parameters", column(rows, &C::parameters), "1", "number of sizes");
  table.numbers("statistic", column(rows, &C::statistic), "1", "twice the logarithm of the likelihood ratio");
  table.numbers("p_single", column(rows, &C::p_single), "1", "p-value, were it the only one tried");
  table.numbers("identifiable", column(rows, &C::identifiable), "1",
                "share of its signature that the declared model does not absorb");
  table.texts("absorbed_by", column(rows, &C::absorbed_by), "quantity that absorbs it, where next to nothing is left");
  table.numbers("correlation", column(rows, &C::correlation), "1",
                "correlation of its projected signature with that of the best");
  table.texts("outcome", column(rows, &C::outcome), "what became of it, and why");
}

void write_limits(hid_t parent, const std::vector<DetectionLimit>& rows) {
  if (rows.empty()) return;
  const hdf5::Handle group = hdf5::create_group(parent, "detection_limits");
  Table table(group, "limit", rows.size());
  using D = DetectionLimit;
  const auto si = column(rows, &D::si_unit);
  table.texts("effect", column(rows, &D::effect), "effect");
  table.texts("quantity", column(rows, &D::quantity), "its size");
  table.units(si, column(rows, &D::unit));
  table.numbers("value", column(rows, &D::value), common_units(si),
                "smallest size that would have been seen in nine cases of ten; infinite: none by these data");
}

void write_rms(hid_t parent, const Rms& r) {
  const hdf5::Handle group = hdf5::create_group(parent, "rms");
  hdf5::write_attribute(group, "units", r.si_unit);
  write_display(group, r.unit, r.si_unit);
  write_attributes(group, {{"before", r.before},
                           {"after", r.after},
                           {"noise", r.noise},
                           {"noise_low", r.noise_low},
                           {"noise_high", r.noise_high},
                           {"holdout_before", r.holdout_before},
                           {"holdout_after", r.holdout_after},
                           {"holdout_noise", r.holdout_noise},
                           {"holdout_noise_low", r.holdout_noise_low},
                           {"holdout_noise_high", r.holdout_noise_high},
                           {"worst_block_before", r.worst_block_before},
                           {"worst_block_after", r.worst_block_after},
                           {"worst_point_before", r.worst_point_before},
                           {"worst_point_after", r.worst_point_after},
                           {"share_removed", r.share_removed}});
  const std::pair<const char*, std::string> texts[] = {
      {"worst_block", r.worst_block}, {"worst_point", r.worst_point}, {"holdout", r.holdout}};
  for (const auto& [name, text] : texts) hdf5::write_attribute(group, name, text);
}

void write_noise(hid_t parent, const Noise& n, const Rms& r) {
  const hdf5::Handle group = hdf5::create_group(parent, "noise");
  hdf5::write_attribute(group, "units", r.si_unit);
  write_display(group, r.unit, r.si_unit);
  write_attributes(group, {{"scale", n.scale},
                           {"correlation", n.correlation},
                           {"scatter_u", n.scatter_u},
                           {"chi_squared_p", n.chi_squared_p}});
  hdf5::write_attribute(group, "scatter", n.scatter);
  hdf5::write_attribute(group, "declared", n.declared ? 1 : 0);
  hdf5::write_attribute(group, "outliers", n.outliers);
}

/// A name for a dataset: "/" would make a group of it, and the dimension has a name, too.
std::string free_name(hid_t group, std::string name) {
  std::ranges::replace(name, '/', '_');
  while (hdf5::has(group, name)) name += '_';
  return name;
}

void write_column(hid_t group, Table& table, std::string name, const std::vector<double>& values,
                  const std::string& unit, const std::string& si_unit, const std::string& what) {
  name = free_name(group, name);
  table.numbers(name, values, si_unit, what);
  if (!values.empty())
    write_display(hdf5::own(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "describe a column"), unit, si_unit);
}

std::string label_of(const quantities::Reading& reading, const std::string& name) {
  const auto at = std::ranges::find(reading.labels, name, &std::pair<std::string, std::string>::first);
  return at == reading.labels.end() ? "" : at->second;
}

} // namespace

void write_data(hid_t file, const scenario::Scenario& s, const ModelCard& card) {
  const auto& readings = s.readings;
  const hdf5::Handle data = hdf5::create_group(file, "data");
  Table table(data, "reading", readings.size());
  table.texts("name", column(readings, [](const auto& reading) { return label_text(reading.labels); }),
              "label values of the reading");
  table.numbers("repeats", column(readings, &quantities::Reading::repeats), "1", "readouts averaged in the reading");
  const auto filled = [&](const char* name, auto fill) {
    const hdf5::Handle group = hdf5::create_group(data, name);
    Table table(group, "reading", readings.size());
    fill(group, table);
  };
  filled("labels", [&](hid_t group, Table& table) {
    std::vector<std::string> names;
    for (const auto& reading : readings)
      for (const auto& [name, value] : reading.labels)
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    for (const std::string& name : names) {
      const auto values = column(readings, [&](const auto& reading) { return label_of(reading, name); });
      table.texts(free_name(group, name), values, "label " + name);
    }
  });
  const auto cards = [&](const char* name, std::span<const VariableCard> variables, auto member) {
    filled(name, [&](hid_t group, Table& table) {
      for (std::size_t i = 0; i < variables.size(); ++i) {
        if (std::ranges::any_of(readings, [&](const auto& reading) { return (reading.*member).size() <= i; })) continue;
        const VariableCard& v = variables[i];
        write_column(group, table, std::string(v.name),
                     column(readings, [&](const auto& reading) { return (reading.*member)[i]; }), std::string(v.unit),
                     std::string(v.si_unit), std::string(v.meaning));
      }
    });
  };
  cards("conditions", card.conditions, &quantities::Reading::conditions);
  cards("indications", card.indications, &quantities::Reading::indications);
  filled("columns", [&](hid_t group, Table& table) {
    for (const auto& c : s.trace.columns)
      if (c.values.size() == readings.size())
        write_column(group, table, c.name, c.values, c.unit, c.si_unit, "recorded beside the readings");
  });
}

void write_residuals(hid_t file, const scenario::Scenario& s, const ModelCard& card, const Trace& t) {
  const auto& rows = t.rows;
  const hdf5::Handle group = hdf5::create_group(file, "residuals");
  hdf5::write_attribute(group, "blocks", s.trace.blocks);
  hdf5::write_attribute(group, "order_name", s.trace.order_name);
  Table table(group, "row", rows.size());
  std::vector<std::string> names, unit, si;
  for (const Row& row : rows) {
    const VariableCard& v = card.indications[row.indication];
    names.emplace_back(v.name), unit.emplace_back(v.unit), si.emplace_back(v.si_unit);
  }
  const std::string units = common_units(si);
  const auto position = [](std::size_t Row::*member) {
    return [member](const Row& row) { return static_cast<std::uint64_t>(row.*member); };
  };
  table.numbers("reading", column(rows, position(&Row::reading)), "1", "position of the reading in data, from 0");
  table.texts("name", column(rows, [&](const Row& row) { return label_text(s.readings[row.reading].labels); }),
              "label values of the reading");
  table.texts("indication", names, "indication");
  table.units(si, unit);
  table.numbers("order", column(rows, &Row::order), "see order_name", "order of measurement");
  table.texts("block", column(rows, &Row::block), "block");
  table.numbers("final", column(rows, [](const Row& row) { return static_cast<std::uint8_t>(row.final ? 1 : 0); }), "1",
                "whether it was kept apart until the end");
  if (!rows.empty()) {
    const hdf5::Handle flags = hdf5::own(H5Dopen2(group, "final", H5P_DEFAULT), H5Dclose, "describe the flags");
    hdf5::write_attribute(flags, "flag_values", std::vector<std::uint8_t>{0, 1});
    hdf5::write_attribute(flags, "flag_meanings", std::string("training final"));
  }
  table.numbers("measured", column(rows, &Row::measured), units, "what was read");
  table.numbers("before", column(rows, &Row::before), units,
                "measured minus simulated, the data's own constants taken off; NaN if not scored");
  table.numbers("after", column(rows, &Row::after), units, "the same with what was found added to the model");
  table.numbers("noise_u", column(rows, &Row::noise_u), units, "standard uncertainty of its noise");
  table.numbers("weight", column(rows, &Row::weight), "1", "below 1: taken for an outlier");
}

void write_trace_group(hid_t file, const Trace& t) {
  const hdf5::Handle group = hdf5::create_group(file, "trace");
  hdf5::write_attribute(group, "verdict", verdict(t));
  write_attributes(group, {{"p_anything", t.p_anything}, {"alpha", t.alpha}});
  const std::pair<const char*, int> counts[] = {{"tried", t.tried}, {"draws", t.draws}, {"vetoed", t.vetoed ? 1 : 0}};
  for (const auto& [name, n] : counts) hdf5::write_attribute(group, name, n);
  write_rms(group, t.rms);
  write_noise(group, t.noise, t.rms);
  write_numbered(group, "findings", t.findings, write_finding);
  write_candidates(group, t.candidates);
  write_limits(group, t.detection_limits);
  write_list(group, "plain", t.plain, "what it means, in plain words");
  write_list(group, "statements", t.statements, "what these data cannot tell, and decisions a reader must see");
}

} // namespace gumshoe::store
