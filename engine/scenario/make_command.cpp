#include <fmt/format.h>

#include "models/command/command.h"
#include "scenario/declared.h"
#include "scenario/external.h"
#include "scenario/made_models.h"

namespace gumshoe::scenario {
namespace {

std::vector<std::string> read_words(Table& model, Problems& problems) {
  std::vector<std::string> words;
  const Node* node = model.require("command", "command = [\"python3\", \"model.py\"]");
  if (!node) return words;
  const auto* items = model.array("command");
  if (!items) return words;
  for (const Node& item : *items)
    if (const auto word = read_text(item, "model.command", problems)) words.push_back(*word);
  if (items->empty() || (!words.empty() && words.front().empty()))
    problems.add(*node, "model.command: no program is named", "", "command = [\"python3\", \"model.py\"]");
  return words;
}

/// y = "mm", or y = { unit = "mm", meaning = "..." }
std::vector<Symbol> read_measurands(Table& model, Problems& problems) {
  std::vector<Symbol> out;
  if (!model.require("measurands", "[model.measurands] y = \"mm\"")) return out;
  auto table = model.table("measurands");
  if (!table) return out;
  for (const Member& m : table->members()) {
    Symbol s{m.key, "1", "1", ""};
    if (m.value.kind == Node::Kind::table) {
      Table own(m.value, table->path(m.key), problems);
      s.unit = own.text("unit").value_or("1");
      s.meaning = own.text("meaning").value_or("");
      own.refuse_unknown();
    } else {
      s.unit = read_text(m.value, table->path(m.key), problems).value_or("1");
    }
    try {
      s.si_unit = units::si_unit_of(s.unit);
    } catch (const InputError& error) {
      const Problem& p = error.problems().front();
      problems.add(m.value, fmt::format("{}: {}", table->path(m.key), p.what), p.why, p.remedy);
    }
    out.push_back(s);
  }
  if (out.empty()) table->add("model.measurands: no measurand is named", "nothing can be evaluated", "y = \"mm\"");
  return out;
}

/// The name of a column in the tables that go and come.
void require_plain(const std::vector<Symbol>& symbols, const Table& model) {
  for (const Symbol& s : symbols)
    if (s.name.find_first_of("(),\"\n\r") != std::string::npos)
      model.add(fmt::format("model: '{}' cannot be a column name", s.name),
                "brackets, commas and quotes are delimiters");
}

} // namespace

models::MadeModel make_command(const MadeModelSource& source) {
  auto& [model, top, folder, context] = source;
  const std::size_t before = context.problems.size();
  models::CommandSpec spec;
  spec.folder = folder;
  spec.words = read_words(model, context.problems);
  if (const auto batch = model.integer("batch", 1, 10'000'000)) spec.batch = static_cast<std::size_t>(*batch);
  if (const auto limit = model.measure("time_limit", {"s"})) spec.time_limit = *limit;
  if (!(spec.time_limit > 0 && spec.time_limit <= 1e7))
    context.problems.add(*model.find("time_limit"), "model.time_limit: must be above 0 and at most 1e7 s");
  spec.card.measurands = read_measurands(model, context.problems);
  const Declared declared = declared_symbols(top, context.problems);
  context.own_quantities = true;
  spec.card.quantities = declared.quantities;
  spec.card.conditions = declared.conditions;
  spec.card.indications = declared.indications;
  for (const auto* symbols :
       {&spec.card.quantities, &spec.card.conditions, &spec.card.indications, &spec.card.measurands})
    require_plain(*symbols, model);
  if (context.problems.size() > before) return nullptr;
  spec.card.name = "command";
  spec.card.title = fmt::format("{}", fmt::join(spec.words, " "));
  const Node* node = model.find("command");
  spec.where = {context.problems.file(), node->line, node->column};
  // A program by its path, and scripts among the arguments, fix the numbers; a name is looked up by PATH.
  for (std::size_t i = 0; i < spec.words.size(); ++i)
    if (i > 0 || spec.words[i].find('/') != std::string::npos) context.files.include(spec.words[i]);
  if (!admit(context, *node, "model.command", spec.card.title)) return nullptr;
  return models::make_command(spec);
}

} // namespace gumshoe::scenario
