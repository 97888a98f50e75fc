#include "store/whole_file.h"

#include "analysis/record.h"
#include "analysis/result_fields.h"
#include "models/model.h"
#include "store/field_writer.h"
#include "store/identity.h"

namespace gumshoe::store {

void write_whole(Draft& draft, const Claim& claim, Identity identity, const scenario::Scenario& s,
                 const std::function<void(hid_t file)>& contents) {
  const ModelCard& card = s.made ? *s.made->card : *models::find(s.model)->card;
  identity.design = scenario::name(scenario::Design::monte_carlo);
  identity.store_samples = false;
  const Lock lock(hdf5::library());
  survive_size_limit();
  naming(claim.path(), [&] {
    const std::string name = draft.add(claim);
    hdf5::Handle file = open_file(name, H5F_ACC_TRUNC);
    const Record record = write_identity(file, identity, true);
    hdf5::write_attribute(file, "title", s.title);
    hdf5::write_attribute(file, "coverage_probability", s.analysis.coverage_probability);
    hdf5::write_attribute(file, "model_title", std::string(card.title));
    write_table(file, analysis::equation_fields, analysis::equations_of(card, s.evaluation));
    write_table(file, analysis::axis_fields, analysis::axis_records(card));
    write_table(file, analysis::input_fields, analysis::input_records(s));
    contents(file);
    close_file(file);
    seal(name, record);
  });
}

} // namespace gumshoe::store
