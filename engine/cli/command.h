#pragma once
/// The subcommands of `gumshoe`, one file each. Numbers go to stdout, progress and errors to stderr.
#include <ctime>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "models/model.h"
#include "scenario/scenario.h"

namespace gumshoe::cli {

/// What the chosen subcommand will do; main runs it and maps errors to exit codes.
using Action = std::function<ExitCode()>;

void add_new(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_analyse(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_evaluate(CLI::App& app, Action& action);
void add_estimate(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_combine(CLI::App& app, Action& action);
void add_choose(CLI::App& app, Action& action);
void add_trace(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_compensate(CLI::App& app, Action& action);
void add_volume(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_models(CLI::App& app, Action& action);
void add_effects(CLI::App& app, Action& action);
void add_schema(CLI::App& app, Action& action);
void add_gauge(CLI::App& app, Action& action);
void add_fields(CLI::App& app, Action& action);
void add_help(CLI::App& app, Action& action); ///< after all others: examples, `man`, `completion`

/// What is wrong with a command line that CLI11 refuses, with the nearest command or option.
Problem parse_problem(const CLI::App& app, const std::vector<std::string>& words, const CLI::ParseError& error);
/// Throws InputError if an option or an argument of the command was given as an empty text, which would pass for none.
void refuse_empty_words(const CLI::App& command);

/// Models and effects as the scenario parser wants them.
scenario::Catalogue catalogue();

/// "1e6" or "1000000" as a whole number of at least `least` and at most `most`; throws InputError naming the option.
std::uint64_t whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                           const std::string& example, std::uint64_t most = 1'000'000'000'000'000);

/// Writes a table as text. It carries no mark: only an equal one is known to be ours, and another is replaced by force.
void write_table(const std::string& path, const std::string& text, bool force);

/// A moment as files state it; SOURCE_DATE_EPOCH instead, where a file is to be reproduced byte by byte.
std::string date_text(std::time_t moment);

/// Where a command writes unless told otherwise: results/NAME + `ending`, NAME being that of the scenario. Makes the
/// folder.
std::string default_output(const std::string& scenario, const std::string& ending);

/// The option --allow-external, without which a scenario of another user starts no program and loads no library, unless
/// the environment's GUMSHOE_TRUSTED names a folder that it is in.
void add_external(CLI::App& command);

/// The option --threads.
void add_threads(CLI::App& command, int& threads);

/// The option --force.
void add_force(CLI::App& command, bool& force);

/// The options --format, --budget and --all.
struct PrintOptions;
void add_print(CLI::App& command, PrintOptions& print);

} // namespace gumshoe::cli
