/// Block loops of the mill model, scalar inside: the solve branches too much for lanes.
#include "models/tool_length/procedures.h"

namespace gumshoe::models {
namespace {

double load(const Column& c, std::size_t i) { return c.data[c.stride * i]; }

template <class Finish> void for_each_sample(const BlockCall& call, bool with_solve, const Finish& finish) {
  double q[mill::count], condition[mill::conditions];
  std::vector<double> e(call.effect_quantities + 1);
  chain::TriggerSolver solver;
  for (std::size_t i = 0; i < call.samples; ++i)
    for (std::size_t r = 0; r < call.readings; ++r) {
      for (std::size_t j = 0; j < mill::count; ++j) q[j] = load(call.quantities[r * mill::count + j], i);
      for (std::size_t j = 0; j < call.effect_quantities; ++j)
        e[j] = load(call.effects[r * call.effect_quantities + j], i);
      for (std::size_t j = 0; j < mill::conditions; ++j)
        condition[j] = load(call.conditions[r * mill::conditions + j], i);
      const auto event = mill::probing_event<double>(q, condition, e.data(), call.active);
      double height = 0;
      auto status = chain::SolveStatus::ok;
      if (mill::impossible(q, condition)) {
        status = chain::SolveStatus::out_of_domain;
        height = std::nan("");
      } else if (with_solve) {
        const auto trigger = mill::trigger<double>(solver, q, event, condition);
        status = trigger.status;
        height = status == chain::SolveStatus::ok ? trigger.height : std::nan("");
      }
      if (status != chain::SolveStatus::ok) call.status[i] = static_cast<std::uint8_t>(status);
      double* const* rows = call.measurands + r * mill::measurands;
      rows[mill::trigger_height_row][i] = height;
      finish(r, i, q, event, height, rows);
    }
}

void simulate(const BlockCall& call) {
  if (mill::joint(call.evaluation)) return mill::simulate_together(call);
  for_each_sample(
      call, true,
      [&](std::size_t r, std::size_t i, const double* q, const auto& event, double height, double* const* rows) {
        call.simulated[r][i] = mill::simulate(q, height, event);
        rows[mill::length_row][i] = q[mill::length];
        rows[mill::effective_row][i] = mill::effective_length(q, q[mill::length]);
      });
}

void evaluate(const BlockCall& call) {
  if (mill::joint(call.evaluation)) return mill::evaluate_together(call);
  for_each_sample(
      call, call.evaluation == mill::full,
      [&](std::size_t r, std::size_t i, const double* q, const auto& event, double height, double* const* rows) {
        const double length = mill::evaluate(load(call.indications[r], i), q, height, event);
        rows[mill::length_row][i] = length;
        rows[mill::effective_row][i] = mill::effective_length(q, length);
      });
}

} // namespace
} // namespace gumshoe::models

extern "C" {
extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_tool_length_);
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_tool_length_){&gumshoe::models::simulate,
                                                                    &gumshoe::models::evaluate};
}
