#include "store/trace_file.h"

#include <algorithm>

#include "store/field_writer.h"
#include "store/results_writer.h"
#include "store/whole_file.h"
#include "tracing/findings/trace_fields.h"

namespace gumshoe::store {

using namespace tracing;

namespace {

/// The sizes of a finding; of a class those of every member, one after the other.
void write_quantities(hid_t finding, const Finding& f) {
  std::vector<SizeRow> rows;
  const auto add = [&](const std::vector<SizedQuantity>& sizes, const std::string& member) {
    for (const SizedQuantity& q : sizes) rows.push_back({q, member, label_text(q.labels)});
  };
  if (f.alternatives.empty()) add(f.quantities, f.members.empty() ? f.name : f.members.front());
  for (std::size_t i = 0; i < f.alternatives.size(); ++i)
    add(f.alternatives[i], i < f.members.size() ? f.members[i] : "");
  if (rows.empty()) return;
  const hdf5::Handle group = hdf5::create_group(finding, "quantities");
  Table table(group, "quantity", rows.size());
  write_fields(table, size_fields, rows);
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

void write_cells(hid_t group, const CellTable& c) {
  hdf5::write_attribute(group, "indication", c.indication);
  hdf5::write_attribute(group, "size_units", c.indication_si_unit);
  const Display shown = display(c.indication_unit, c.indication_si_unit);
  hdf5::write_attribute(group, "size_display_units", shown.units);
  hdf5::write_attribute(group, "size_display_factor", shown.factor);
  {
    const hdf5::Handle keys = hdf5::create_group(group, "keys");
    Table table(keys, "cell", c.y.size());
    for (const CellTable::Key& key : c.keys)
      if (key.levels.empty())
        write_column(keys, table, key.name, key.x, key.unit, key.si_unit, "measured level");
      else
        table.texts(free_name(keys, key.name), key.levels, "value of the label " + key.name);
  }
  Table table(group, "cell", c.y.size());
  table.numbers("y", c.y, c.indication_si_unit, "size of what is not in the catalogue, in " + c.indication);
  table.numbers("u", c.u, c.indication_si_unit, "its standard uncertainty");
  table.numbers("readings", c.readings, "1", "training readings there");
}

void write_finding(hid_t group, const Finding& f) {
  write_attributes(group, finding_fields, f);
  write_list(group, "members", f.members, "effects that these data cannot distinguish, the best first");
  write_list(group, "depends_on", f.depends_on, "conditions, columns or labels that it depends on");
  write_list(group, "remarks", f.remarks, "what a reader must know of it");
  write_quantities(group, f);
  write_numbered(group, "curves", f.curves, write_curve);
  write_numbered(group, "tables", f.tables, write_cells);
}

void write_sizes_of_noise(hid_t parent, const Noise& n, const Rms& r) {
  const hdf5::Handle rms = hdf5::create_group(parent, "rms"), noise = hdf5::create_group(parent, "noise");
  for (const hid_t group : {hid_t(rms), hid_t(noise)}) {
    hdf5::write_attribute(group, "units", r.si_unit);
    write_display(group, r.unit, r.si_unit);
  }
  write_attributes(rms, rms_fields, r);
  write_attributes(noise, noise_fields, n);
}

void write_repeats(hid_t file, hid_t parent, const Trace& t) {
  const hdf5::Handle group = hdf5::create_group(parent, "lack_of_fit");
  hdf5::write_attribute(group, "units", t.rms.si_unit);
  write_display(group, t.rms.unit, t.rms.si_unit);
  write_attributes(group, lack_of_fit_fields, LackOfFitRow{t.lack_of_fit, t.rms.unit, t.rms.si_unit});
  write_list(group, "depends_on", t.lack_of_fit.depends_on, "conditions, columns and labels that what repeats depends on");
  std::vector<AnomalousBlockRow> blocks;
  for (const AnomalousBlock& b : t.anomalous_blocks) blocks.push_back({b, t.rms.unit, t.rms.si_unit});
  if (!blocks.empty()) write_table(file, anomalous_block_fields, blocks);
  if (!t.outliers.empty()) write_table(file, outlier_fields, t.outliers);
}

std::string label_of(const quantities::Reading& reading, const std::string& name) {
  const auto at = std::ranges::find(reading.labels, name, &std::pair<std::string, std::string>::first);
  return at == reading.labels.end() ? "" : at->second;
}

/// The readings: what was read, its labels, conditions and columns.
void write_data(hid_t file, const scenario::Scenario& s, const ModelCard& card) {
  const auto& readings = s.readings;
  const hdf5::Handle data = hdf5::create_group(file, "data");
  Table table(data, "reading", readings.size());
  table.texts("name", column(readings, [](const auto& reading) { return label_text(reading.labels); }),
              "label values of the reading");
  table.numbers("repeats", column(readings, &quantities::Reading::repeats), "1", "readouts averaged in the reading");
  const auto filled = [&](const char* name, auto fill) {
    const hdf5::Handle group = hdf5::create_group(data, name);
    Table own(group, "reading", readings.size());
    fill(group, own);
  };
  filled("labels", [&](hid_t group, Table& own) {
    std::vector<std::string> names;
    for (const auto& reading : readings)
      for (const auto& [name, value] : reading.labels)
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    for (const std::string& name : names) {
      const auto values = column(readings, [&](const auto& reading) { return label_of(reading, name); });
      own.texts(free_name(group, name), values, "label " + name);
    }
  });
  const auto cards = [&](const char* name, std::span<const VariableCard> variables, auto member) {
    filled(name, [&](hid_t group, Table& own) {
      for (std::size_t i = 0; i < variables.size(); ++i) {
        if (std::ranges::any_of(readings, [&](const auto& reading) { return (reading.*member).size() <= i; })) continue;
        const VariableCard& v = variables[i];
        write_column(group, own, std::string(v.name),
                     column(readings, [&](const auto& reading) { return (reading.*member)[i]; }), std::string(v.unit),
                     std::string(v.si_unit), std::string(v.meaning));
      }
    });
  };
  cards("conditions", card.conditions, &quantities::Reading::conditions);
  cards("indications", card.indications, &quantities::Reading::indications);
  filled("columns", [&](hid_t group, Table& own) {
    for (const auto& c : s.trace.columns)
      if (c.values.size() == readings.size())
        write_column(group, own, c.name, c.values, c.unit, c.si_unit, "recorded with the readings");
  });
}

void write_residuals(hid_t file, const scenario::Scenario& s, const ModelCard& card, const Trace& t) {
  std::vector<ResidualRow> rows;
  for (const Row& row : t.rows) {
    const VariableCard& v = card.indications[row.indication];
    rows.push_back({row, label_text(s.readings[row.reading].labels), std::string(v.name), std::string(v.unit),
                    std::string(v.si_unit)});
  }
  const hdf5::Handle group = hdf5::create_group(file, "residuals");
  hdf5::write_attribute(group, "blocks", s.trace.blocks);
  hdf5::write_attribute(group, "order_name", s.trace.order_known ? s.trace.order_name : scenario::unknown_order);
  Table table(group, "row", rows.size());
  write_fields(table, residual_fields, rows);
  table.numbers("final", column(rows, [](const Row& row) { return static_cast<std::uint8_t>(row.held_out ? 1 : 0); }), "1",
                "whether it was held out");
  if (rows.empty()) return;
  const hdf5::Handle flags = hdf5::own(H5Dopen2(group, "final", H5P_DEFAULT), H5Dclose, "describe the flags");
  hdf5::write_attribute(flags, "flag_values", std::vector<std::uint8_t>{0, 1});
  hdf5::write_attribute(flags, "flag_meanings", std::string("training final"));
}

void write_trace_group(hid_t file, const Trace& t) {
  const hdf5::Handle group = hdf5::create_group(file, "trace");
  write_attributes(group, trace_fields, t);
  write_sizes_of_noise(group, t.noise, t.rms);
  if (!t.of_indications.empty()) write_table(file, indication_error_fields, t.of_indications);
  write_repeats(file, group, t);
  write_numbered(group, "findings", t.findings, write_finding);
  if (!t.candidates.empty()) write_table(file, candidate_fields, t.candidates);
  if (!t.detection_limits.empty()) write_table(file, limit_fields, t.detection_limits);
  write_list(group, "plain", t.plain, "what it means, in plain words");
  write_list(group, "statements", t.statements, "what these data cannot tell, and decisions a reader must see");
}

void write_round(hid_t group, const Round& round) {
  write_list(group, "added", round.added, "findings of this round");
  hdf5::write_attribute(group, "vetoed", round.vetoed ? 1 : 0);
  hdf5::write_attribute(group, "units", round.rms.si_unit);
  write_attributes(group, rms_fields, round.rms);
  write_display(group, round.rms.unit, round.rms.si_unit);
  if (round.candidates.empty()) return;
  const hdf5::Handle candidates = hdf5::create_group(group, "candidates");
  Table table(candidates, "candidate", round.candidates.size());
  write_fields(table, candidate_fields, round.candidates);
}

} // namespace

void write_trace(Draft& draft, const Claim& claim, const scenario::Scenario& s, const ModelCard& card, const Trace& trace,
                 const TracedBudgets& budgets, const std::vector<Round>& rounds) {
  Identity identity = identity_of(s);
  identity.command = "trace";
  identity.seed = s.trace.seed;
  identity.samples = static_cast<std::uint64_t>(trace.draws);
  write_whole(draft, claim, identity, s, [&](hid_t file) {
    write_data(file, s, card);
    write_residuals(file, s, card, trace);
    write_trace_group(file, trace);
    if (rounds.size() > 1) write_numbered(file, "rounds", rounds, write_round);
    write_budgets(file, "budget_before", budgets.before);
    write_budgets(file, "budget_after", budgets.after);
    write_list(file, "notes", s.notes, "decisions and warnings a reader must see");
  });
}

} // namespace gumshoe::store
