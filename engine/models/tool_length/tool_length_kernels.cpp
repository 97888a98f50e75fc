/// Block loops of the mill model, scalar inside: the solve branches too much for lanes.
#include "models/tool_length/procedures.h"

namespace gumshoe::models {
namespace {

double load(const Column& c, std::size_t i) { return c.data[c.stride * i]; }

/// `solve`: tool_length::simulate or tool_length::evaluate.
template <class Solve, class Finish>
void for_each_sample(const BlockCall& call, const Solve& solve, const Finish& finish) {
  double q[tool_length::count], condition[tool_length::conditions];
  std::vector<double> e(call.effect_quantities + 1);
  tool_length::TriggerSolver solver;
  PointCall<double> point;
  point.quantities = q;
  point.effects = e.data();
  point.active = call.active;
  point.conditions = condition;
  point.evaluation = call.evaluation;
  for (std::size_t i = 0; i < call.samples; ++i)
    for (std::size_t r = 0; r < call.readings; ++r) {
      for (std::size_t j = 0; j < tool_length::count; ++j) q[j] = load(call.quantities[r * tool_length::count + j], i);
      for (std::size_t j = 0; j < call.effect_quantities; ++j)
        e[j] = load(call.effects[r * call.effect_quantities + j], i);
      for (std::size_t j = 0; j < tool_length::conditions; ++j)
        condition[j] = load(call.conditions[r * tool_length::conditions + j], i);
      double z = call.indications && call.indications[r].data ? load(call.indications[r], i) : 0;
      point.indications = &z;
      const tool_length::Outcome<double> o = solve(solver, point);
      if (o.trigger.height.status != Status::ok)
        call.status[i] = code(o.trigger.height.status);
      double* const* rows = call.measurands + r * tool_length::measurands;
      rows[tool_length::trigger_height_row][i] = o.trigger.height.value;
      rows[tool_length::length_row][i] = o.length;
      rows[tool_length::effective_row][i] = o.effective_length;
      finish(r, i, o);
    }
}

void simulate(const BlockCall& call) {
  if (tool_length::joint(call.evaluation)) return tool_length::simulate_together(call);
  for_each_sample(call, tool_length::simulate<double>,
                  [&](std::size_t r, std::size_t i, const auto& o) { call.simulated[r][i] = o.spindle_z; });
}

void evaluate(const BlockCall& call) {
  if (tool_length::joint(call.evaluation)) return tool_length::evaluate_together(call);
  for_each_sample(call, tool_length::evaluate<double>, [](std::size_t, std::size_t, const auto&) {});
}

} // namespace
} // namespace gumshoe::models

extern "C" {
extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_tool_length_);
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_tool_length_){&gumshoe::models::simulate,
                                                                    &gumshoe::models::evaluate};
}
