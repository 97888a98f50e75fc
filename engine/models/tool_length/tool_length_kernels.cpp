/// Block loops of the mill model, scalar inside: the solve branches too much for lanes.
#include "models/tool_length/procedures.h"

namespace gumshoe::models {
namespace {

double load(const Column& c, std::size_t i) { return c.data[c.stride * i]; }

/// `solve`: mill::simulate or mill::evaluate.
template <class Solve, class Finish>
void for_each_sample(const BlockCall& call, const Solve& solve, const Finish& finish) {
  double q[mill::count], condition[mill::conditions];
  std::vector<double> e(call.effect_quantities + 1);
  chain::TriggerSolver solver;
  PointCall<double> point;
  point.quantities = q;
  point.effects = e.data();
  point.active = call.active;
  point.conditions = condition;
  point.evaluation = call.evaluation;
  for (std::size_t i = 0; i < call.samples; ++i)
    for (std::size_t r = 0; r < call.readings; ++r) {
      for (std::size_t j = 0; j < mill::count; ++j) q[j] = load(call.quantities[r * mill::count + j], i);
      for (std::size_t j = 0; j < call.effect_quantities; ++j)
        e[j] = load(call.effects[r * call.effect_quantities + j], i);
      for (std::size_t j = 0; j < mill::conditions; ++j)
        condition[j] = load(call.conditions[r * mill::conditions + j], i);
      double z = call.indications && call.indications[r].data ? load(call.indications[r], i) : 0;
      point.indications = &z;
      const mill::Outcome<double> o = solve(solver, point);
      if (o.trigger.height.status != Status::ok)
        call.status[i] = code(o.trigger.height.status);
      double* const* rows = call.measurands + r * mill::measurands;
      rows[mill::trigger_height_row][i] = o.trigger.height.value;
      rows[mill::length_row][i] = o.length;
      rows[mill::effective_row][i] = o.effective_length;
      finish(r, i, o);
    }
}

void simulate(const BlockCall& call) {
  if (mill::joint(call.evaluation)) return mill::simulate_together(call);
  for_each_sample(call, mill::simulate<double>,
                  [&](std::size_t r, std::size_t i, const auto& o) { call.simulated[r][i] = o.spindle_z; });
}

void evaluate(const BlockCall& call) {
  if (mill::joint(call.evaluation)) return mill::evaluate_together(call);
  for_each_sample(call, mill::evaluate<double>, [](std::size_t, std::size_t, const auto&) {});
}

} // namespace
} // namespace gumshoe::models

extern "C" {
extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_tool_length_);
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_tool_length_){&gumshoe::models::simulate,
                                                                    &gumshoe::models::evaluate};
}
