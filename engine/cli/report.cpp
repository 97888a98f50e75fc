/// `gumshoe report`: hands a result file to the report generator (reports/report.py).
#include <filesystem>
#include <memory>

#include "base/inputs.h"
#include "cli/command.h"
#include "cli/generator.h"
#include "cli/shards.h"
#include "store/earlier_result.h"

namespace gumshoe::cli {

void add_report(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("report", "writes a self-contained HTML page and CSV tables for a result");
  struct Options {
    std::string file, out, csv;
    bool force = false;
  };
  const auto o = std::make_shared<Options>();
  command->add_option("result", o->file, "result file (HDF5)")->required();
  command->add_option("-o,--out", o->out, "HTML file (default: next to the result)");
  command->add_option("--csv", o->csv, "folder for the CSV tables (default: that of the page)");
  add_force(*command, o->force);
  command->callback([=, &action] {
    action = [=] {
      const store::Stored stored = store::open_result(o->file);
      inputs::note(stored.identity.scenario_file); // not read, but the page must not replace what it reports on
      refuse_shard(stored.identity, o->file);
      store::require_complete(stored, o->file);
      std::vector<std::string> words{o->file};
      store::require_sound_samples(o->file);
      const std::filesystem::path page =
          !o->out.empty() ? o->out : std::filesystem::path(o->file).replace_extension(".html").string();
      store::Claim(page.string()); // free, and without leftovers; the generator claims it again
      if (!o->out.empty()) words.insert(words.end(), {"--out", o->out});
      if (!o->csv.empty()) words.insert(words.end(), {"--csv", o->csv});
      if (o->force) words.emplace_back("--force");
      return generate(words);
    };
  });
}

} // namespace gumshoe::cli
