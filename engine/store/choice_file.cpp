#include "store/choice_file.h"

#include "store/choice_writer.h"
#include "store/whole_file.h"

namespace gumshoe::store {

void write_choice(const std::string& path, const scenario::Scenario& s, const choice::Result& r) {
  const Identity identity{s.hash,
                          s.text,
                          s.file,
                          s.model,
                          scenario::name(s.method),
                          s.evaluation,
                          scenario::name(scenario::Design::monte_carlo),
                          r.version,
                          r.instruction_set,
                          "",
                          r.seed,
                          r.asked.confirm_samples,
                          false,
                          ""};
  write_whole(path, identity, r.title, r.coverage_probability, [&](hid_t file) { write_choice_group(file, r); });
}

} // namespace gumshoe::store
