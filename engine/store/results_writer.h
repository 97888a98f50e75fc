#pragma once
/// Writes everything but the samples: Results as the groups of README.md. Private to this folder.
#include "analysis/results.h"
#include "store/hdf5.h"

namespace gumshoe::store {

/// `file` holds none of it yet.
void write_results(hid_t file, const analysis::Results& results);

/// The parts of it that have a file of their own; groups without rows are not made.
void write_sensitivity(hid_t file, const analysis::Results& results); ///< sensitivity_writer.cpp
void write_joint(hid_t file, const analysis::Results& results);       ///< joint_writer.cpp: joint, circular, conformity
void write_planning(hid_t file, const analysis::Results& results);    ///< planning_writer.cpp: targets, stopping

/// Budgets as a group `name` of sub-groups 000, 001, ...; none if there are none.
void write_budgets(hid_t file, const std::string& name, const std::vector<analysis::Budget>& budgets);

/// A list of texts, its own dimension; nothing if it is empty.
void write_list(hid_t group, const std::string& name, const std::vector<std::string>& texts, const char* long_name);

/// Label values of a reading in one line: "rod 2, 1".
std::string label_text(const quantities::Labels& labels);

} // namespace gumshoe::store
