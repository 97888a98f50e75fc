#include "scenario/correlations.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "quantities/cells.h"
#include "scenario/option.h"
#include "scenario/simultaneous.h"

namespace gumshoe::scenario {
namespace {

using quantities::Correlation;

Options<Correlation> correlation_options() {
  using enum Correlation::Kind;
  const Shape coefficient = shape::interval(-1, 1, false);
  return {
      option::texts("quantities", &Correlation::quantities, R"("minItems": 2)",
                    "at least two quantities: \"name\", \"name.component\" or \"name[label value]\"")
          .needed(),
      option::word("kind", &Correlation::kind, {{"copula", copula}, {"pearson", pearson}, {"spearman", spearman}, {"multivariate_t", multivariate_t}, {"observations", multivariate_t}},
                   "kind of the coefficient; multivariate_t: estimates of one fit, with one standard deviation and its "
                   "degrees of freedom; observations: computed from the simultaneous observations of the quantities; there "
                   "is no default")
          .needed("use copula, pearson, spearman, multivariate_t or observations"),
      option::by_hand<Correlation>("coefficient", coefficient, "correlation coefficient of the quantities; of several, of any two"),
      option::by_hand<Correlation>("matrix", shape::list(shape::list(coefficient)),
                                   "a row and a column per quantity; symmetric, 1 on the diagonal"),
      option::by_hand<Correlation>("source", shape::reference("source"), ""),
  };
}

void read_matrix(Table& table, std::size_t n, std::vector<double>& matrix) {
  const auto* rows = table.array("matrix");
  if (!rows) return;
  for (const Node& row : *rows) {
    if (row.kind != Node::Kind::array || row.items.size() != n || rows->size() != n)
      return table.refuse_key("matrix", fmt::format("must have {} rows of {} numbers", n, n));
    for (const Node& cell : row.items)
      matrix.push_back(read_number(cell, table.path("matrix"), table.problems()).value_or(0));
  }
  for (std::size_t i = 0; i < n * n && matrix.size() == n * n; ++i) {
    const double here = matrix[i], mirrored = matrix[(i % n) * n + i / n];
    const bool diagonal = i / n == i % n;
    if (here == mirrored && std::abs(here) <= 1 && (!diagonal || here == 1)) continue;
    return table.refuse_key("matrix", fmt::format("row {}, column {} is {}", i / n + 1, i % n + 1, here),
                            "correlations are symmetric, between -1 and 1, and 1 on the diagonal");
  }
}

std::optional<double> read_coefficient(Table& table) {
  const Node* const node = table.find("coefficient");
  if (!node || node->kind != Node::Kind::array) return table.number("coefficient");
  table.refuse_key("coefficient", "one number is expected, not an array", "several coefficients are a matrix",
                   "matrix = [[1, 0.5], [0.5, 1]]");
  return std::nullopt;
}

/// Leaves out the members of labels that no reading has: of the others it says what it said.
void leave_out(const std::set<std::string>& unused, const Table& table, Context& context, Correlation& c) {
  const std::size_t n = c.quantities.size();
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < n; ++i)
    if (!unused.contains(c.quantities[i])) kept.push_back(i);
  if (kept.size() == n) return;
  const auto first = std::ranges::find_if(c.quantities, [&](const std::string& name) { return unused.contains(name); });
  context.notes.push_back(fmt::format("{}: {} of {} are left out, because no reading has them, such as '{}'",
                                      table.path("quantities"), n - kept.size(), n, *first));
  Correlation out = c;
  out.quantities.clear(), out.matrix.clear();
  for (const std::size_t i : kept) {
    out.quantities.push_back(c.quantities[i]);
    for (const std::size_t j : kept)
      if (c.matrix.size() == n * n) out.matrix.push_back(c.matrix[i * n + j]);
  }
  c = std::move(out);
}

Correlation read_correlation(Table table, const std::vector<NamedComponent>& named, const std::set<std::string>& unused,
                             Context& context) {
  Correlation out;
  read_options(table, correlation_options(), out);
  const std::vector<std::string> names = names_of(named);
  std::vector<std::string> seen;
  const std::size_t problems = table.problems().size();
  for (const std::string& name : out.quantities) {
    if (std::ranges::find(names, name) == names.end() && !unused.contains(name))
      table.refuse_key("quantities", fmt::format("'{}' is not a quantity here", name), "", did_you_mean(name, names));
    if (std::ranges::find(seen, name) != seen.end())
      table.refuse_key("quantities", fmt::format("'{}' is named twice", name));
    seen.push_back(name);
  }
  const std::size_t n = out.quantities.size();
  const bool known = table.problems().size() == problems;
  table.rendered("source");
  const auto coefficient = read_coefficient(table);
  if (n < 2 && table.has("quantities")) table.refuse("at least two quantities are needed");
  const Node* kind = table.find("kind");
  if (kind && kind->text == "observations") {
    for (const char* key : {"coefficient", "matrix"})
      if (table.has(key)) table.refuse_key(key, "the observations give it", "kind = \"observations\"", "leave it out");
    std::vector<NamedComponent> members;
    for (const std::string& name : out.quantities)
      if (known && !unused.contains(name)) members.push_back(*std::ranges::find(named, name, &NamedComponent::name));
    std::erase_if(out.quantities, [&](const std::string& name) { return unused.contains(name); });
    out.matrix = evaluate_together(table, members);
    table.refuse_unknown();
    return out;
  }
  if (table.has("coefficient") == table.has("matrix"))
    table.refuse("either a coefficient or a matrix is needed", "", "write coefficient = 0.5");
  else if (coefficient && std::abs(*coefficient) > 1)
    table.refuse_key("coefficient", fmt::format("{} must lie between -1 and 1", *coefficient));
  else if (coefficient && known) // of names that mean nothing there may be any number
    for (std::size_t i = 0; i < n * n; ++i) out.matrix.push_back(i % n == i / n ? 1 : *coefficient);
  read_matrix(table, n, out.matrix);
  table.refuse_unknown();
  if (known) leave_out(unused, table, context, out);
  return out;
}

/// The names of an entry as draws have them, in the order of the components, and without one.
std::vector<NamedComponent> cell_names(const std::string& quantity, quantities::Entry& entry) {
  std::vector<NamedComponent> out;
  if (entry.labels.empty()) return out;
  auto labels = entry.labels;
  std::sort(labels.begin(), labels.end()); // as draws are named
  const std::string cell = quantity + '[' + quantities::text_of(labels) + ']';
  out.push_back({cell, entry.components.size() == 1 ? &entry.components[0] : nullptr});
  for (auto& c : entry.components)
    if (entry.components.size() > 1) out.push_back({cell + ": " + c.name, &c});
  return out;
}

} // namespace

Shape correlation_shape() {
  return table_shape(correlation_options(),
                     R"("oneOf": [{"required": ["coefficient"]}, {"required": ["matrix"]}, )"
                     R"({"properties": {"kind": {"const": "observations"}}, "not": {"anyOf": [{"required": ["coefficient"]}, )"
                     R"({"required": ["matrix"]}]}}])");
}

std::vector<Correlation> read_correlations(Table& top, std::vector<quantities::InputQuantity>& quantities,
                                           Context& context) {
  std::vector<NamedComponent> names;
  for (auto& q : quantities) {
    const bool single = q.entries.size() == 1;
    const auto only = [&](quantities::Entry& e) { return e.components.size() == 1 ? &e.components[0] : nullptr; };
    names.push_back({q.name, single ? only(q.entries[0]) : nullptr});
    for (auto& entry : q.entries) {
      std::ranges::copy(cell_names(q.name, entry), std::back_inserter(names));
      for (auto& c : entry.components) names.push_back({q.name + '.' + c.name, single ? &c : nullptr});
    }
  }
  std::set<std::string> unused;
  for (auto& q : context.unused)
    for (const auto& one : cell_names(q.name, q.entries.front())) unused.insert(one.name);
  std::vector<Correlation> out;
  for (const Table& row : top.tables("correlations")) {
    Correlation one = read_correlation(row, names, unused, context);
    if (one.quantities.size() > 1 || unused.empty()) out.push_back(std::move(one));
  }
  return out;
}

} // namespace gumshoe::scenario
