/// `gumshoe evaluate`: the forward model at the points of a table.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "base/csv.h"
#include "cli/command.h"
#include "propagation/point_table.h"
#include "scenario/made_models.h"

namespace gumshoe::cli {

namespace {

/// Cells in the form of the table that was read: where the comma is its decimal sign, with semicolons between them.
class Rows {
public:
  explicit Rows(char decimal) : separator_(decimal == ',' ? ';' : ',') {}
  void cell(const std::string& text) { text_ += csv_cell(text, separator_) + separator_; }
  void number(double x, const std::string& status) {
    std::string digits = status == "ok" ? fmt::format("{:.15g}", x) : "nan";
    if (separator_ == ';') std::ranges::replace(digits, '.', ',');
    cell(digits);
  }
  void end(const std::string& status) { text_ += status + '\n'; }
  std::string take() { return std::move(text_); }

private:
  char separator_;
  std::string text_;
};

std::string to_csv(const Csv& in, const propagation::PointTable& added, char decimal) {
  Rows out(decimal);
  if (!added.joint) // else one row of results for the whole table
    for (const CsvCell& cell : in.header) out.cell(cell.text);
  for (const std::string& name : added.header) out.cell(name);
  out.end("status");
  for (std::size_t r = 0; r < added.status.size(); ++r) {
    if (!added.joint)
      for (const CsvCell& cell : in.rows[r]) out.cell(cell.text);
    for (const auto& column : added.columns) out.number(column[r], added.status[r]);
    out.end(added.status[r]);
  }
  return out.take();
}

/// The model asked for: one of the catalogue, or that of a scenario, with its values.
struct Asked {
  const models::Model* model = nullptr;
  std::unique_ptr<const scenario::Scenario> scenario; ///< outlives `values`
  std::unique_ptr<const propagation::Experiment> values;
};

Asked asked(const std::string& name) {
  if (name.ends_with(".toml")) {
    auto s = std::make_unique<const scenario::Scenario>(scenario::read(name, catalogue()));
    if (std::ranges::any_of(s->stated_effects, [](const auto& e) { return e.freed; }))
      throw InputError(name + ": stated effects are not evaluated at points", "their formulas belong to the readings",
                       "leave their sizes out");
    auto values = std::make_unique<const propagation::Experiment>(*s);
    return {&values->model(), std::move(s), std::move(values)};
  }
  if (const models::Model* model = models::find(name)) return {model, {}, {}};
  if (std::ranges::find(scenario::made_models(), name, &scenario::MadeModelRow::name) != scenario::made_models().end())
    throw InputError(fmt::format("{}: a scenario describes this model", name), "it has no quantities of its own",
                     "name the scenario file in place of the model");
  std::vector<std::string> names;
  for (const auto* m : models::catalogue()) names.emplace_back(m->card->name);
  const std::string meant = nearest(name, names);
  throw InputError("unknown model '" + name + "'", "",
                   meant.empty() ? "see what gumshoe models lists" : "did you mean '" + meant + "'?");
}

} // namespace

void add_evaluate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("evaluate", "evaluates the model at the points of a table, without sampling");
  struct Options {
    std::string model, table, out, evaluation, decimal = ".";
    bool force = false;
  };
  const auto o = std::make_shared<Options>();
  command
      ->add_option("model", o->model,
                   "a model (gumshoe models), or a scenario file, whose values stand for columns that are left out")
      ->required();
  command->add_option("--table", o->table, "CSV file; header cells `name (unit)`, one row per point")->required();
  command->add_option("-o,--out", o->out, "output file (default: standard output)");
  add_force(*command, o->force);
  add_external(*command);
  command->add_option("--evaluation", o->evaluation, "evaluation of the model (default: the scenario's, or the first)");
  command->add_option("--decimal", o->decimal, "decimal sign of the table's numbers")->check(CLI::IsMember({".", ","}));
  command->callback([=, &action] {
    action = [=] {
      const Asked of = asked(o->model);
      const Csv table = read_csv(o->table);
      const auto points = propagation::evaluate_points(*of.model, table, o->evaluation, of.values.get(), o->decimal[0]);
      const std::string text = to_csv(table, points, o->decimal[0]);
      if (o->out.empty())
        std::cout << text;
      else
        write_table(o->out, text, o->force);
      for (const std::string& note : points.notes) std::cerr << "note: " << note << '\n';
      for (const Problem& p : points.impossible) std::cerr << format(p) << '\n';
      return points.impossible.empty() ? ExitCode::done : ExitCode::bad_input;
    };
  });
}

} // namespace gumshoe::cli
