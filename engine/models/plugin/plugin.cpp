#include "models/plugin/plugin.h"

#include <mutex>

#include <fmt/format.h>

#include "models/made_card.h"
#include "models/plugin/crash_guard.h"
#include "models/plugin/diverted_output.h"
#include "models/plugin/library.h"
#include "models/shown_columns.h"

namespace gumshoe::models {
namespace {

struct Plugin {
  Plugin(const gumshoe_model& by_library, PluginPlace at)
      : place(std::move(at)), described(by_library), card(card_of(by_library, place)), crash_start(place.crashed()) {}

  PluginPlace place;
  const gumshoe_model& described;
  MadeCard card;
  std::string crash_start;
  mutable std::mutex one_at_a_time;
  Model model{};
};

std::vector<gumshoe_column> columns(const std::vector<Column>& from) {
  std::vector<gumshoe_column> out;
  for (const Column& c : from) out.push_back({c.data, c.stride});
  return out;
}

void guarded(const Plugin& p, int (*function)(const gumshoe_batch*), const gumshoe_batch& batch,
             std::uint64_t first_sample) {
  std::unique_lock<std::mutex> lock(p.one_at_a_time, std::defer_lock);
  if (p.described.threads == 0) lock.lock();
  int code = 0;
  bool threw = false;
  {
    const DivertedOutput diverted;
    const CrashGuard guard(p.crash_start, first_sample, batch.samples);
    try {
      code = function(&batch);
    } catch (...) { // written in C++, against the rules of a C interface
      threw = true;
    }
  }
  batch.error[batch.error_size - 1] = '\0';
  if (threw)
    p.place.refuse("threw an exception at " + span_text(first_sample, 0, batch.samples),
                   "exceptions must not cross the C interface", "return a code and a text instead");
  if (code != 0)
    p.place.refuse(fmt::format("failed at {}", span_text(first_sample, 0, batch.samples)),
                   *batch.error ? std::string(batch.error) : fmt::format("it returned {} without a text", code), "");
}

void call_plugin(const BlockCall& call, bool simulating) {
  const Plugin& p = *static_cast<const Plugin*>(call.context);
  const ModelCard& card = p.card.card();
  const std::size_t measurands = card.measurands.size(), indications = card.indications.size();
  for (std::size_t r = 0; r < call.readings; ++r) {
    const ShownReading shown = shown_reading(card, call, r, !simulating);
    const auto quantities = columns(shown.quantities), conditions = columns(shown.conditions),
               read = columns(shown.indications);
    std::vector<unsigned char> failed(call.samples, 0);
    char error[1024] = "";
    guarded(p, simulating ? p.described.simulate : p.described.evaluate,
            {call.samples, quantities.data(), conditions.data(), simulating ? nullptr : read.data(),
             call.measurands + r * measurands, simulating ? call.simulated + r * indications : nullptr, failed.data(),
             error, sizeof error},
            call.first_sample);
    for (std::size_t i = 0; i < call.samples; ++i)
      if (failed[i] != 0 && call.status[i] == 0) call.status[i] = code(Status::model_failed);
    for (std::size_t m = 0; m < measurands; ++m)
      take_shown(card.measurands[m], call.measurands[r * measurands + m], call.samples, call.status);
    for (std::size_t i = 0; simulating && i < indications; ++i)
      take_shown(card.indications[i], call.simulated[r * indications + i], call.samples, call.status);
  }
}

void simulate(const BlockCall& call) { call_plugin(call, true); }
void evaluate(const BlockCall& call) { call_plugin(call, false); }

const Kernels* evaluating() {
  static constexpr Kernels kernels{nullptr, &evaluate};
  return &kernels;
}
const Kernels* both() {
  static constexpr Kernels kernels{&simulate, &evaluate};
  return &kernels;
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  return explained(static_cast<const Plugin*>(call.context)->card.card(), call, &evaluate);
}

/// Evaluations at the estimates, so that `gumshoe check` finds a plugin that crashes, refuses or is no function.
std::string check(const PointCall<double>& call) {
  const Plugin& p = *static_cast<const Plugin*>(call.context);
  if (const std::string how = differing_answers(p.card.card(), call, &evaluate); !how.empty())
    p.place.refuse("gives different results at the same point",
                   how + "; it draws random numbers of its own, or its points depend on one another",
                   "make it a function of its input: random errors are quantities of the scenario");
  return {};
}

} // namespace

MadeModel load_plugin(const std::string& path, const std::string& name, const Location& where) {
  const PluginPlace place{name, where};
  const auto plugin = std::make_shared<Plugin>(open_library(path, place), place);
  Model& m = plugin->model;
  m.card = &plugin->card.card();
  m.kernels = plugin->described.simulate ? &both : &evaluating;
  m.explain = &explain;
  m.check = &check;
  m.solve_reads = [](std::size_t) { return true; };
  m.context = plugin.get();
  return MadeModel(plugin, &m);
}

} // namespace gumshoe::models
