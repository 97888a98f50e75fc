#include <iostream>

#include <fmt/format.h>

#include "base/status_meaning.h"
#include "cli/command.h"
#include "propagation/experiment.h"

namespace gumshoe::cli {

namespace {

/// What becomes of a sample whose every quantity has its estimate. A program that a user wrote is not run for it.
Status at_estimates(const propagation::Experiment& experiment) {
  if (!experiment.scenario().external.empty()) return Status::ok;
  constexpr std::size_t lanes = 8;
  const std::vector<const double*> columns(experiment.plan().columns.size(), nullptr);
  std::vector<double> outputs(experiment.outputs().size() * lanes);
  std::vector<std::uint8_t> status(lanes);
  propagation::Workspace workspace;
  experiment.run_columns(columns, lanes, workspace, outputs.data(), status.data());
  return static_cast<Status>(status[0]);
}

} // namespace

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
      if (const Status status = at_estimates(experiment); status != Status::ok)
        std::cout << fmt::format("warning: at the estimates there is no value: {} ({}); samples near them will fail\n",
                                 status_name(status), status_meaning(status));
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
