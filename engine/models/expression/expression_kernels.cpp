/// Programs over blocks, compiled once per instruction set: chunk by chunk, so that registers stay in the first cache.
#include <algorithm>
#include <limits>

#include "formula/interpreter.h"
#include "models/expression/expression.h"

namespace gumshoe::models::expression {
namespace {

using formula::Program, formula::Source, formula::Step;

constexpr std::size_t width = Lanes::size, widest = 8;
constexpr std::size_t first_cache = 24 * 1024;     ///< bytes for registers, leaving room for columns
constexpr std::size_t most_kept = 4 * 1024 * 1024; ///< bytes of kept values: the third cache, shared by all threads

/// Where a step's values lie: stride 1 over the samples, or stride 0 and one value repeated for a group of lanes.
struct Place {
  const double* data = nullptr;
  double* own = nullptr; ///< the same, if the step writes there
  std::size_t stride = 0;
  bool follows_block = false; ///< data is a column of the whole block, not of a chunk
};

/// Inputs [step] and values [operation][sample] of a reading: those that a run keeps, or those that it goes on from.
struct Shelf {
  Column* inputs = nullptr;
  double* values = nullptr;
  const Column* kept_inputs = nullptr;
  const double* kept_values = nullptr;
};

struct Buffers {
  std::vector<Place> places;
  std::vector<std::uint8_t> changed; ///< steps whose values are others than those kept
  std::vector<double> registers, uniform;
  std::vector<std::uint32_t> varying; ///< steps to compute for every sample
  std::vector<double*> rows;          ///< of a simulation's outputs
};
Buffers& buffers() {
  thread_local Buffers b;
  return b;
}

template <class F>
void loop(const F& f, double* out, const double* a, std::size_t sa, const double* b, std::size_t sb, std::size_t n) {
  for (std::size_t i = 0; i < n; i += width)
    f(Lanes::load_unaligned(a + i * sa), Lanes::load_unaligned(b + i * sb)).store_unaligned(out + i);
}

void compute(const Step& s, double* out, const Place& a, const Place& b, std::size_t at, std::size_t n) {
  const double* pa = a.data + (a.follows_block ? at : 0);
  const double* pb = b.data + (b.follows_block ? at : 0);
  formula::with_function<Lanes>(s.operation, [&](const auto& f) { loop(f, out, pa, a.stride, pb, b.stride, n); });
}

Column column_of(const BlockCall& call, const ModelCard& card, std::size_t reading, const Step& s) {
  switch (s.source) {
  case Source::quantity:
    return call.quantities[reading * card.quantities.size() + s.a];
  case Source::condition:
    return call.conditions[reading * card.conditions.size() + s.a];
  default:
    return call.indications[reading * card.indications.size() + s.a];
  }
}

bool same(const Column& a, const Column& b) { return a.data == b.data && a.stride == b.stride; }

/// Places of all steps; what is the same for all samples is computed here, once.
void prepare(const Program& program, const BlockCall& call, const ModelCard& card, std::size_t reading,
             double* const* rows, std::size_t chunk, const Shelf& shelf, Buffers& b) {
  const std::size_t steps = program.steps.size();
  b.places.assign(steps, {});
  b.changed.assign(steps, 0);
  b.uniform.resize(steps * widest);
  b.registers.resize(program.registers * chunk);
  b.varying.clear();
  std::size_t operation = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    const Step& s = program.steps[i];
    Place& place = b.places[i];
    double* const repeated = &b.uniform[i * widest];
    if (s.source == Source::step) {
      const Place &x = b.places[s.a], &y = b.places[s.b];
      b.changed[i] = b.changed[s.a] | b.changed[s.b];
      const std::size_t row = operation++ * call.samples;
      if (x.stride == 0 && y.stride == 0) {
        compute(s, repeated, x, y, 0, width);
        place.data = repeated;
      } else if (shelf.kept_values && !b.changed[i]) {
        place = {shelf.kept_values + row, nullptr, 1, true};
      } else if (shelf.values) {
        double* const kept = shelf.values + row;
        place = {kept, kept, 1, true};
        b.varying.push_back(static_cast<std::uint32_t>(i));
      } else {
        place = {&b.registers[s.home * chunk], &b.registers[s.home * chunk], 1, false};
        b.varying.push_back(static_cast<std::uint32_t>(i));
      }
      continue;
    }
    const Column c = s.source == Source::constant ? Column{&s.value, 0} : column_of(call, card, reading, s);
    if (shelf.inputs) shelf.inputs[i] = c;
    if (shelf.kept_inputs && s.source != Source::constant)
      b.changed[i] = s.source == Source::indication || !same(c, shelf.kept_inputs[i]);
    if (c.stride != 0) {
      place = {c.data, nullptr, 1, true};
    } else {
      std::fill_n(repeated, widest, c.data[0]);
      place.data = repeated;
    }
  }
  // An output's values go straight to its row, where later steps read them.
  for (std::size_t o = 0; o < program.outputs.size(); ++o) {
    Place& place = b.places[program.outputs[o]];
    if (place.own && !place.follows_block) place = {rows[o], rows[o], 1, true};
  }
}

void finish_output(const Place& place, double* row, std::size_t at, std::size_t n, std::uint8_t* status) {
  if (place.own != row) {
    const double* from = place.data + (place.follows_block ? at : 0);
    for (std::size_t i = 0; i < n; ++i) row[at + i] = from[place.stride ? i : 0];
  }
  const Lanes largest(std::numeric_limits<double>::max());
  Lanes bad(0.0);
  for (std::size_t i = 0; i < n; i += width)
    bad = xsimd::select(xsimd::abs(Lanes::load_unaligned(row + at + i)) <= largest, bad, Lanes(1.0));
  if (!xsimd::any(bad > Lanes(0.5))) return;
  for (std::size_t i = 0; i < n; ++i)
    if (!(std::fabs(row[at + i]) <= std::numeric_limits<double>::max())) status[at + i] = code(Status::not_finite);
}

void run(const Program& program, const BlockCall& call, const ModelCard& card, std::size_t reading, double* const* rows,
         const Shelf& shelf = {}) {
  Buffers& b = buffers();
  std::size_t chunk = 256;
  while (chunk > 32 && chunk * sizeof(double) * program.registers > first_cache) chunk /= 2;
  prepare(program, call, card, reading, rows, chunk, shelf, b);
  for (std::size_t at = 0; at < call.samples; at += chunk) {
    const std::size_t n = std::min(chunk, call.samples - at);
    for (const std::uint32_t i : b.varying) {
      const Step& s = program.steps[i];
      const Place& place = b.places[i];
      compute(s, place.own + (place.follows_block ? at : 0), b.places[s.a], b.places[s.b], at, n);
    }
    for (std::size_t o = 0; o < program.outputs.size(); ++o)
      finish_output(b.places[program.outputs[o]], rows[o], at, n, call.status);
  }
}

/// `shelf(reading)`: what is kept of it.
template <class ShelfOf> void evaluate_readings(const BlockCall& call, const ShelfOf& shelf) {
  const auto& expression = *static_cast<const Expression*>(call.context);
  const ModelCard& card = *expression.model.card;
  for (std::size_t r = 0; r < call.readings; ++r)
    run(expression.formulas.evaluate, call, card, r, call.measurands + r * card.measurands.size(), shelf(r));
}

void evaluate(const BlockCall& call) {
  evaluate_readings(call, [](std::size_t) { return Shelf{}; });
}

const std::vector<Step>& steps_of(const BlockCall& call) {
  return static_cast<const Expression*>(call.context)->formulas.evaluate.steps;
}
/// Values that are kept of a reading.
std::size_t values_of(const BlockCall& call) {
  const auto operations = std::ranges::count(steps_of(call), Source::step, &Step::source);
  return static_cast<std::size_t>(operations) * call.samples;
}

void keep(const BlockCall& call, Kept& kept) {
  const std::size_t steps = steps_of(call).size(), values = values_of(call);
  kept.samples = call.readings * values * sizeof(double) > most_kept ? 0 : call.samples;
  if (kept.samples == 0) return evaluate(call);
  kept.readings = call.readings;
  kept.inputs.resize(call.readings * steps);
  kept.values.resize(call.readings * values);
  evaluate_readings(call, [&](std::size_t r) {
    return Shelf{&kept.inputs[r * steps], kept.values.data() + r * values, nullptr, nullptr};
  });
}

void go_on(const BlockCall& call, const Kept& kept) {
  if (kept.samples != call.samples || kept.readings != call.readings) return evaluate(call);
  const std::size_t steps = steps_of(call).size(), values = values_of(call);
  evaluate_readings(call, [&](std::size_t r) {
    return Shelf{nullptr, nullptr, &kept.inputs[r * steps], kept.values.data() + r * values};
  });
}

void simulate(const BlockCall& call) {
  const auto& expression = *static_cast<const Expression*>(call.context);
  const ModelCard& card = *expression.model.card;
  const std::size_t k = card.indications.size(), m = card.measurands.size();
  std::vector<double*>& rows = buffers().rows;
  rows.resize(k + m);
  for (std::size_t r = 0; r < call.readings; ++r) {
    std::copy_n(call.simulated + r * k, k, rows.begin());
    std::copy_n(call.measurands + r * m, m, rows.begin() + static_cast<std::ptrdiff_t>(k));
    run(expression.formulas.simulate, call, card, r, rows.data());
  }
}

} // namespace
} // namespace gumshoe::models::expression

extern "C" {
extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_expression_),
    GUMSHOE_KERNEL(gumshoe_expression_evaluating_);
extern const gumshoe::models::KeepingKernels GUMSHOE_KERNEL(gumshoe_expression_keeping_);
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_expression_){&gumshoe::models::expression::simulate,
                                                                   &gumshoe::models::expression::evaluate};
/// Kernels of a statement without [model.indications], which cannot simulate.
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_expression_evaluating_){nullptr,
                                                                              &gumshoe::models::expression::evaluate};
const gumshoe::models::KeepingKernels GUMSHOE_KERNEL(gumshoe_expression_keeping_){&gumshoe::models::expression::keep,
                                                                                  &gumshoe::models::expression::go_on};
}
