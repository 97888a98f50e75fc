/// `gumshoe report`: hands a result file to the report generator (reports/report.py).
#include <cstdlib>
#include <filesystem>
#include <memory>

#include <sys/wait.h>
#include <unistd.h>

#include "cli/command.h"
#include "store/result_file.h"

namespace gumshoe::cli {

void add_report(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("report", "writes one self-contained HTML page and CSV tables for a result");
  struct Options {
    std::string file, out, csv;
  };
  const auto o = std::make_shared<Options>();
  command->add_option("result", o->file, "result file (HDF5)")->required();
  command->add_option("--out", o->out, "the page (default: beside the result, .html)");
  command->add_option("--csv", o->csv, "folder for the CSV tables (default: beside the page)");
  command->callback([=, &action] {
    action = [=] {
      require_different(o->out, o->file);
      if (!store::read_identity(o->file).complete)
        throw InputError(o->file + ": the run is not finished", "it was interrupted",
                         "run the same command again to resume it?");
      const char* folder = std::getenv("GUMSHOE_REPORTS");
      const std::string script = (std::filesystem::path(folder ? folder : GUMSHOE_REPORTS_DIR) / "report.py").string();
      std::vector<std::string> words{"python3", script, o->file};
      if (!o->out.empty()) words.insert(words.end(), {"--out", o->out});
      if (!o->csv.empty()) words.insert(words.end(), {"--csv", o->csv});
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      const pid_t child = fork();
      if (child == 0) {
        execv("/usr/bin/python3", argv.data());
        _exit(127);
      }
      int status = 0;
      if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status))
        throw InputError("report: the generator could not be started", "/usr/bin/python3 " + script);
      if (WEXITSTATUS(status) == 127) throw InputError("report: /usr/bin/python3 is missing", "", "run scripts/setup?");
      return WEXITSTATUS(status) == 0 ? ExitCode::done : ExitCode::bad_input;
    };
  });
}

} // namespace gumshoe::cli
