#include "cli/requested_run.h"

#include <cstdlib>
#include <sstream>

#include <fmt/format.h>
#include <unistd.h>

#include "analysis/analyse.h"
#include "analysis/selection.h"
#include "cli/command.h"
#include "propagation/propagate.h"
#include "scenario/option.h"

namespace gumshoe::cli {

namespace {

/// The options of an adaptive run that determine its results, in addition to the scenario.
std::string adaptive_text(const scenario::Adaptive& a) {
  if (a.rule == scenario::StoppingRule::fixed) return {};
  return fmt::format("{} {} {}", name(a.rule), a.digits, a.most);
}

std::uint64_t samples_of(const RunRequest& r) {
  return whole_number(*r.samples, "--samples", 2, "1e6", scenario::option::largest_whole);
}
std::uint64_t seed_of(const RunRequest& r) { return whole_number(*r.seed, "--seed", 0, "1"); }

/// A scenario that measures nothing is asked for its readings. They may be many: as many samples as fit in 400 MB.
void predict(scenario::Scenario& s, const RunRequest& request) {
  const models::Model* model = s.made ? s.made.get() : models::find(s.model);
  const bool measures = !scenario::evaluated_card(*model->card, s.evaluation).measurands.empty();
  if (measures && !request.predict) return;
  predict_readings(s);
  if (!measures && !request.predict) s.notes.push_back("no measurands: the readings are predicted");
  if (request.samples) return;
  constexpr std::uint64_t most_values = 50'000'000, least = 10'000;
  const std::uint64_t values = s.readings.size() * model->card->indications.size(), stated = s.run.samples;
  while (s.run.samples * values > most_values && s.run.samples / 10 >= least) s.run.samples /= 10;
  if (s.run.samples != stated)
    s.notes.push_back(fmt::format("{} samples instead of {}, for {} readings; --samples sets them", s.run.samples,
                                  stated, s.readings.size()));
}

/// When, where and how long: of a file that is to be reproduced byte by byte (SOURCE_DATE_EPOCH) only the given time.
void stamp(analysis::Results& r, const Begun& begun) {
  r.date = date_text(begun.date);
  if (std::getenv("SOURCE_DATE_EPOCH")) return;
  char name[256] = {};
  if (gethostname(name, sizeof name - 1) == 0) r.host = name;
  r.duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun.clock).count();
}

} // namespace

std::string RunRequest::words() const {
  std::string text;
  const auto add = [&](const std::string& word) { text += (text.empty() ? "" : " ") + word; };
  if (samples) add(fmt::format("--samples {}", samples_of(*this)));
  if (seed) add(fmt::format("--seed {}", seed_of(*this)));
  if (predict) add("--predict");
  return text;
}

RunRequest RunRequest::of(const std::string& words) {
  RunRequest request;
  std::istringstream in(words);
  for (std::string word; in >> word;) {
    if (word == "--samples" && in >> word)
      request.samples = word;
    else if (word == "--seed" && in >> word)
      request.seed = word;
    else if (word == "--predict")
      request.predict = true;
  }
  return request;
}

scenario::Scenario scenario_of_run(const std::string& file, const RunRequest& request,
                                   const scenario::Overrides& overrides) {
  scenario::Scenario s = scenario::read(file, catalogue(), overrides);
  if (request.samples) {
    s.run.samples = samples_of(request);
    s.run.adaptive = {}; // the number is given
  }
  if (s.run.adaptive.rule != scenario::StoppingRule::fixed)
    s.run.samples = propagation::block_samples; // room is made as the run goes
  if (request.seed) s.run.seed = seed_of(request);
  predict(s, request);
  return s;
}

store::Identity identity_of_run(const propagation::Experiment& experiment) {
  store::Identity identity = store::identity_of(experiment.scenario());
  identity.adaptive = adaptive_text(experiment.scenario().run.adaptive);
  identity.design_hash = propagation::design_hash(experiment);
  return identity;
}

ExitCode complete_run(const propagation::Experiment& experiment, store::ResultFile& file,
                      const analysis::StoppingRecord& stopping, const Begun& begun, const std::string& out,
                      const propagation::Workers& workers, PrintOptions print, ProgressLine& line) {
  const StudyProgress studies(line);
  analysis::Results results = analysis::analyse(experiment, file.view(), workers);
  results.stopping = stopping;
  stamp(results, begun);
  analysis::keep_measurands(results, experiment.scenario().analysis.measurands);
  file.finish(results, workers.threads);
  line.clear();
  print.max_failed_share = experiment.scenario().run.max_failed_share;
  return print_results(results, out, print);
}

} // namespace gumshoe::cli
