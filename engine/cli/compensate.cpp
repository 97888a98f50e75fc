/// `gumshoe compensate`: what a control can take back, from a traced or estimated scenario.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "calibration/compensation.h"
#include "calibration/compensation_between.h"
#include "calibration/compensation_files.h"
#include "cli/command.h"

namespace gumshoe::cli {

namespace {

struct CompensateOptions {
  std::string scenario, out, resolution, step, reference;
  calibration::CompensationRequest of;
  calibration::CompensationChoice choice;
  bool force = false, unconfirmed = false;
};

double measure(const std::string& text, const std::string& si_unit) {
  const auto given = units::parse(text);
  return units::to_si(given.number, given.unit, si_unit, units::Kind::difference);
}

/// 0 if the option is not given.
double positive(const std::string& option, const std::string& text, const std::string& si_unit) {
  if (text.empty()) return 0;
  const double value = measure(text, si_unit);
  if (!(value > 0))
    throw InputError(fmt::format("{}: '{}' must be positive", option, text), "",
                     "write a value above 0, or leave it out");
  return value;
}

/// "shape_1 (18 sizes)" instead of shape_1_1, shape_1_2 and so on.
std::vector<std::string> together(const std::vector<std::string>& names) {
  std::vector<std::pair<std::string, int>> counted;
  for (const std::string& name : names) {
    const std::string stem = calibration::whole_of(name);
    const bool numbered = stem != name;
    if (!counted.empty() && counted.back().first == stem && numbered)
      ++counted.back().second;
    else
      counted.emplace_back(stem, 1);
  }
  std::vector<std::string> out;
  for (const auto& [name, count] : counted) out.push_back(count > 1 ? fmt::format("{} ({} sizes)", name, count) : name);
  return out;
}

std::string position_unit(const calibration::Compensation& of) { return of.position_si_unit == "rad" ? "deg" : "mm"; }

double position_number(double si, const calibration::Compensation& of) {
  return units::from_si(si, position_unit(of), of.position_si_unit, units::Kind::difference);
}

/// With a unit.
std::string error_text(double si, const calibration::Compensation& of) {
  const bool length = of.indication_si_unit == "m", angle = of.indication_si_unit == "rad";
  const std::string unit = length ? "um" : angle ? "arcsec" : of.indication_si_unit;
  return fmt::format("{:.3g} {}", units::from_si(si, unit, of.indication_si_unit, units::Kind::difference), unit);
}

/// How far the readings would be off with the table as it is written.
void print_left(const calibration::Compensation& of, const calibration::AppliedTable& table) {
  const auto shown = [&](double x) { return error_text(x, of); };
  for (const auto& left : calibration::left_with(of, table)) {
    std::cerr << fmt::format("root mean square of {}{}: {}, with the table {}", left.which,
                             of.set_up.empty() ? "" : fmt::format(", less {}", fmt::join(of.set_up, " and ")),
                             shown(left.before), shown(left.with));
    if (left.with > 1.01 * left.without)
      std::cerr << fmt::format(", of which {} is noise and the rest what is left out, interpolated or rounded",
                               shown(left.without));
    std::cerr << '\n';
  }
}

/// What u holds in addition to the uncertainty of the fit, and what it does not.
void print_declared(const calibration::Compensation& of) {
  std::vector<std::string> in, out;
  for (const auto& d : of.declared)
    if (d.contained)
      in.push_back(fmt::format("{} (up to {})", d.name, error_text(d.most, of)));
    else
      out.push_back(d.name);
  if (!in.empty()) std::cerr << fmt::format("u contains the declared uncertainty of {}\n", fmt::join(in, ", "));
  if (!out.empty())
    std::cerr << fmt::format(
        "warning: u does not contain the declared uncertainty of {} (the estimate held it, and the "
        "scenario has no readings with noise to say how the values depend on it)\n",
        fmt::join(out, ", "));
}

/// Where a table with steps of its own begins and ends, and the travel that was measured.
void print_travel(const calibration::Compensation& of, const calibration::AppliedTable& table) {
  const auto shown = [&](double x) { return fmt::format("{:.6g} {}", position_number(x, of), position_unit(of)); };
  const double end = table.up.back().first, measured = of.rows.back().position;
  std::cerr << fmt::format("table: {} points, {} to {}", table.up.size(), shown(table.up.front().first), shown(end));
  if (shown(end) != shown(measured))
    std::cerr << fmt::format("; measured to {}, where the last error holds", shown(measured));
  std::cerr << '\n';
}

/// A control interpolates where the model may know better: a line that says so, or nothing.
std::string warning_of_lines(const propagation::Experiment& experiment, const CompensateOptions& o,
                             const calibration::Compensation& table, const calibration::AppliedTable& applied) {
  std::vector<double> positions;
  for (const auto& [x, error] : applied.up.empty() ? applied.down : applied.up)
    if (positions.empty() || x > positions.back()) positions.push_back(std::min(x, table.rows.back().position));
  const auto lines = calibration::straight_lines(experiment, o.of, table, positions);
  if (lines.poor) {
    const double step = calibration::sufficient_step(experiment, o.of, table);
    return fmt::format(
        "warning: the errors vary by {} (root mean square) between the positions of the table, and straight lines miss "
        "{} of it: a control, which interpolates, may make them worse there; {}\n",
        error_text(lines.errors, table), error_text(lines.missed, table),
        !(step > 0)
            ? "measure at closer positions"
            : fmt::format("use {}--step \"{:.3g} {}\"", o.choice.format == "csv" ? "a --format of a control and " : "",
                          position_number(step, table), position_unit(table)));
  }
  if (table.coarse)
    return fmt::format("warning: from one {} to the next the errors change by as much as they are: between these a "
                       "control interpolates, and may make them worse; measure at closer positions\n",
                       table.position);
  return "";
}

ExitCode compensate(CompensateOptions o) {
  scenario::Scenario s = scenario::read(o.scenario, catalogue());
  if (o.unconfirmed) s.trace.unconfirmed.clear();
  const propagation::Experiment experiment(s);
  calibration::Compensation table = calibration::compensation(experiment, o.of);
  o.choice.resolution = positive("--resolution", o.resolution, table.indication_si_unit);
  o.choice.step = positive("--step", o.step, table.position_si_unit);
  o.choice.at_reference = !o.reference.empty();
  if (o.choice.at_reference) o.choice.reference = measure(o.reference, table.position_si_unit);
  std::vector<double> asked = calibration::step_positions(table, o.choice);
  if (o.choice.at_reference) asked.push_back(o.choice.reference);
  table.between = calibration::errors_at(experiment, o.of, table, asked);
  const calibration::CompensationFile file = calibration::compensation_file(table, o.choice);
  const std::string warning = warning_of_lines(experiment, o, table, file.applied);
  if (o.out.empty())
    std::cout << file.text;
  else
    write_table(o.out, file.text, o.force);
  std::cerr << fmt::format("holds: {}\n", fmt::join(together(table.holds), ", "));
  std::cerr << warning;
  print_declared(table);
  for (const auto& left : table.left_out) std::cerr << fmt::format("left out: {} {}\n", left.name, left.why);
  if (o.choice.step > 0) print_travel(table, file.applied);
  print_left(table, file.applied);
  const auto& formats = calibration::compensation_formats();
  const auto format = std::ranges::find(formats, o.choice.format, &calibration::CompensationFormat::name);
  std::string check(o.choice.negate ? format->check_negated : format->check);
  if (const auto at = check.find(" mm "); table.position_si_unit == "rad" && at != check.npos)
    check.replace(at, 4, " deg ");
  if (!check.empty()) std::cerr << fmt::format("prove the sign on the machine: {}\n", check);
  if (!o.out.empty()) std::cerr << "written: " << o.out << '\n';
  return ExitCode::done;
}

/// An option that the format has no place for would be ignored.
void require_place(const CLI::App& command, const std::string& format) {
  const auto& known =
      *std::ranges::find(calibration::compensation_formats(), format, &calibration::CompensationFormat::name);
  for (const std::string_view option : {"axis", "step", "reference", "resolution", "negate"})
    if (command.count(fmt::format("--{}", option)) > 0 &&
        std::ranges::find(known.options, option) == known.options.end())
      throw InputError(fmt::format("--{} says nothing to the format {}", option, format),
                       known.options.empty() ? "its table is written as measured"
                                             : fmt::format("it knows --{}", fmt::join(known.options, ", --")),
                       "leave it out, or use another --format");
}

} // namespace

void add_compensate(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("compensate", "writes what a control can correct, of a scenario that trace or estimate wrote");
  const auto o = std::make_shared<CompensateOptions>();
  std::vector<std::string> formats;
  std::string meanings;
  for (const auto& f : calibration::compensation_formats()) {
    formats.push_back(f.name);
    meanings += fmt::format("\n  {}: {}", f.name, f.meaning);
  }
  command->add_option("scenario", o->scenario, "scenario with its readings, as gumshoe trace or estimate wrote it")
      ->required();
  command->add_option("--format", o->choice.format, "format of the table:" + meanings)->check(CLI::IsMember(formats));
  command->add_option("-o,--out", o->out, "output file (default: standard output)");
  command->add_option("--axis", o->choice.axis, "name of the axis in the control (default: X)");
  command->add_option("--indication", o->of.indication,
                      "the deviation, actual minus commanded (default: the only one)");
  command->add_option("--position", o->of.position,
                      "condition that is the position (default: the only length or angle)");
  command->add_option("--direction", o->of.direction, "condition whose sign is the direction (default: direction)");
  command->add_option("--with", o->of.with, "quantities of the model that count, too, such as a gain");
  command->add_option("--without", o->of.without, "effects to leave out");
  command->add_option(
      "--step", o->step,
      "interval of the table, to the end of the travel, by the model between the positions measured: \"50 mm\"");
  command->add_option("--reference", o->reference,
                      "position at which the control's table is zero (default: the first)");
  command->add_option("--resolution", o->resolution, "to which values are rounded (default: 0.1 um)");
  command->add_flag("--negate", o->choice.negate,
                    "changes the sign, where it is a setting of the machine (isg, etalon)");
  command->add_flag("--unconfirmed", o->unconfirmed, "also what held-out readings could neither confirm nor reject");
  add_force(*command, o->force);
  add_external(*command);
  command->callback(
      [=, &action] { action = [=] { return require_place(*command, o->choice.format), compensate(*o); }; });
}

} // namespace gumshoe::cli
