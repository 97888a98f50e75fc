#include "analysis/selection.h"

#include <algorithm>

namespace gumshoe::analysis {

namespace {

using Wanted = std::function<bool(const propagation::Output&)>;

template <class T> void keep(std::vector<T>& items, const std::vector<bool>& kept) {
  std::size_t next = 0;
  std::erase_if(items, [&](const T&) { return !kept[next++]; });
}

void keep_columns(OneAtATimeTable& table, const Wanted& wanted) {
  std::vector<bool> kept;
  for (const auto& output : table.outputs) kept.push_back(wanted(output));
  keep(table.outputs, kept);
  for (OneAtATimeRow& row : table.rows) keep(row.up, kept), keep(row.down, kept);
}

} // namespace

void keep_outputs(Results& r, const Wanted& wanted) {
  const auto of_output = [&](auto&... studies) {
    (std::erase_if(studies, [&](const auto& study) { return !wanted(study.output); }), ...);
  };
  if (r.stopping.tolerance.size() == r.summaries.size()) {
    std::vector<bool> kept;
    for (const Summary& s : r.summaries) kept.push_back(wanted(s.output));
    keep(r.stopping.tolerance, kept);
  }
  of_output(r.summaries, r.budgets, r.validations, r.sensitivities, r.shapley, r.given_data, r.morris, r.dgsm,
            r.circular);
  std::erase_if(r.joint, [&](const JointRegion& j) { return !std::ranges::all_of(j.outputs, wanted); });
  for (OneAtATimeTable& table : r.one_at_a_time) keep_columns(table, wanted);
}

void keep_measurands(Results& r, const std::vector<std::string>& measurands) {
  if (!measurands.empty())
    keep_outputs(r, [&](const auto& o) { return std::ranges::find(measurands, o.measurand) != measurands.end(); });
}

} // namespace gumshoe::analysis
