#include "formula/result_units.h"

#include <fmt/format.h>

#include "base/units.h"

namespace gumshoe::formula {
namespace {

class Settler {
public:
  Settler(Compiled& compiled, std::vector<Problem>& problems) : c_(compiled), problems_(problems) {}

  void settle(std::size_t i, const Kind& kind) {
    const Formula& f = c_.formulas[i];
    const std::string name = f.short_name();
    const Dimension& is = kind.dimension;
    if (i >= c_.first_simulated()) return simulated_fits(f, name, kind);
    Symbol s{name, kind.unit, "", f.text};
    if (i >= c_.first_measurand()) {
      const Stated& stated = c_.statement.measurands[i - c_.first_measurand()];
      true_value_fits(f, name, is);
      if (!stated.unit.empty()) {
        s.unit = stated.unit;
        if (!fits(stated, is)) return;
      } else if (!is.has_unit()) {
        problems_.push_back(
            f.problem(0, fmt::format("the measurand is {}", is.words()), "no unit has fractional exponents"));
        return;
      }
    }
    if (s.unit.empty()) s.unit = is.has_unit() ? is.si_unit() : "1"; // of an intermediate: its SI value
    s.si_unit = units::si_unit_of(s.unit);
    c_.explained.push_back(s);
  }

private:
  void true_value_fits(const Formula& f, const std::string& name, const Dimension& is) {
    for (const Symbol& q : c_.statement.quantities)
      if (q.name == name && !Dimension::of(q.unit).like(is))
        problems_.push_back(f.problem(
            0, fmt::format("the formula gives {}", is.words()),
            fmt::format("the quantity of this name, the true value, is {}", Dimension::of(q.unit).words())));
  }

  bool fits(const Stated& stated, const Dimension& is) {
    try {
      const Dimension wanted = Dimension::of(stated.unit);
      // rad/s is no frequency: a turn is 2 pi.
      if (wanted.like(is) && (wanted.has_angle() || !is.has_angle() || is.is_angle())) return true;
      problems_.push_back({stated.unit_place,
                           fmt::format("{}.unit: '{}' is not {}", stated.formula.name, stated.unit, is.words()),
                           "the formula gives this", is.has_unit() ? fmt::format("use {}", is.si_unit()) : ""});
    } catch (const InputError& error) {
      for (Problem p : error.problems()) {
        p.where = stated.unit_place;
        p.what = fmt::format("{}.unit: {}", stated.formula.name, p.what);
        problems_.push_back(std::move(p));
      }
    }
    return false;
  }

  /// An indication's formula must give what its readings are.
  void simulated_fits(const Formula& f, const std::string& name, const Kind& kind) {
    const Dimension& is = kind.dimension;
    for (Symbol& s : c_.statement.indications) {
      if (s.name != name) continue;
      if (s.unit.empty()) { // no readings that would tell
        s.unit = !kind.unit.empty() ? kind.unit : is.has_unit() ? is.si_unit() : "1";
        s.si_unit = units::si_unit_of(s.unit);
        continue;
      }
      const Dimension wanted = Dimension::of(s.unit);
      if (!wanted.like(is))
        problems_.push_back(f.problem(0, fmt::format("the formula gives {}", is.words()),
                                      fmt::format("the readings are {}", wanted.words())));
    }
  }

  Compiled& c_;
  std::vector<Problem>& problems_;
};

} // namespace

void settle_units(Compiled& compiled, const std::vector<Kind>& kinds, std::vector<Problem>& problems) {
  Settler settler(compiled, problems);
  for (std::size_t i = 0; i < compiled.formulas.size(); ++i) settler.settle(i, kinds[i]);
}

} // namespace gumshoe::formula
