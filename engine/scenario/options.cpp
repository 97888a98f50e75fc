#include "scenario/options.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "quantities/cells.h"
#include "scenario/studies.h"

namespace gumshoe::scenario {
namespace {

constexpr std::int64_t most = std::int64_t{1} << 40;

void read_share(Table& table, const char* key, double& value, bool ends_allowed) {
  const auto share = table.number(key);
  if (!share) return;
  const bool inside = ends_allowed ? *share >= 0 && *share <= 1 : *share > 0 && *share < 1;
  if (inside)
    value = *share;
  else
    table.problems().add(*table.find(key), fmt::format("{}: {} must lie between 0 and 1", table.path(key), *share));
}

void check_label(Table& table, const char* key, const std::string& name, Context& context) {
  if (!context.readings_known || context.label_values.contains(name)) return;
  context.problems.add(*table.find(key), fmt::format("{}: no reading has the label '{}'", table.path(key), name), "",
                       did_you_mean(name, context.label_names()));
}

Comparison read_comparison(Table table, const ModelCard& model, Context& context) {
  Comparison out;
  if (const auto* m = read_measurand(table, model)) out.measurand = m->name;
  table.require("between", "between = \"rod\"");
  out.between = table.text("between").value_or("");
  out.within = table.text("within").value_or("");
  if (!out.between.empty()) check_label(table, "between", out.between, context);
  if (!out.within.empty()) check_label(table, "within", out.within, context);
  if (!out.between.empty() && out.between == out.within)
    table.add(table.path() + ": between and within are the same label");
  table.refuse_unknown();
  return out;
}

Printed read_printed(Table table, const ModelCard& model, Context& context) {
  Printed out;
  const auto* measurand = read_measurand(table, model);
  if (measurand) out.measurand = measurand->name;
  const Node* value = table.require("value");
  if (value && measurand) out.value = table.measure("value", {std::string(measurand->si_unit)}).value_or(0);
  out.labels = read_labels(table, context);
  out.source = table.rendered("source");
  table.refuse_unknown();
  return out;
}

} // namespace

RunOptions read_run(Table table) {
  RunOptions out;
  if (const auto n = table.integer("samples", 2, most)) out.samples = static_cast<std::uint64_t>(*n);
  if (const auto n = table.integer("seed", 0, most)) out.seed = static_cast<std::uint64_t>(*n);
  if (const auto d = table.choice("design", {"monte_carlo", "latin_hypercube", "sobol"}))
    out.design = static_cast<Design>(*d);
  read_share(table, "max_failed_share", out.max_failed_share, true);
  if (auto adaptive = table.table("adaptive")) out.adaptive = read_adaptive(*adaptive);
  if (out.adaptive.rule != StoppingRule::fixed) {
    if (table.has("samples"))
      table.problems().add(*table.find("samples"), table.path("samples") + ": samples beside adaptive",
                           "an adaptive run finds their number", "leave one out");
    if (out.design != Design::monte_carlo)
      table.problems().add(*table.find("design"), table.path("design") + ": adaptive runs need independent samples", "",
                           "design = \"monte_carlo\"");
  }
  out.store_samples = table.boolean("store_samples").value_or(out.store_samples);
  table.refuse_unknown();
  return out;
}

AnalysisOptions read_analysis(Table table, const ModelCard& model,
                              const std::vector<quantities::InputQuantity>& quantities, Context& context) {
  const StudyScope scope{model, quantities};
  AnalysisOptions out;
  read_share(table, "coverage_probability", out.coverage_probability, false);
  if (const auto n = table.integer("validation_digits", 1, 6)) out.validation_digits = static_cast<int>(*n);
  if (auto sensitivity = table.table("sensitivity")) out.sensitivity = read_sensitivity(*sensitivity);
  out.joint = read_joint(table, scope, context.problems);
  const auto rows = [&](const char* key, const auto& read) {
    const auto* items = table.array(key);
    for (std::size_t i = 0; items && i < items->size(); ++i)
      if (auto row = as_table((*items)[i], fmt::format("{}[{}]", table.path(key), i + 1), context.problems)) read(*row);
  };
  rows("comparisons", [&](const Table& row) { out.comparisons.push_back(read_comparison(row, model, context)); });
  rows("printed", [&](const Table& row) { out.printed.push_back(read_printed(row, model, context)); });
  rows("one_at_a_time",
       [&](const Table& row) { out.one_at_a_time.push_back(read_one_at_a_time(row, scope, context)); });
  rows("conformity", [&](const Table& row) { out.conformity.push_back(read_conformity(row, scope, context)); });
  rows("targets", [&](const Table& row) { out.targets.push_back(read_target(row, scope, context)); });
  table.refuse_unknown();
  return out;
}

namespace {

void read_matrix(Table& table, std::size_t n, std::vector<double>& matrix) {
  const auto* rows = table.array("matrix");
  if (!rows) return;
  const Node& node = *table.find("matrix");
  Problems& problems = table.problems();
  for (const Node& row : *rows) {
    if (row.kind != Node::Kind::array || row.items.size() != n || rows->size() != n) {
      problems.add(node, fmt::format("{}: must have {} rows of {} numbers", table.path("matrix"), n, n));
      return;
    }
    for (const Node& cell : row.items) matrix.push_back(read_number(cell, table.path("matrix"), problems).value_or(0));
  }
  for (std::size_t i = 0; i < n * n && matrix.size() == n * n; ++i) {
    const double here = matrix[i], mirrored = matrix[(i % n) * n + i / n];
    const bool diagonal = i / n == i % n;
    if (here == mirrored && std::abs(here) <= 1 && (!diagonal || here == 1)) continue;
    problems.add(node, fmt::format("{}: row {}, column {} is {}", table.path("matrix"), i / n + 1, i % n + 1, here),
                 "correlations are symmetric, between -1 and 1, and 1 on the diagonal");
    return;
  }
}

quantities::Correlation read_correlation(Table table, const std::vector<std::string>& names) {
  quantities::Correlation out;
  Problems& problems = table.problems();
  table.require("quantities");
  out.quantities = table.texts("quantities");
  std::vector<std::string> seen;
  for (const std::string& name : out.quantities) {
    const Node& node = *table.find("quantities");
    if (std::find(names.begin(), names.end(), name) == names.end())
      problems.add(node, fmt::format("{}: '{}' is no quantity here", table.path("quantities"), name), "",
                   did_you_mean(name, names));
    if (std::find(seen.begin(), seen.end(), name) != seen.end())
      problems.add(node, fmt::format("{}: '{}' is named twice", table.path("quantities"), name));
    seen.push_back(name);
  }
  table.require("kind", "use copula, pearson or spearman");
  using Kind = quantities::Correlation::Kind;
  if (const auto kind = table.choice("kind", {"copula", "pearson", "spearman"}))
    out.kind = *kind == 0 ? Kind::copula : *kind == 1 ? Kind::pearson : Kind::spearman;
  const std::size_t n = out.quantities.size();
  table.rendered("source");
  const auto coefficient = table.number("coefficient");
  if (n < 2 && table.has("quantities")) table.add(table.path() + ": needs two quantities or more");
  if (table.has("coefficient") == table.has("matrix")) {
    table.add(table.path() + ": give either coefficient or matrix", "", "write coefficient = 0.5 for two quantities");
  } else if (coefficient && n != 2) {
    table.add(fmt::format("{}: one coefficient for {} quantities", table.path(), n), "", "give a matrix");
  } else if (coefficient && std::abs(*coefficient) > 1) {
    problems.add(*table.find("coefficient"),
                 fmt::format("{}: {} must lie between -1 and 1", table.path("coefficient"), *coefficient));
  } else if (coefficient) {
    out.matrix = {1, *coefficient, *coefficient, 1};
  }
  read_matrix(table, n, out.matrix);
  table.refuse_unknown();
  return out;
}

} // namespace

EstimateOptions read_estimate(Table table) {
  EstimateOptions out;
  using least_squares::Loss;
  if (const auto loss = table.choice("loss", {"squared", "huber", "cauchy", "tukey"}))
    out.loss = static_cast<Loss>(*loss);
  if (const auto width = table.positive("width")) out.width = *width;
  if (table.has("width") && out.loss == Loss::squared)
    table.problems().add(*table.find("width"), table.path("width") + ": the squared loss has no width", "",
                         "loss = \"huber\"");
  if (const auto n = table.integer("iterations", 1, 1'000'000)) out.iterations = static_cast<int>(*n);
  if (const auto posterior = table.choice("posterior", {"normal", "t"})) out.t = *posterior == 1;
  table.refuse_unknown();
  return out;
}

std::vector<quantities::Correlation> read_correlations(const std::vector<Node>& items, Problems& problems,
                                                       const std::vector<quantities::InputQuantity>& quantities) {
  std::vector<std::string> names;
  for (const auto& q : quantities) {
    names.push_back(q.name);
    for (const auto& entry : q.entries) {
      auto labels = entry.labels;
      std::sort(labels.begin(), labels.end()); // as draws are named
      const std::string cell = q.name + '[' + quantities::text_of(labels) + ']';
      if (!labels.empty()) names.push_back(cell);
      for (const auto& c : entry.components) {
        names.push_back(q.name + '.' + c.name);
        if (!labels.empty() && entry.components.size() > 1) names.push_back(cell + ": " + c.name);
      }
    }
  }
  std::vector<quantities::Correlation> out;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (auto row = as_table(items[i], fmt::format("correlations[{}]", i + 1), problems))
      out.push_back(read_correlation(*row, names));
  return out;
}

} // namespace gumshoe::scenario
