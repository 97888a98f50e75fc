#include "cli/generator.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/interrupt.h"
#include "cli/installed.h"

namespace gumshoe::cli {

std::string generator_script() {
  const char* folder = std::getenv("GUMSHOE_REPORTS");
  const std::filesystem::path script =
      std::filesystem::path(folder ? folder : data_folder("reports", GUMSHOE_REPORTS_DIR)) / "report.py";
  std::error_code none;
  if (!std::filesystem::is_regular_file(script, none))
    throw InputError("report: the report generator '" + script.string() + "' does not exist",
                     folder ? "GUMSHOE_REPORTS names its folder" : "it is installed with the program",
                     folder ? "unset GUMSHOE_REPORTS, or set it to the folder of report.py"
                            : "set GUMSHOE_REPORTS to the folder of report.py");
  return script.string();
}

ExitCode generate(const std::vector<std::string>& words) {
  const std::string script = generator_script();
  constexpr const char* python = "/usr/bin/python3";
  // -E: whatever the environment says of modules and paths.
  std::vector<std::string> line{python, "-E", script};
  line.insert(line.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : line) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::cout.flush();
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    execv(python, argv.data());
    _exit(127);
  }
  int status = 0;
  const bool ended = child > 0 && waitpid(child, &status, 0) == child;
  if (interrupted()) {
    if (!ended) kill(child, SIGKILL), waitpid(child, &status, 0);
    throw Interrupted();
  }
  if (!ended || !WIFEXITED(status))
    throw InputError("report: the generator did not run to its end", "/usr/bin/python3 " + script);
  if (WEXITSTATUS(status) == 127) throw InputError("report: /usr/bin/python3 is missing", "", "run scripts/setup");
  return WEXITSTATUS(status) == 0 ? ExitCode::done : ExitCode::bad_input;
}

} // namespace gumshoe::cli
