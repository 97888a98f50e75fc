#pragma once
/// The tables of the result file as their fields describe them: the middle part of README.md in this folder, and the
/// columns of the report's CSV tables. The hidden command `gumshoe fields` prints them.
#include <string>

namespace gumshoe::store {

/// One table per group: dataset or attribute, unit, meaning, and the names in JSON, CSV and `gumshoe gauge`.
std::string layout_markdown();

/// The CSV columns of each group, each [header, dataset, kind of unit] (analysis::In): reports/gumshoe_report/columns.json.
std::string csv_columns_json();

} // namespace gumshoe::store
