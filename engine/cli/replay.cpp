/// `gumshoe replay`: one sample of a run again, with every intermediate value.
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "base/instruction_set.h"
#include "base/units.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/recomputed.h"
#include "cli/shards.h"
#include "propagation/propagate.h"
#include "store/result_file.h"
#include "store/stored_samples.h"

namespace gumshoe::cli {

namespace {

scenario::Scenario scenario_of(const store::Identity& identity, const std::string& result) {
  require_scenario(identity, result);
  scenario::Scenario s = scenario::read(identity.scenario_file, catalogue(), {.external = identity.external});
  if (s.hash != identity.scenario_hash)
    throw InputError(result + ": " + identity.scenario_file + " has changed since this result was made",
                     "hash " + s.hash + ", in the result " + identity.scenario_hash,
                     "restore the scenario and its data, or run again");
  s.run.samples = identity.samples;
  s.run.seed = identity.seed;
  if (identity.method == name(scenario::Method::prediction)) predict_readings(s);
  return s;
}

/// In a virtual experiment the drawn values are the truth: the indications are simulated from them, and
/// the evaluation uses the estimates. `simulated`: the reading's indications as evaluated, with noise included and
/// stated effects subtracted.
void print_reading(const propagation::Experiment& e, std::size_t r, const std::vector<double>& variates,
                   const std::vector<double>& simulated) {
  const auto& s = e.scenario();
  const std::string name = e.reading_names()[r];
  std::cout << "\nreading" << (name.empty() ? "" : " [" + name + "]") << '\n';
  const bool virtual_experiment = s.method == scenario::Method::virtual_experiment;
  const auto first_indication = static_cast<std::ptrdiff_t>(e.layout().indications.begin);
  auto point = e.reading_point(r, variates.data());
  const auto estimates = e.reading_point(r);
  if (virtual_experiment) {
    std::copy(simulated.begin(), simulated.end(), point.begin() + first_indication);
    for (const propagation::StatedSize& t : e.forward().stated()) // as the readout shows it
      if (e.layout().indications.contains(t.target)) point[t.target] += estimates[t.quantity] * t.loading[r];
  }
  for (std::size_t q = 0; q < point.size(); ++q)
    std::cout << fmt::format("  {:<44} {:.17g} {}\n", s.quantities[q].name,
                             units::from_si(point[q], s.quantities[q].unit, s.quantities[q].si_unit),
                             s.quantities[q].unit);
  if (virtual_experiment) {
    std::cout << "  evaluated at the estimates\n";
    point = estimates;
    std::copy(simulated.begin(), simulated.end(), point.begin() + first_indication);
  } else {
    e.forward().subtract_stated(r, point.data());
  }
  if (s.method == scenario::Method::prediction) return; // nothing is evaluated
  std::cout << "  intermediate values\n";
  for (const auto& i : e.forward().explain(r, point))
    std::cout << fmt::format("    {:<42} {:.17g} {}\n", i.name, i.value, i.unit);
}

/// Throws InputError where the file has other outputs. @param now  of the sample, by output
void require_stored(const propagation::Experiment& e, const store::Stored& stored, const std::string& file,
                    std::uint64_t sample, const std::vector<double>& now) {
  const store::Identity& i = stored.identity;
  if (sample >= stored.samples_done || (stored.complete && !i.store_samples)) {
    std::cerr << "note: the file does not hold this sample, so its outputs are not compared\n";
    return;
  }
  const store::StoredSamples samples(file, e.outputs());
  const auto read = [&](std::size_t output, std::uint64_t first, std::uint64_t count) {
    return samples.read(output, first, count);
  };
  const bool bits = i.external.empty() && i.version == version && i.instruction_set == name(best_instruction_set());
  const std::string how =
      difference(e, {{0, stored.samples_done}, read}, {sample, sample + 1}, now, bits ? Same::bits : Same::rounding);
  if (!how.empty())
    throw InputError(file + ": the sample comes from another model", how,
                     "restore what the model was then, or run the scenario again");
}

} // namespace

void add_replay(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("replay", "repeats one sample of a result and prints every intermediate value");
  struct Options {
    std::string file, sample;
  };
  const auto o = std::make_shared<Options>();
  command->add_option("result", o->file, "result file (HDF5)")->required();
  command->add_option("--sample", o->sample, "index of the sample, from 0")->required();
  add_external(*command);
  command->callback([=, &action] {
    action = [=] {
      const store::Stored stored = store::open_result(o->file);
      refuse_shard(stored.identity, o->file);
      if (!stored.identity.has_outputs())
        throw InputError(o->file + ": the file holds no run", "gumshoe " + stored.command() + " made it",
                         "use gumshoe run");
      store::require_sound_samples(o->file);
      const std::uint64_t sample = whole_number(o->sample, "--sample", 0, "0");
      if (sample >= stored.identity.samples)
        throw InputError(fmt::format("--sample: {} is beyond the run", sample),
                         fmt::format("{} samples, counted from 0", stored.identity.samples));
      const scenario::Scenario s = scenario_of(stored.identity, o->file);
      const propagation::Experiment e(s);
      const auto variates = propagation::variates_of(e, sample);
      std::cout << fmt::format("sample {} of {} (seed {}, {})\n\nvariates: deviations drawn\n", sample,
                               stored.identity.samples, s.run.seed, s.file);
      for (std::size_t v = 0; v < variates.size(); ++v) {
        const auto& q = s.quantities[e.plan().variates[v].quantity];
        std::cout << fmt::format("  {:<44} {:.17g} {}\n", e.plan().variates[v].name,
                                 units::from_si(variates[v], q.unit, q.si_unit, units::Kind::difference), q.unit);
      }
      // Through the block kernels, as in the run: the same bits.
      propagation::Workspace w;
      std::vector<double> drawn, outputs(e.outputs().size() * 8);
      for (const double v : variates) drawn.insert(drawn.end(), 8, v);
      std::vector<const double*> pointers;
      for (std::size_t v = 0; v < variates.size(); ++v) pointers.push_back(&drawn[v * 8]);
      std::vector<std::uint8_t> status(8);
      e.run(pointers, 8, w, outputs.data(), status.data());
      const std::size_t k = e.model().card->indications.size();
      for (std::size_t r = 0; r < s.readings.size(); ++r) {
        std::vector<double> indications;
        for (std::size_t i = 0; i < k; ++i) indications.push_back(w.indications[(r * k + i) * 8]);
        print_reading(e, r, variates, indications);
      }
      std::cout << "\noutputs\n";
      for (std::size_t i = 0; i < e.outputs().size(); ++i) {
        const auto& out = e.outputs()[i];
        std::cout << fmt::format("  {:<44} {:.17g} {}\n", out.name,
                                 units::from_si(outputs[i * 8], out.unit, out.si_unit), out.unit);
      }
      std::cout << "status " << status_name(static_cast<Status>(status[0])) << '\n' << std::flush;
      std::vector<double> now;
      for (std::size_t i = 0; i < e.outputs().size(); ++i) now.push_back(outputs[i * 8]);
      require_stored(e, stored, o->file, sample, now);
      return ExitCode::done;
    };
  });
}

} // namespace gumshoe::cli
