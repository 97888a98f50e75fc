#include "cli/generator.h"

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <sys/wait.h>
#include <unistd.h>

namespace gumshoe::cli {

ExitCode generate(const std::vector<std::string>& words) {
  const char* folder = std::getenv("GUMSHOE_REPORTS");
  const std::string script = (std::filesystem::path(folder ? folder : GUMSHOE_REPORTS_DIR) / "report.py").string();
  std::vector<std::string> line{"python3", script};
  line.insert(line.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : line) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::cout.flush();
  const pid_t child = fork();
  if (child == 0) {
    execv("/usr/bin/python3", argv.data());
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status))
    throw InputError("report: the generator did not run to its end", "/usr/bin/python3 " + script);
  if (WEXITSTATUS(status) == 127) throw InputError("report: /usr/bin/python3 is missing", "", "run scripts/setup");
  return WEXITSTATUS(status) == 0 ? ExitCode::done : ExitCode::bad_input;
}

} // namespace gumshoe::cli
