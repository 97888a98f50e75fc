#include <iostream>

#include <fmt/format.h>

#include "cli/command.h"
#include "propagation/experiment.h"

namespace gumshoe::cli {

void add_check(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("check", "checks a scenario, and shows how it was understood; runs its command or loads its plugin once");
  struct Options {
    std::string file;
    bool explain = false;
  };
  const auto o = std::make_shared<Options>();
  command->add_option("scenario", o->file, "scenario file (TOML)")->required();
  command->add_flag("--explain", o->explain, "print the scenario as understood, in SI, with every default");
  add_external(*command);
  command->callback([=, &action] {
    action = [=] {
      const auto known = catalogue();
      const scenario::Scenario s = scenario::read(o->file, known);
      const propagation::Experiment experiment(s); // labels, correlations and values fit together
      if (o->explain) std::cout << scenario::explain(s, known);
      if (!s.external.empty())
        std::cout << fmt::format("note: the scenario names code of its own, which this check ran with your rights: {}\n",
                                 s.external);
      for (const std::string& note : scenario::notes_of_a_run(s)) std::cout << "note: " << note << '\n';
      const auto counted = [](std::size_t n, const char* what) {
        return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
      };
      std::cout << fmt::format(
          "{}: good: model {}, {}, {}, {}\n", o->file, s.model, counted(s.readings.size(), "reading"),
          counted(experiment.plan().variates.size(), "variate"), counted(experiment.outputs().size(), "output"));
      return ExitCode::done;
    };
  });
}

} // namespace gumshoe::cli
