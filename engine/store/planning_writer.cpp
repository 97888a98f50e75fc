#include "store/results_writer.h"
#include "store/table.h"

namespace gumshoe::store {
using namespace analysis;

namespace {

void write_target(hid_t group, const TargetResult& target) {
  write_output(group, target.output);
  hdf5::write_attribute(group, "wanted", target.wanted);
  hdf5::write_attribute(group, "present", target.present);
  hdf5::write_attribute(group, "reached", target.reached);
  hdf5::write_attribute(group, "cost_ratio", target.cost_ratio);
  hdf5::write_attribute(group, "statement", target.statement);
  const auto& rows = target.rows;
  const auto si = column(rows, &TargetRow::si_unit);
  const std::string units = common_units(si);
  Table table(group, "row", rows.size());
  table.texts("quantity", column(rows, &TargetRow::quantity), "input quantity");
  table.units(si, column(rows, &TargetRow::unit));
  table.numbers("present", column(rows, &TargetRow::present), units, "standard uncertainty as it is");
  table.numbers("allowed", column(rows, &TargetRow::allowed), units,
                "largest standard uncertainty that reaches the target, the others as they are; Monte Carlo; "
                "NaN: none reaches it, infinite: it does not matter");
  table.numbers("allowed_gum", column(rows, &TargetRow::allowed_gum), units,
                "the same by the law of propagation, NaN: none, infinite: it does not matter");
  table.numbers("cost", column(rows, &TargetRow::cost), "1", "relative cost, NaN if not given");
  table.numbers("cheapest", column(rows, &TargetRow::cheapest), units,
                "standard uncertainty in the cheapest combination, NaN if there is none");
}

void write_stopping(hid_t file, const Results& r) {
  const StoppingRecord& stopping = r.stopping;
  if (stopping.rule.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, "stopping");
  hdf5::write_attribute(group, "rule", stopping.rule);
  hdf5::write_attribute(group, "digits", stopping.digits);
  hdf5::write_attribute(group, "block", stopping.block);
  hdf5::write_attribute(group, "jcgm_trials", stopping.jcgm_trials);
  hdf5::write_attribute(group, "stein_trials", stopping.stein_trials);
  hdf5::write_attribute(group, "trials", stopping.trials);
  hdf5::write_attribute(group, "reached", stopping.reached ? 1 : 0);
  hdf5::write_attribute(group, "statement", stopping.statement);
  if (stopping.tolerance.size() != r.summaries.size()) return;
  const auto si = column(r.summaries, [](const Summary& s) { return s.output.si_unit; });
  Table table(group, "output", r.summaries.size());
  table.texts("name", column(r.summaries, [](const Summary& s) { return s.output.name; }), "output");
  table.units(si, column(r.summaries, [](const Summary& s) { return s.output.unit; }));
  table.numbers("tolerance", stopping.tolerance, common_units(si), "numerical tolerance delta, JCGM 101 7.9.2");
}

} // namespace

void write_planning(hid_t file, const Results& r) {
  write_numbered(file, "target", r.targets, write_target);
  write_stopping(file, r);
}

} // namespace gumshoe::store
