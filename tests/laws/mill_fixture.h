#pragma once
/// One readout of a mill, its effects set by name.
#include <random>
#include <string>
#include <vector>

#include "laws/mill_rows.h"
#include "models/adapter.h"

namespace gumshoe::tests {

struct Draw {
  std::mt19937_64 engine{20261121};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

struct Mill {
  static constexpr double mm = 1e-3, um = 1e-6, ms = 1e-3, deg = std::numbers::pi / 180, rpm = std::numbers::pi / 30;
  std::vector<double> q, effects;
  std::vector<double> condition{1000 * rpm, 30 * mm / 60, 0.7, 0.5 * mm, 600, -1};
  std::vector<effects::Active> active;
  int evaluation = mill::full;

  Mill() {
    for (const auto& card : models::find("tool_length")->card->quantities) q.push_back(card.default_value);
    q[Row::laser_z] = -0.5;
  }
  /// A mill as shops have it, 1 to 6 inserts, worn or not.
  static Mill random(Draw& draw) {
    Mill m;
    m.q[Row::tool_radius] = draw(6, 14) * mm;
    m.q[Row::insert_radius] = draw(2, 6) * mm;
    m.q[Row::insert_thickness] = draw(1, 5) * mm;
    m.q[Row::clearance_angle] = draw(5, 15) * deg;
    m.q[Row::insert_radial_angle] = draw(-15, 15) * deg;
    m.q[Row::insert_axial_angle] = draw(-10, 5) * deg;
    m.q[Row::inserts] = std::floor(draw(1, 7));
    for (int k = 0; k < 6; ++k) m.q[Row::wear_1 + static_cast<std::size_t>(k)] = draw(0, 0.01) * mm;
    m.q[Row::holder_angle] = draw(-3, 3);
    m.q[Row::tool_length] = draw(0.1, 0.25);
    m.q[Row::offset] = m.q[Row::tool_radius] - draw(0.5, 1.5) * m.q[Row::insert_radius];
    m.q[Row::beam_yaw] = draw(-1, 1) * deg;
    m.q[Row::beam_pitch] = draw(-1, 1) * deg;
    m.condition = {draw(300, 3000) * rpm, draw(3, 100) * mm / 60, draw(0, 6), draw(0.1, 0.6) * mm, draw(0, 3600), -1};
    return m;
  }
  /// The mill with an effect besides; values in SI, those left out at their null.
  Mill with(const std::string& name, std::vector<double> values) const {
    Mill m = *this;
    std::size_t e = 0;
    while (effects::cards()[e]->name != name) ++e;
    m.active.push_back({e, m.effects.size()});
    for (const QuantityCard& card : effects::cards()[e]->quantities) {
      const std::size_t i = m.effects.size() - m.active.back().first;
      m.effects.push_back(i < values.size() ? values[i] : card.default_value);
    }
    return m;
  }
  Mill where(std::size_t quantity, double value) const {
    Mill m = *this;
    m.q[quantity] = value;
    return m;
  }
  Mill under(std::size_t which, double value) const {
    Mill m = *this;
    m.condition[which] = value;
    return m;
  }

  template <class T> models::PointCall<T> call(const std::vector<T>& of_model, const std::vector<T>& values) const {
    models::PointCall<T> c;
    c.quantities = of_model.data();
    c.effects = values.data();
    c.active = active;
    c.conditions = condition.data();
    c.evaluation = evaluation;
    return c;
  }
  mill::At<double> at() const { return models::reading_of<mill::ToolLength>(call(q, effects), false); }
  mill::Readout<double> simulated() const {
    mill::TriggerSolver solver;
    return possible() ? mill::simulate(solver, at()) : refused();
  }
  mill::Readout<double> evaluated(double spindle_z) const {
    mill::TriggerSolver solver;
    return possible() ? mill::evaluate(solver, at(), spindle_z) : refused();
  }
  double reading() const { return simulated().spindle_z; }
  double height() const { return simulated().trigger.height.value; }
  bool triggers() const { return simulated().trigger.height.status == Status::ok; }
  mill::Event<double> event() const { return mill::probing_event(at()); }

private:
  bool possible() const {
    models::Outcome<double> outcome;
    models::check_all<mill::ToolLength>(at(), outcome);
    return !outcome.failed;
  }
  static mill::Readout<double> refused() {
    mill::Readout<double> o;
    o.trigger.height = {std::nan(""), Status::out_of_domain};
    o.spindle_z = o.length = o.effective_length = std::nan("");
    return o;
  }
};

} // namespace gumshoe::tests
