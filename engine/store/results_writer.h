#pragma once
/// Writes everything but the samples: Results as the groups of README.md. Private to this folder.
#include "analysis/results.h"
#include "store/hdf5.h"

namespace gumshoe::store {

/// `file` holds none of it yet.
void write_results(hid_t file, const analysis::Results& results);

/// Its studies, those of sensitivity also alone; groups without rows are not made. In study_writer.cpp.
void write_studies(hid_t file, const analysis::Results& results);
void write_sensitivity(hid_t group, const std::vector<analysis::Sensitivity>& sobol,
                       const std::vector<analysis::Shapley>& shapley);

/// Budgets as a group `name` of sub-groups 000, 001, ...; none if there are none.
void write_budgets(hid_t file, const std::string& name, const std::vector<analysis::Budget>& budgets);

/// A list of texts, its own dimension; nothing if it is empty.
void write_list(hid_t group, const std::string& name, const std::vector<std::string>& texts, const char* long_name);

/// Label values of a reading in one line: "rod 2, 1".
std::string label_text(const quantities::Labels& labels);

} // namespace gumshoe::store
