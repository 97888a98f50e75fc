#pragma once
/// Scenarios made ready for tracing, with readings that the model itself gives under an effect: free of noise.
#include <fmt/format.h>

#include "tracing/candidates/extended_scenario.h"
#include "tracing/candidates/shapes.h"
#include "tracing/fit/joint_fit.h"
#include "unit/known_case.h"

namespace tracing_case {

using namespace gumshoe;
using namespace gumshoe::tracing;
using known_case::known;

/// The text's scenario, extended by all effects at null.
struct Case {
  scenario_fixture::Folder folder;
  scenario::Scenario scenario;
  std::unique_ptr<propagation::Experiment> experiment;
  std::unique_ptr<Simulator> simulator;
  Observations observations;
  std::unique_ptr<Fitter> fitter;

  explicit Case(const std::string& text) : scenario(extended(scenario::read(folder.write("s.toml", text), known()))) {
    prepare();
  }
  explicit Case(scenario::Scenario ready) : scenario(std::move(ready)) { prepare(); }

  void prepare() {
    experiment = std::make_unique<propagation::Experiment>(scenario);
    simulator = std::make_unique<Simulator>(*experiment, 1);
    observations = observe(*experiment);
    std::vector<Index> rows;
    for (std::size_t i = 0; i < observations.readings * observations.indications; ++i)
      rows.push_back(static_cast<Index>(i));
    fitter = std::make_unique<Fitter>(*experiment, *simulator, observations, rows, 1);
  }

  std::size_t quantity(const std::string& name) const {
    for (std::size_t q = 0; q < scenario.quantities.size(); ++q)
      if (scenario.quantities[q].name == name) return q;
    throw InputError("no quantity " + name);
  }

  /// Readings become what the model gives at these values of all quantities.
  void measure(const Points& at, const Vector& noise = {}) {
    Vector f;
    if (!simulator->simulate(at, f)) throw InputError("no value");
    const std::size_t k = observations.indications;
    for (std::size_t r = 0; r < scenario.readings.size(); ++r)
      for (std::size_t i = 0; i < k; ++i) {
        const auto row = static_cast<Index>(r * k + i);
        scenario.readings[r].indications[i] = f[row] + (noise.size() > 0 ? noise[row] : 0);
      }
    prepare();
  }

  /// Signatures at the point of a fit.
  std::vector<Candidate> candidates(const JointFit& fit, double step = 3e-6) const {
    return physical_candidates(*experiment, *simulator, fit.at, observations, step,
                               [](const Candidate&) { return false; });
  }
  /// A term of one candidate, to begin with at zero: the tangent, or with a shape held.
  Term term(const JointFit& fit, const std::string& name, const std::string& quantity = "") const {
    for (Candidate& a : candidates(fit))
      if (a.name == name && a.finite == 0 && (quantity.empty() || a.amplitudes[0].name == quantity))
        return {a, Vector::Zero(a.columns.cols())};
    throw InputError("no candidate " + name);
  }
};

/// Two rods in four set-ups at five feeds, down and up; laser_z free in every set-up.
inline std::string rods(const std::string& more = "") {
  std::string rows;
  double time = 0;
  for (int setup = 1; setup <= 4; ++setup)
    for (const double feed : {20., 100., 300., 600., 1000.})
      for (const char* rod : {"1", "2"})
        rows +=
            fmt::format("{{ setup = \"{}\", rod = \"{}\", feed = \"{} mm/min\", time = \"{} s\", direction = \"{}\", "
                        "values = [\"-349.2 mm\"] }},\n",
                        setup, rod, feed, time += 37 + 5 * setup * setup, setup % 2 == 0 ? 1 : -1);
  return "schema = 1\nmodel = { name = \"rod_gauging\" }\n"
         "[quantities.laser_z]\nestimated = true\n[quantities.laser_z.by.setup]\n"
         "\"1\" = { value = \"-510 mm\" }\n\"2\" = { value = \"-510.01 mm\" }\n\"3\" = { value = \"-509.98 mm\" }\n"
         "\"4\" = { value = \"-510 mm\" }\n"
         "[quantities.beam_pitch]\nvalue = \"0.2836 deg\"\nu = \"0.002 deg\"\n"
         "[quantities.beam_yaw]\nvalue = \"0.5 deg\"\n"
         "[quantities.rod_length.by.rod]\n\"1\" = { value = \"160.591 mm\", u = \"1 um\" }\n"
         "\"2\" = { value = \"179.822 mm\", u = \"1 um\" }\n" +
         more + "[indications.spindle_z]\nrows = [\n" + rows +
         "]\ncomponents = [ { distribution = \"normal\", u = \"0.3 um\", per = \"reading\" } ]\n"
         "[trace]\norder = \"time\"\nblocks = \"setup\"\n";
}

} // namespace tracing_case
