#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include <unistd.h>

#include <fmt/format.h>

#include "base/interrupt.h"
#include "base/memory.h"
#include "base/version.h"
#include "cli/command.h"
#include "propagation/ranks.h"

namespace {

int interrupted_exit() {
  std::cerr << "interrupted. " << gumshoe::said_when_interrupted() << '\n';
  return static_cast<int>(gumshoe::ExitCode::interrupted);
}

/// The exit code, after what was printed has been written: a full disk or a closed pipe is an error of every command.
int printed(int code) {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0) return code;
  std::cerr << "error: standard output cannot be written.\n";
  return static_cast<int>(gumshoe::ExitCode::bad_input);
}

/// An error that none of our code phrased. oneTBB says "pthread_create has failed" without a type of its own.
gumshoe::Problem foreign_problem(const std::exception& error) {
  const std::string what = error.what();
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if ((system && system->code() == std::errc::resource_unavailable_try_again) || what.starts_with("pthread_create"))
    return {{},
            "no further thread can be started",
            "a limit of processes or memory is reached",
            "use fewer threads (--threads 1 needs no further one), or raise the limit"};
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
    return {{}, fmt::format("'{}': {}", file->path1().string(), file->code().message()), "", ""};
  return {{}, what, "", ""};
}

/// An exception in a thread of oneTBB reaches no handler of ours. A run keeps the samples that its file has.
[[noreturn]] void end_in_any_thread() {
  try {
    std::rethrow_exception(std::current_exception());
  } catch (const std::exception& error) {
    const std::string line = format(foreign_problem(error)) + '\n';
    if (write(2, line.data(), line.size()) == static_cast<ssize_t>(line.size()))
      _exit(static_cast<int>(gumshoe::ExitCode::bad_input));
  } catch (...) {
  }
  std::abort();
}

int command_line(int argc, char** argv) {
  using namespace gumshoe;
  CLI::App app{"Gumshoe: uncertainty and sensitivity analysis of on-machine measurement", "gumshoe"};
  app.set_version_flag("--version", std::string("gumshoe ") + version + " (" + git_hash + ")");
  app.require_subcommand(1);
  cli::Action action;
  const auto launch = propagation::launched();
  const bool silent = launch && launch->rank > 0; // the first rank speaks for all
  cli::add_new(app, action);
  cli::add_check(app, action);
  cli::add_run(app, action);
  cli::add_merge(app, action);
  cli::add_analyse(app, action);
  cli::add_report(app, action);
  cli::add_evaluate(app, action);
  cli::add_estimate(app, action);
  cli::add_compare(app, action);
  cli::add_combine(app, action);
  cli::add_choose(app, action);
  cli::add_trace(app, action);
  cli::add_plan(app, action);
  cli::add_compensate(app, action);
  cli::add_volume(app, action);
  cli::add_replay(app, action);
  cli::add_models(app, action);
  cli::add_effects(app, action);
  cli::add_schema(app, action);
  cli::add_gauge(app, action);
  cli::add_fields(app, action);
  cli::add_help(app, action);
  try {
    app.parse(argc, argv);
    cli::refuse_empty_words(*app.get_subcommands().front());
    if (launch && !app.got_subcommand("run") && !app.got_subcommand("choose")) {
      if (silent) return 0;
      throw InputError("gumshoe " + app.get_subcommands().front()->get_name() + " is the work of one process",
                       "a launcher of MPI started several", "start it without the launcher");
    }
    catch_interrupts();
    return printed(static_cast<int>(action ? action() : ExitCode::done));
  } catch (const Interrupted&) {
    return interrupted_exit();
  } catch (const CLI::Success& wanted) { // --help, --version
    return silent ? 0 : printed(app.exit(wanted));
  } catch (const CLI::ParseError& error) {
    if (silent) return 0;
    std::cerr << format(cli::parse_problem(app, {argv + 1, argv + argc}, error)) << '\n';
    return static_cast<int>(ExitCode::bad_input);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const InputError& error) {
    if (interrupted()) return interrupted_exit(); // a signal reached a program that we wait for, too
    std::cerr << error.what() << '\n';
  } catch (const std::exception& error) {
    std::cerr << format(foreign_problem(error)) << '\n';
  }
  return static_cast<int>(ExitCode::bad_input);
}

} // namespace

int main(int argc, char** argv) try {
  std::set_terminate(end_in_any_thread);
  gumshoe::prefer_large_pages_of_heap();
  std::signal(SIGXFSZ, SIG_IGN); // a file-size limit becomes a write error with a message
  return command_line(argc, argv);
} catch (const std::bad_alloc&) {
  std::cerr << "error: out of memory. Use fewer samples, or smaller studies of sensitivity.\n";
  return static_cast<int>(gumshoe::ExitCode::bad_input);
}
