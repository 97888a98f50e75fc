#include "store/trace_file.h"

#include "base/instruction_set.h"
#include "base/version.h"
#include "store/results_writer.h"
#include "store/trace_writer.h"
#include "store/whole_file.h"

namespace gumshoe::store {

void write_trace(const std::string& path, const scenario::Scenario& s, const ModelCard& card,
                 const tracing::Trace& trace, const TracedBudgets& budgets) {
  const Identity identity{s.hash,
                          s.text,
                          s.file,
                          s.model,
                          scenario::name(s.method),
                          s.evaluation,
                          scenario::name(scenario::Design::monte_carlo),
                          version,
                          name(best_instruction_set()),
                          "",
                          s.trace.seed,
                          static_cast<std::uint64_t>(trace.draws),
                          false,
                          ""};
  write_whole(path, identity, s.title, s.analysis.coverage_probability, [&](hid_t file) {
    hdf5::write_attribute(file, "model_title", std::string(card.title));
    write_data(file, s, card);
    write_residuals(file, s, card, trace);
    write_trace_group(file, trace);
    write_budgets(file, "budget_before", budgets.before);
    write_budgets(file, "budget_after", budgets.after);
    write_list(file, "notes", s.notes, "decisions and warnings a reader must see");
  });
}

} // namespace gumshoe::store
