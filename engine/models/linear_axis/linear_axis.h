#pragma once
/// Positioning of a linear axis against a reference: the model. Its physics stands in measurement.h, its joint
/// evaluations in procedures.h.
#include <tuple>

#include "models/linear_axis/procedures.h"
#include "models/model.h"

namespace gumshoe::models::linear_axis {

struct LinearAxis {
  using Rows = linear_axis::Rows;
  static constexpr ModelCard card{
      .name = "linear_axis",
      .title = "Positioning of a linear axis against a reference",
      .summary = "A laser interferometer or another reference measures by how much a linear axis misses its targets, "
                 "from both sides and in several runs; accuracy, repeatability and reversal follow.",
      .source = "ISO 230-2:2014; ISO/TR 230-9 for the kinds of contributions",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = indication_cards,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = stages};
  using Joint = std::tuple<Figures, SystematicFigures>;

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    const auto& d = at.c.direction;
    outcome.refuse(!(d == T(1.0)) && !(d == T(-1.0)) && !(d == T(0.0)), "direction must be 1, -1 or 0");
    const auto& reads = at.c.reads_position;
    outcome.refuse(!(reads == T(0.0)) && !(reads == T(1.0)), "reads_position must be 0 or 1");
    outcome.refuse(at.c.pitch < T(0.0), "pitch is negative");
    outcome.refuse(!(at.c.temperature > T(0.0)), "temperature is below absolute zero");
  }
  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, Outcome<T>&) {
    return linear_axis::simulate(at);
  }
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, const Rows::Indications<T>& read, Outcome<T>&) {
    return linear_axis::evaluate(at, read);
  }
};

} // namespace gumshoe::models::linear_axis
