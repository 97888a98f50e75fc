/// Logs of controls by a description of their lines: the description, then a line `==== log`, then the log.
#include "scenario/log_form.h"
#include "base/error.h"
#include "fuzz/harness.h"

namespace gumshoe::fuzz {

void log_form(std::string_view input) {
  const auto files = parts(input);
  const scenario::LogForm form(files.front().second, "form.toml");
  const Csv table = form.read(files.back().second, "control.log"); // without a log, the description is read by itself
  for (const auto& row : table.rows) require(row.size() == table.header.size(), "each row is as long as the header");
}

} // namespace gumshoe::fuzz
