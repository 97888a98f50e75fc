#include "formula/assemble.h"

namespace gumshoe::formula {
namespace {

class Assembler {
public:
  Assembler(const Compiled& compiled, const Names& names, std::vector<Problem>& problems)
      : c_(compiled), names_(names), problems_(problems) {}

  /// A program of the formulas `roots`.
  Program program(const std::vector<std::size_t>& roots, bool simulating) {
    Builder builder;
    std::map<std::size_t, Builder::Value> results;
    std::vector<std::size_t> wanted;
    for (const std::size_t r : roots) {
      const Meaning* true_value = simulating && is_measurand(r) ? truth(r) : nullptr;
      if (true_value)
        results[r] = builder.input(true_value->source, true_value->index);
      else
        wanted.push_back(r);
    }
    for (const std::size_t formula : names_.order(wanted, simulating, problems_))
      results[formula] = append(builder, formula, simulating, results);
    std::vector<Builder::Value> outputs;
    for (const std::size_t r : roots)
      if (results.contains(r)) outputs.push_back(results[r]);
    return builder.finish(outputs);
  }

private:
  Builder::Value append(Builder& builder, std::size_t formula, bool simulating,
                        const std::map<std::size_t, Builder::Value>& results) const {
    const Formula& f = c_.formulas[formula];
    std::vector<Builder::Value> values;
    for (std::size_t i = 0; i < f.nodes.size(); ++i) {
      const Node& n = f.nodes[i];
      if (n.operation == Operation::number) {
        values.push_back(builder.constant(n.value));
      } else if (n.operation == Operation::name) {
        const Meaning* m = names_.find(n.name, simulating);
        values.push_back(!m                          ? builder.constant(*find_constant(n.name))
                         : m->source == Source::step ? results.at(m->index)
                                                     : builder.input(m->source, m->index));
      } else {
        values.push_back(builder.operation(n.operation, values[n.a], values[n.b], {formula, i}));
      }
    }
    return values.back();
  }

  bool is_measurand(std::size_t formula) const {
    return formula >= c_.first_measurand() && formula < c_.first_simulated();
  }

  /// The quantity of a measurand's name: its true value, from which indications are simulated.
  const Meaning* truth(std::size_t formula) const {
    const Meaning* m = names_.find(c_.formulas[formula].short_name(), false);
    return m && m->source == Source::quantity ? m : nullptr;
  }

  const Compiled& c_;
  const Names& names_;
  std::vector<Problem>& problems_;
};

} // namespace

std::vector<std::size_t> indices(std::size_t first, std::size_t last) {
  std::vector<std::size_t> out;
  for (std::size_t i = first; i < last; ++i) out.push_back(i);
  return out;
}

void assemble(Compiled& c, const Names& names, std::vector<Problem>& problems) {
  Assembler assembler(c, names, problems);
  const auto measurands = indices(c.first_measurand(), c.first_simulated());
  c.evaluate = assembler.program(measurands, false);
  c.explain = assembler.program(indices(0, c.first_simulated()), false);
  std::vector<std::size_t> roots;
  for (const Symbol& s : c.statement.indications)
    if (const Meaning* m = names.find(s.name, true); m && m->source == Source::step) roots.push_back(m->index);
  if (roots.empty() || roots.size() != c.statement.indications.size()) return;
  roots.insert(roots.end(), measurands.begin(), measurands.end());
  c.simulate = assembler.program(roots, true);
}

} // namespace gumshoe::formula
