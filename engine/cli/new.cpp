/// `gumshoe new`: a first scenario of a model or of a data file.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "base/text_file.h"
#include "base/units.h"
#include "cli/command.h"
#include "cli/installed.h"
#include "cli/shell.h"
#include "scenario/document.h"
#include "scenario/log_form.h"
#include "scenario/made_models.h"
#include "scenario/starter_parts.h"
#include "store/draft.h"

namespace gumshoe::cli {

namespace {

namespace fs = std::filesystem;
using scenario::ColumnRole;
using scenario::RecognisedData;

constexpr std::size_t largest_file = std::size_t{256} << 20;

struct NewOptions {
  std::string model, from, form, out, machine;
  std::vector<std::string> units, roles, terms;
  bool force = false;
};

std::vector<std::string> names() {
  std::vector<std::string> out{"budget", "linear"};
  for (const models::Model* m : models::catalogue()) out.emplace_back(m->card->name);
  for (const auto& row : scenario::made_models())
    if (row.starts) out.emplace_back(row.name);
  return out;
}

bool on_terminal() { return isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0; }

std::string answer_to(const std::string& question) {
  std::cout << question << ' ' << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  return answer;
}

/// "COLUMN=VALUE"
std::pair<std::string, std::string> assignment(const std::string& text, const std::string& option) {
  const std::size_t at = text.rfind('=');
  if (at == std::string::npos || at == 0 || at + 1 == text.size())
    throw InputError(fmt::format("{}: '{}' is not COLUMN=VALUE", option, text), "",
                     fmt::format("write it as {} x=mm", option));
  return {text.substr(0, at), text.substr(at + 1)};
}

scenario::RecognisedColumn& column_of(RecognisedData& data, const std::string& name, const std::string& option) {
  for (auto& c : data.columns)
    if (c.name == name) return c;
  const std::string meant = nearest(name, data.csv.names());
  throw InputError(fmt::format("{}: '{}' has no column '{}'", option, data.csv.file, name), "",
                   meant.empty() ? fmt::format("use one of {}", fmt::join(data.csv.names(), ", "))
                                 : fmt::format("did you mean '{}'?", meant));
}

ColumnRole role_of(const std::string& word) {
  std::vector<std::string> all;
  for (int r = 0; r <= static_cast<int>(ColumnRole::uncertainty); ++r) {
    if (word == name(static_cast<ColumnRole>(r))) return static_cast<ColumnRole>(r);
    all.emplace_back(name(static_cast<ColumnRole>(r)));
  }
  throw InputError(fmt::format("--role: '{}' is no role of a column", word), "",
                   fmt::format("use one of {}", fmt::join(all, ", ")));
}

/// What the options say of columns, then what a user at the terminal answers.
void tell(RecognisedData& data, const NewOptions& o) {
  bool told_readings = false;
  for (const std::string& text : o.roles) {
    const auto [column, word] = assignment(text, "--role");
    const ColumnRole role = role_of(word);
    const bool further = role == ColumnRole::reading && std::exchange(told_readings, true); // there may be several
    for (auto& c : data.columns)                                                            // else one column has it
      if (c.role == role && role != ColumnRole::other && role != ColumnRole::label && !further) c.leave();
    auto& c = column_of(data, column, "--role");
    c.take(role, scenario::Basis::user, "by --role");
  }
  // A guessed reading that is named a position leaves its role to another column.
  const auto named_position = [](const std::string& text) { return assignment(text, "--role").second == "position"; };
  if (!data.find(ColumnRole::reading) && std::ranges::any_of(o.roles, named_position)) scenario::guess_roles(data);
  for (const std::string& text : o.units) {
    auto [column, unit] = assignment(text, "--unit");
    if (unit == "none" || unit == "-" || unit == "dimensionless") unit = "1";
    units::si_unit_of(unit);
    auto& c = column_of(data, column, "--unit");
    c.unit = unit;
    c.unit_told = true;
  }
  if (!on_terminal()) return;
  for (auto& c : data.columns) {
    if (c.unit != "?" || c.role == ColumnRole::other) continue;
    const std::string unit =
        answer_to(fmt::format("unit of the column '{}' ({}), such as mm; empty: decide later:", c.name, name(c.role)));
    if (unit.empty()) continue;
    c.unit_told = units::convertible(unit, units::si_unit_of(unit));
    c.unit = c.unit_told ? unit : "?";
  }
}

std::string example_of(const std::string& model) {
  const fs::path folder = data_folder("examples", GUMSHOE_EXAMPLES_DIR);
  return (folder / model / "example.toml").string();
}

/// The example of a model, as a first scenario; empty if there is no such model. The card of a model that a scenario
/// describes is that of its example.
std::string text_of_model(const std::string& name, const scenario::StarterData* data) {
  const auto rows = scenario::made_models();
  const bool made = std::ranges::any_of(rows, [&](const auto& row) { return row.starts && row.name == name; });
  const models::Model* model = models::find(name);
  if (!model && !made) return {};
  const std::string example = example_of(name), text = read_text_file(example, largest_file);
  if (model) return scenario::starter_model(*model->card, text, data);
  const auto read = scenario::read(example, catalogue());
  return scenario::starter_model(*read.made->card, text, data);
}

std::string text_of(const NewOptions& o, const RecognisedData* found, const std::string& out) {
  std::unique_ptr<scenario::StarterData> data;
  if (found)
    data = std::make_unique<scenario::StarterData>(scenario::StarterData{
        *found, fs::relative(fs::absolute(o.from), fs::absolute(out).parent_path()).generic_string()});
  const auto targets = found && o.model.empty() ? scenario::target_columns(*found) : scenario::TargetColumns{};
  if (targets.size() > 1) return scenario::starter_targets(*data, targets, out);
  if (o.model.empty())
    return found->find(scenario::ColumnRole::position) ? scenario::starter_axis(*data, out)
                                                       : scenario::starter_series(*data, out);
  if (o.model == "budget") return scenario::starter_budget();
  if (o.model == "linear") return scenario::starter_linear(*data, o.terms, out);
  if (o.model == "sphere_probing" && data) return scenario::starter_probing(*data, o.machine);
  if (std::string text = text_of_model(o.model, data.get()); !text.empty()) return text;
  const std::string meant = nearest(o.model, names());
  throw InputError(fmt::format("unknown model '{}'", o.model), "",
                   meant.empty() ? fmt::format("use one of {}", fmt::join(names(), ", "))
                                 : fmt::format("did you mean '{}'?", meant));
}

void write_file(const std::string& path, const std::string& text, bool force) {
  const store::Claim claim(path);
  std::ifstream in(claim.target(), std::ios::binary);
  const std::string there{std::istreambuf_iterator<char>(in), {}};
  if (!there.empty() && there != text && !force)
    throw OutputError("'" + path + "': not overwritten", "a file stands there",
                      "choose another name by --out, or use --force to replace it");
  store::Draft draft;
  draft.add(claim, text);
  draft.publish();
}

/// A description of logs: a file of the user's, or the name of one that is shipped, which is then copied next to the
/// scenario.
std::string description_of(const NewOptions& o, const fs::path& folder) {
  const fs::path shipped = fs::path(data_folder("scenarios", GUMSHOE_SCENARIOS_DIR)) / "forms";
  if (fs::is_regular_file(o.form)) return o.form;
  std::vector<std::string> known;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(shipped, none))
    if (entry.path().extension() == ".toml") known.push_back(entry.path().stem().string());
  std::ranges::sort(known);
  if (std::ranges::find(known, o.form) == known.end()) {
    const std::string meant = nearest(o.form, known);
    throw InputError(fmt::format("--form: '{}' is neither a file nor a description that is shipped", o.form), "",
                     meant.empty() ? fmt::format("use one of {}, or a file of your own", fmt::join(known, ", "))
                                   : fmt::format("did you mean '{}'?", meant));
  }
  std::string copy = (folder / (o.form + ".toml")).string();
  const std::string original = (shipped / (o.form + ".toml")).string();
  if (!fs::equivalent(copy, original, none)) write_file(copy, read_text_file(original, largest_file), o.force);
  return copy;
}

/// The data file as a table. @param out  the scenario
RecognisedData table_of(const NewOptions& o, const std::string& out) {
  const std::string text = read_data_file(o.from, largest_file);
  if (o.form.empty()) return scenario::recognise(text, o.from);
  const std::string form = description_of(o, fs::path(out).parent_path());
  return scenario::recognise(scenario::LogForm(read_text_file(form, largest_file), form).read(text, o.from),
                             fs::relative(fs::absolute(form), fs::absolute(out).parent_path()).generic_string());
}

/// Whether a column of numbers is not used that may as well be what was read as the one that was guessed.
bool another_reading(const RecognisedData& found, const scenario::RecognisedColumn& c, const std::string& text) {
  const auto* reading = found.find(ColumnRole::reading);
  return reading && reading->basis == scenario::Basis::place && c.number && c.role == ColumnRole::other &&
         c.unit != "1" && !scenario::counts_rows(c) && !scenario::names_parts(c) && !scenario::is_circumstance(c) &&
         text.find(scenario::toml_string(c.name)) == std::string::npos;
}

/// The name of a column in the scenario where its own means something else in formulas; else empty.
std::string other_name(const scenario::RecognisedColumn& c, const std::string& text) {
  const auto meaning = scenario::meaning_in_formulas(c.name);
  const std::string name = scenario::plain_name(c.name);
  if (meaning.empty() || text.find(name) == std::string::npos) return "";
  return fmt::format("; named {}, because its own name is {}", name, meaning);
}

/// Whether the scenario does more with a column than to state its unit, on a line that begins with its name.
bool uses(const std::string& text, const std::string& quoted) {
  for (std::size_t at = text.find(quoted); at != std::string::npos; at = text.find(quoted, at + 1))
    if (at > 0 && text[at - 1] != '\n') return true;
  return false;
}

/// Whether the scenario tells readings apart by a column.
bool is_label(const std::string& text, const std::string& quoted) {
  const std::size_t at = text.find("\nlabels = {");
  return at != std::string::npos &&
         text.substr(at, text.find('\n', at + 1) - at).find("= " + quoted) != std::string::npos;
}

/// What the scenario does with each column.
void print_columns(const RecognisedData& found, const std::string& text) {
  for (const auto& c : found.columns) {
    const std::string quoted = scenario::toml_string(c.name);
    const bool used = uses(text, quoted);
    const bool label = used && (c.role == ColumnRole::other || c.role == ColumnRole::label) && is_label(text, quoted);
    const char* use = !used                                                    ? "not used"
                      : text.find("readings = " + quoted) != std::string::npos ? name(ColumnRole::reading)
                      : label                                                  ? "label, which tells readings apart"
                      : c.role == ColumnRole::other                            ? "used by its name"
                                                                               : name(c.role);
    const std::string why = used ? c.why : scenario::why_not_used(found, c);
    std::cout << fmt::format("  {}: {}{}{}{}\n", c.name, use,
                             label || c.unit == "1" ? ""
                             : c.unit == "?"        ? ", unit unknown"
                                                    : ", " + c.unit,
                             why.empty() ? "" : fmt::format(" ({})", why), other_name(c, text));
    if (another_reading(found, c, text))
      std::cout << fmt::format("    if this is what was read: --role {}\n", shell_word(c.name + "=reading"));
  }
}

/// How many rows there are, are left out, and stand twice.
void print_rows(const RecognisedData& found, const std::string& file, const std::string& text) {
  std::vector<std::size_t> used;
  std::vector<std::string> names;
  bool labels = false; // among them
  for (const auto& c : found.columns)
    if ((c.gaps || (is_label(text, scenario::toml_string(c.name)) && scenario::has_empty_cells(found, c))) &&
        uses(text, scenario::toml_string(c.name))) {
      used.push_back(static_cast<std::size_t>(found.csv.find(c.name)));
      names.push_back(c.name);
      labels |= !c.gaps;
    }
  const auto left_out = std::ranges::count_if(found.csv.rows, [&](const auto& row) {
    return std::ranges::any_of(used, [&](std::size_t c) { return scenario::says_missing(row[c].text); });
  });
  std::cout << fmt::format("{}: {} rows{}\n", file, found.csv.rows.size(),
                           left_out == 0
                               ? ""
                               : fmt::format(", of which {} left out: {} {} there",
                                             left_out == 1 ? "1 is" : fmt::format("{} are", left_out),
                                             fmt::join(names, " or "), labels ? "has nothing" : "has no number"));
  if (const auto copied = scenario::copied_rows(found.csv); copied.rows > 0)
    std::cout << fmt::format(
        "  {} rows from line {} on are those from line {} on in every cell: were they copied? Rows "
        "that count twice make uncertainties too small\n",
        copied.rows, copied.second, copied.first);
}

/// Quantities with a value for each part, in the words of their comment: what they absorb is found by nobody.
void print_fitted_by_label(const std::string& text, const std::string& out) {
  const scenario::Node document = scenario::parse_document(text, out);
  const scenario::Node* const quantities = scenario::find_member(document, "quantities");
  for (const auto& [name, line, column, quantity] :
       quantities ? quantities->members : std::vector<scenario::Member>{}) {
    const auto* const estimated = scenario::find_member(quantity, "estimated");
    const auto* const by = scenario::find_member(quantity, "by");
    if (!estimated || !estimated->boolean || !by || by->members.empty()) continue;
    std::cout << fmt::format("  {}: {} (line {}; for one that all share: value = ... in place of by.{})\n", name,
                             scenario::by_label_comment(by->members[0].key, ""), line, by->members[0].key);
  }
}

/// Reads what was written: what is missing, or which command comes next.
/// @param found  null: no data file
void print_next(const NewOptions& o, const std::string& out, const RecognisedData* found) {
  try {
    const auto s = scenario::read(out, catalogue());
    if (s.made && !s.made->card->axes.empty() && o.machine.empty())
      std::cout << fmt::format(
          "{}: the machine is that of the example. Replace [machine] by yours, then: gumshoe {} {}\n", out,
          o.from.empty() ? "run" : "estimate", shell_file(out));
    else
      std::cout << fmt::format("{}: ready. Next: gumshoe {} {}\n", out,
                               o.model.empty() || o.model == "linear" ? "trace" : "run", shell_file(out));
  } catch (const InputError& error) {
    std::cout << fmt::format("{}: to fill in, then gumshoe check {}:\n{}\n", out, shell_file(out), error.what());
    std::string options;
    for (const auto& c : found ? found->columns : std::vector<scenario::RecognisedColumn>{})
      if (std::string(error.what()).find(fmt::format("the unit of the column '{}'", c.name)) != std::string::npos)
        options += " --unit " + shell_word(c.name + "=UNIT");
    if (o.model == "sphere_probing" && o.machine.empty()) options += " --machine B,C/X,Y,Z";
    if (!options.empty()) std::cout << fmt::format("or write it anew: gumshoe new ... --force{}\n", options);
  }
}

ExitCode run(NewOptions o) {
  if (o.model.empty() && o.from.empty() && on_terminal()) {
    o.model = answer_to(fmt::format("model ({}), empty for a data file:", fmt::join(names(), ", ")));
    o.from = answer_to("data file, empty for none:");
  }
  if (o.model.empty() && o.from.empty())
    throw InputError("neither a model nor a data file is named", "",
                     fmt::format("name one of {}, or a file by --from", fmt::join(names(), ", ")));
  if (o.model == "budget" && !o.from.empty())
    throw InputError("--from: a budget has no data file", "its readings stand in the scenario",
                     "leave --from out, or name no model");
  if (o.model == "linear" && o.from.empty())
    throw InputError("a linear model is made of the columns of a data file, but none is named", "",
                     "name one by --from");
  if (o.model != "linear" && !o.terms.empty())
    throw InputError("--term: only a linear model has terms", "", "write gumshoe new linear --from FILE --term ...");
  if (!o.machine.empty() && (o.model != "sphere_probing" || o.from.empty()))
    throw InputError("--machine: only a sphere's readings are started on a machine of yours", "",
                     "write gumshoe new sphere_probing --from FILE --machine B,C/X,Y,Z");
  if (on_terminal() && o.model == "sphere_probing" && !o.from.empty() && o.machine.empty())
    o.machine = answer_to("axes from the bed to the workpiece / to the tool, such as B,C/X,Y,Z; empty: decide later:");
  if (!o.form.empty() && o.from.empty())
    throw InputError("--form: there is no log that it would describe", "", "name the log by --from");
  const std::string out =
      !o.out.empty() ? o.out : (o.model.empty() ? fs::path(o.from).stem().string() : o.model) + ".toml";
  std::unique_ptr<RecognisedData> found;
  if (!o.from.empty()) {
    found = std::make_unique<RecognisedData>(table_of(o, out));
    tell(*found, o);
  }
  if (found && !found->rewritten.empty()) {
    const std::string rows = fs::path(out).replace_extension(".rows.csv").string();
    write_file(rows, found->rewritten, o.force);
    std::cout << fmt::format("{}: the runs of {} one below the other, with a row for each reading\n", rows, o.from);
    o.from = rows;
  }
  const std::string text = text_of(o, found.get(), out);
  write_file(out, text, o.force);
  if (found) {
    print_rows(*found, o.from, text);
    print_columns(*found, text);
    print_fitted_by_label(text, out);
  }
  print_next(o, out, found.get());
  return ExitCode::done;
}

} // namespace

void add_new(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("new", "writes a first scenario: of a model, of a data file, or a budget");
  const auto o = std::make_shared<NewOptions>();
  command->add_option("model", o->model,
                      "a model (gumshoe models), budget, or linear; without one, --from asks what a data file shows");
  command->add_option("--from", o->from, "data file whose columns are recognised");
  command->add_option("--form", o->form,
                      "description of a log that is no table: a file, or the name of one that is shipped, such as "
                      "heidenhain_q");
  command->add_option("-o,--out", o->out, "scenario to write (default: MODEL.toml, or the name of the data file)");
  command->add_option("--unit", o->units, "COLUMN=UNIT, where the header does not say it; 1 for numbers without one");
  command->add_option(
      "--role", o->roles,
      "COLUMN=ROLE: position, reading, direction, time, temperature, cycle, alignment (its offset and slope are "
      "fitted for each of its values), label (its words or numbers tell readings apart), uncertainty, other");
  command
      ->add_option("--term", o->terms,
                   "of linear: a column, or a product such as load*machine; a column of words is a factor (default: "
                   "every column of numbers)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--machine", o->machine,
                      "of sphere_probing: axes from the bed to the workpiece / to the tool, such as B,C/X,Y,Z, or a "
                      "known machine such as TTTRR");
  add_force(*command, o->force);
  command->callback([=, &action] { action = [=] { return run(*o); }; });
}

} // namespace gumshoe::cli
