#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#include <fmt/format.h>

#include "base/version.h"
#include "cli/command.h"

int main(int argc, char** argv) {
  using namespace gumshoe;
  std::signal(SIGXFSZ, SIG_IGN); // a file-size limit becomes a write error with a message
  CLI::App app{"Gumshoe: uncertainty and sensitivity analysis of on-machine measurement", "gumshoe"};
  app.set_version_flag("--version", std::string("gumshoe ") + version + " (" + git_hash + ")");
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 1 gauge found a difference, 2 bad input, 3 too many failed samples or no convergence, 130 interrupted (the same command resumes).");
  cli::Action action;
  cli::add_check(app, action);
  cli::add_run(app, action);
  cli::add_analyse(app, action);
  cli::add_report(app, action);
  cli::add_evaluate(app, action);
  cli::add_estimate(app, action);
  cli::add_choose(app, action);
  cli::add_trace(app, action);
  cli::add_replay(app, action);
  cli::add_models(app, action);
  cli::add_effects(app, action);
  cli::add_schema(app, action);
  cli::add_gauge(app, action);
  cli::add_fields(app, action);
  try {
    app.parse(argc, argv);
    const ExitCode code = action ? action() : ExitCode::done;
    std::cout.flush();
    if (!std::cout || std::fflush(stdout) != 0) {
      std::cerr << "error: standard output cannot be written.\n";
      return static_cast<int>(ExitCode::bad_input);
    }
    return static_cast<int>(code);
  } catch (const CLI::Success& wanted) { // --help, --version
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    std::vector<std::string> names;
    for (const auto* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (argc > 1 && argv[1][0] != '-' && std::ranges::find(names, argv[1]) == names.end()) {
      const std::string meant = nearest(argv[1], names);
      std::cerr << format({{},
                           fmt::format("unknown command '{}'", argv[1]),
                           meant.empty() ? "gumshoe --help lists them" : "",
                           meant.empty() ? "" : "did you mean '" + meant + "'?"})
                << '\n';
    } else {
      std::cerr << format({{}, error.what(), "--help lists the options", ""}) << '\n';
    }
    return static_cast<int>(ExitCode::bad_input);
  } catch (const std::bad_alloc&) {
    std::cerr << "error: out of memory. Use fewer samples.\n";
  } catch (const InputError& error) {
    std::cerr << error.what() << '\n';
  } catch (const std::exception& error) {
    std::cerr << format({{}, error.what(), "", ""}) << '\n';
  }
  return static_cast<int>(ExitCode::bad_input);
}
