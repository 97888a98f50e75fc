#include "formula/resolve.h"

#include <fmt/format.h>

namespace gumshoe::formula {
namespace {
constexpr std::size_t most_problems = 20; ///< of the names of one formula
}

Names::Names(const Statement& s, const std::vector<Formula>& formulas, std::vector<Problem>& problems)
    : formulas_(formulas) {
  std::map<std::string, std::string> taken;
  const auto columns = [&](const std::vector<Symbol>& symbols, Source source, const std::string& what) {
    for (std::size_t i = 0; i < symbols.size(); ++i) {
      const auto [it, fresh] = taken.try_emplace(symbols[i].name, what);
      if (!fresh)
        problems.push_back({{},
                            fmt::format("'{}' is {} and {}", symbols[i].name, it->second, what),
                            "names must be unique",
                            "rename one of them"});
      meanings_[symbols[i].name] = {source, i, &symbols[i]};
    }
  };
  columns(s.quantities, Source::quantity, "a quantity");
  columns(s.conditions, Source::condition, "a condition");
  columns(s.indications, Source::indication, "an indication");
  const std::size_t measurands = s.intermediates.size(), simulated = measurands + s.measurands.size();
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    const std::string name = formulas[i].short_name();
    if (!is_name(name))
      problems.push_back({formulas[i].where,
                          fmt::format("{}: '{}' cannot be the name of a formula", formulas[i].name, name),
                          "use letters, digits and _, with no digit first", ""});
    if (const auto reserved = reserved_as(name); !reserved.empty())
      problems.push_back({formulas[i].where,
                          fmt::format("{}: '{}' cannot be the name of a formula", formulas[i].name, name),
                          fmt::format("it is {}", reserved), "rename it"});
    if (i >= simulated) {
      simulated_[name] = {Source::step, i, nullptr};
      continue;
    }
    // The measurand of a virtual experiment may be a quantity of the same name: the true value.
    const bool truth = i >= measurands && meanings_.contains(name) && meanings_[name].source == Source::quantity;
    if (truth) continue;
    const std::string what = i < measurands ? "an intermediate" : "a measurand";
    const auto [it, fresh] = taken.try_emplace(name, what);
    if (!fresh)
      problems.push_back({formulas[i].where, fmt::format("{}: '{}' is already {}", formulas[i].name, name, it->second),
                          "names must be unique", "rename one of them"});
    else
      meanings_[name] = {Source::step, i, nullptr};
  }
}

const Meaning* Names::find(const std::string& name, bool simulating) const {
  if (simulating)
    if (const auto it = simulated_.find(name); it != simulated_.end()) return &it->second;
  const auto it = meanings_.find(name);
  return it == meanings_.end() ? nullptr : &it->second;
}

void Names::check(const Formula& f, std::vector<Problem>& problems) const {
  const std::size_t before = problems.size();
  for (const Node& n : f.nodes) {
    if (n.operation != Operation::name) continue;
    if (problems.size() - before >= most_problems) return;
    const bool named = find(n.name, false) != nullptr;
    if (named && find_constant(n.name))
      problems.push_back(f.problem(n.at, fmt::format("'{}' has two meanings here", n.name),
                                   "it is a constant of formulas", "rename the other one"));
    if (named || find_constant(n.name)) continue;
    std::vector<std::string> candidates;
    for (const auto& [name, meaning] : meanings_) candidates.push_back(name);
    const std::string meant = nearest(n.name, candidates);
    const std::string remedy = !meant.empty()          ? fmt::format("did you mean '{}'?", meant)
                               : find_function(n.name) ? fmt::format("write {}(...)", n.name)
                               : candidates.size() <= 8 && !candidates.empty()
                                   ? fmt::format("use one of {}", fmt::join(candidates, ", "))
                                   : fmt::format("[quantities.{}]", n.name);
    problems.push_back(f.problem(n.at,
                                 fmt::format("'{}' is not a quantity, condition, indication or intermediate", n.name),
                                 find_function(n.name) ? "it is a function" : "", remedy));
  }
}

std::vector<std::size_t> Names::order(const std::vector<std::size_t>& roots, bool simulating,
                                      std::vector<Problem>& problems) const {
  enum class State : char { fresh, open, done };
  struct Visit {
    std::size_t formula, node;
  };
  std::vector<State> state(formulas_.size(), State::fresh);
  std::vector<std::size_t> out;
  std::vector<Visit> stack; // a chain of intermediates may be longer than the program's own stack
  for (const std::size_t root : roots) {
    if (state[root] == State::fresh) stack.push_back({root, 0}), state[root] = State::open;
    while (!stack.empty()) {
      Visit& at = stack.back();
      const Formula& f = formulas_[at.formula];
      if (at.node == f.nodes.size()) {
        state[at.formula] = State::done;
        out.push_back(at.formula);
        stack.pop_back();
        continue;
      }
      const Node& n = f.nodes[at.node++];
      const Meaning* m = n.operation == Operation::name ? find(n.name, simulating) : nullptr;
      if (!m || m->source != Source::step || state[m->index] == State::done) continue;
      if (state[m->index] == State::open) {
        std::string circle;
        std::size_t from = stack.size();
        while (stack[--from].formula != m->index) {
        }
        for (; from < stack.size(); ++from) {
          circle += formulas_[stack[from].formula].short_name() + " -> ";
        }
        problems.push_back(f.problem(n.at, fmt::format("'{}' depends on itself", n.name), circle + n.name,
                                     "formulas must not form a circle"));
        return {};
      }
      state[m->index] = State::open;
      stack.push_back({m->index, 0});
    }
  }
  return out;
}

} // namespace gumshoe::formula
