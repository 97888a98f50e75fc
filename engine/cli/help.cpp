/// What --help adds to the options: examples and what an interruption does; `gumshoe man` and `gumshoe completion`, which
/// follow from the same tables. Neither is listed by --help's table of commands.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "base/version.h"
#include "cli/command.h"

namespace gumshoe::cli {

namespace {

struct CommandHelp {
  const char *name, *example, *about, *interrupted;
};
constexpr const char* again = "Interrupted, it writes nothing; the same command starts from the beginning.";
constexpr CommandHelp helps[] = {
    {"new", "gumshoe new rod_gauging", "writes rod_gauging.toml, a scenario to go on from", again},
    {"check", "gumshoe check scenarios/rod_gauging.toml --explain", "prints the scenario as understood, in SI", again},
    {"run", "gumshoe run scenarios/rod_gauging.toml --samples 1e5 --budget", "prints the result with its budget",
     "Interrupted, it keeps its samples; the same command resumes. Studies after sampling are made again."},
    {"merge", "gumshoe merge shards/*.h5 --out results/x.h5", "joins the shards of a run",
     "Interrupted, the same command goes on."},
    {"analyse", "gumshoe analyse results/x.h5 --scenario y.toml", "analyses stored samples with another [analysis]",
     "Interrupted, the same command makes the analysis again."},
    {"report", "gumshoe report results/x.h5", "writes results/x.html and CSV tables", again},
    {"evaluate", "gumshoe evaluate rod_gauging --table points.csv", "evaluates the model at the rows of a table",
     again},
    {"estimate", "gumshoe estimate scenarios/gauge/gum_h3.toml", "fits the quantities marked as estimated", again},
    {"compare", "gumshoe compare before.h5 after.h5", "says whether two results agree, and what changed", ""},
    {"combine", "gumshoe combine a.h5 b.h5 --same NAME --out mean.toml", "weighted mean of results that share an input",
     ""},
    {"choose", "gumshoe choose scenarios/choose_rod_readouts.toml --samples 1e4", "finds the fastest settings", again},
    {"trace", "gumshoe trace scenarios/trace_sphere.toml --report page.html", "finds what the model lacks",
     "Interrupted, it writes nothing, or all but the report and the history; the same command starts from the "
     "beginning."},
    {"plan", "gumshoe plan scenarios/plan_axis.toml", "says what to measure next", again},
    {"compensate", "gumshoe compensate x.traced.toml --format linuxcnc-trim",
     "writes a table that a control corrects by", ""},
    {"volume", "gumshoe volume scenarios/volume_five_axis.toml", "maps the errors of a machine over its working volume",
     again},
    {"replay", "gumshoe replay results/x.h5 --sample 12345", "repeats one sample with every intermediate value", again},
    {"models", "gumshoe models rod_gauging", "quantities, units, defaults, limits, meaning", ""},
    {"effects", "gumshoe effects z_scale", "the same for an effect", ""},
    {"schema", "gumshoe schema > scenario.schema.json", "the JSON Schema, for an editor", ""},
    {"gauge", "gumshoe gauge", "compares with all published examples shipped with the program", again},
};

constexpr const char* exit_codes =
    "Exit codes: 0 done, 1 gauge found a difference, 2 bad input, 3 too many failed samples or no convergence, 130 "
    "interrupted.";

std::vector<CLI::App*> listed(CLI::App& app) {
  return app.get_subcommands([](CLI::App* command) { return !command->get_group().empty(); });
}

/// For roff: no line may begin with a point or an apostrophe, backslashes and hyphens are written out.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

void print_man(CLI::App& app) {
  std::cout << fmt::format(".TH GUMSHOE 1 \"\" \"gumshoe {}\" \"User Commands\"\n.SH NAME\ngumshoe \\- {}\n", version,
                           roff("uncertainty and sensitivity analysis of on-machine measurement"))
            << ".SH SYNOPSIS\n.B gumshoe\n.I COMMAND\n[\\fIOPTIONS\\fR]\n.SH COMMANDS\n";
  for (CLI::App* command : listed(app)) {
    std::string positional;
    for (const auto* o : command->get_options([](const CLI::Option* one) { return one->get_positional(); }))
      positional += fmt::format(" \\fI{}\\fR", roff(o->get_name()));
    std::cout << fmt::format(".SS {}{}\n{}\n", command->get_name(), positional, roff(command->get_description()));
    for (const auto* o : command->get_options())
      if (o->get_name() != "--help")
        std::cout << fmt::format(".TP\n.B {}\n{}\n", roff(o->get_name(false, true)), roff(o->get_description()));
    for (const CommandHelp& help : helps)
      if (command->get_name() == help.name)
        std::cout << fmt::format(".PP\n{}\n.PP\nExample ({}):\n.PP\n.RS\n.nf\n{}\n.fi\n.RE\n", roff(help.interrupted),
                                 roff(help.about), roff(help.example));
  }
  std::cout << ".SH EXIT STATUS\n" << roff(exit_codes) << '\n';
}

std::string words_of(const CLI::App& command) {
  std::string words;
  for (const auto* o : command.get_options())
    for (const std::string& name : o->get_lnames()) words += (words.empty() ? "--" : " --") + name;
  return words;
}

/// "text json", the values of a command's option --format; empty: it has none.
std::string formats_of(const CLI::App& command) {
  const CLI::Option* format = command.get_option_no_throw("--format");
  if (!format) return {};
  const std::string type = format->get_type_name(); // "TEXT:{text,json}"
  const auto begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::string words = type.substr(begin + 1, end - begin - 1);
  std::ranges::replace(words, ',', ' ');
  return words;
}

/// For bash: commands, then the options of the command, then files. zsh takes it through bashcompinit.
void print_completion(CLI::App& app) {
  std::string names, formats, cases;
  for (CLI::App* command : listed(app)) {
    if (const std::string words = formats_of(*command); !words.empty())
      formats += fmt::format("      {}) options=\"{}\" ;;\n", command->get_name(), words);
    names += (names.empty() ? "" : " ") + command->get_name();
    cases += fmt::format("    {}) options=\"{}\" ;;\n", command->get_name(), words_of(*command));
  }
  std::cout << fmt::format(R"(# Completion of gumshoe for bash; in zsh after: autoload -U bashcompinit && bashcompinit
_gumshoe() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" options=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{} --help --version" -- "$word"))
    return
  fi
  case "${{COMP_WORDS[COMP_CWORD-1]}}" in
    --format) case "${{COMP_WORDS[1]}}" in
{}    esac
    COMPREPLY=($(compgen -W "$options" -- "$word")); return ;;
  esac
  case "${{COMP_WORDS[1]}}" in
{}  esac
  case "$word" in
    -*) COMPREPLY=($(compgen -W "$options" -- "$word")) ;;
    *) local IFS=$'\n'; COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}}
complete -o filenames -F _gumshoe gumshoe
)",
                           names, formats, cases);
}

void add_printer(CLI::App& app, Action& action, const char* name, const char* meaning, void (*print)(CLI::App&)) {
  app.add_subcommand(name, meaning)->group("")->callback([&app, &action, print] {
    action = [&app, print] {
      print(app);
      return ExitCode::done;
    };
  });
}

} // namespace

void add_help(CLI::App& app, Action& action) {
  add_printer(app, action, "man", "the manual page, in roff", print_man);
  add_printer(app, action, "completion", "completion for bash", print_completion);
  for (const CommandHelp& help : helps)
    app.get_subcommand(help.name)->footer(fmt::format("Example: {}\n    {}\n{}", help.about, help.example, help.interrupted));
  app.footer(std::string(exit_codes) +
             "\nEach command explains its options and gives an example with --help. `gumshoe man` prints the manual "
             "page, `gumshoe completion` the completion for bash.");
}

} // namespace gumshoe::cli
