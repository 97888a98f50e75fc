#include "calibration/compensation_files.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/units.h"

namespace gumshoe::calibration {
namespace {

constexpr std::size_t most_points = 10'000; ///< more than any of these controls reads

/// One position with the errors in both directions, in the control's unit.
struct Point {
  double x = 0, up = 0, down = 0;
  double mean() const { return (up + down) / 2; }
};

[[noreturn]] void refuse(const std::string& what, const std::string& why, const std::string& remedy) {
  throw InputError(what, why, remedy);
}

/// These controls' tables have one interval.
bool equidistant(const CompensationChoice& choice) { return choice.format.starts_with("sinumerik"); }

class Writer {
public:
  Writer(const Compensation& t, const CompensationChoice& c)
      : t_(t), c_(c), angle_(t.position_si_unit == "rad"), radians_(c.format == "isg" || c.format == "etalon") {}

  CompensationFile write() {
    std::string text = written();
    return {std::move(text), std::move(applied_)};
  }

private:
  std::string written() {
    if (c_.format == "csv") return csv();
    require_one_kind();
    require_name();
    make_points();
    if (c_.format == "linuxcnc") return linuxcnc(false);
    if (c_.format == "linuxcnc-trim") return linuxcnc(true);
    if (c_.format == "sinumerik-eec") return eec();
    if (c_.format == "sinumerik-cec") return cec();
    return c_.format == "isg" ? isg() : etalon();
  }

  /// A control's table has errors in the unit of its positions.
  void require_one_kind() const {
    if (t_.position_si_unit != t_.indication_si_unit)
      refuse(fmt::format("'{}' is {}, along '{}', which is {}", t_.indication, units::kind_name(t_.indication_si_unit),
                         t_.position, units::kind_name(t_.position_si_unit)),
             "this control corrects lengths along lengths, and angles along angles", "use --format csv");
  }

  /// It stands in the lines of the file as it is.
  void require_name() const {
    const auto part = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    if (c_.axis.empty() || !std::ranges::all_of(c_.axis, part))
      refuse("--axis: the name of an axis has letters, digits and _ only", "", "write it as the control does");
  }

  bool both() const { return !t_.direction.empty(); }
  static constexpr double degree = 3.14159265358979323846 / 180;
  double position(double si) const { return angle_ ? si / degree : si * 1e3; }
  double error_si(double x) const { return !angle_ ? x * 1e-3 : radians_ ? x : x * degree; }
  double error(double si) const {
    const double in_unit = !angle_ ? si * 1e3 : radians_ ? si : si / degree;
    return std::round(in_unit / resolution()) * resolution() + 0.0;
  }
  double resolution() const {
    const double given = !angle_ ? c_.resolution * 1e3 : radians_ ? c_.resolution : c_.resolution / degree;
    return given > 0 ? given : !angle_ ? 1e-4 : radians_ ? 1e-7 : 1e-5;
  }
  /// Decimals that show a multiple of the resolution: 0.00025 has five.
  int decimals() const {
    const int least = std::max(0, static_cast<int>(std::ceil(-std::log10(resolution()) - 1e-9))), most = least + 3;
    for (int d = least; d < most; ++d) {
      const double scaled = resolution() * std::pow(10, d);
      if (std::fabs(scaled - std::round(scaled)) < 1e-6 * scaled) return d;
    }
    return most;
  }
  std::string number(double x) const { return fmt::format("{:.{}f}", x, decimals()); }
  static double read(const std::string& text) { return std::strtod(text.c_str(), nullptr); }
  std::string at(double si) const { return fmt::format("{:.6g} {}", position(si), unit()); }
  const char* unit() const { return angle_ ? "deg" : "mm"; }

  /// Both directions at every position; then the steps asked for.
  void make_points() {
    points_ = points_of(t_.rows);
    if (points_.size() < 2) refuse("a single position", "a table needs two", "");
    require_reference();
    known_ = points_;
    for (const Point& p : points_of(t_.between)) known_.push_back(p);
    std::ranges::stable_sort(known_, {}, &Point::x);
    const auto again = std::ranges::unique(known_, {}, &Point::x);
    known_.erase(again.begin(), again.end());
    if (c_.step > 0) resample();
  }

  std::vector<Point> points_of(const std::vector<CompensationRow>& rows) const {
    std::map<double, std::map<int, double>> known;
    for (const auto& row : rows) known[row.position][row.direction] = row.error;
    std::vector<Point> out;
    for (const auto& [x, errors] : known) {
      for (const int d : {1, -1})
        if (both() && !errors.contains(d))
          refuse(fmt::format("at {} nothing was measured {}", at(x), d > 0 ? "upwards" : "downwards"),
                 "the table needs both directions at every position", "use --format csv, or measure it");
      out.push_back({x, errors.begin()->second, errors.begin()->second});
      if (both()) out.back().up = errors.at(1), out.back().down = errors.at(-1);
    }
    return out;
  }

  void require_reference() const {
    const double low = points_.front().x, high = points_.back().x, slack = 1e-9 * (high - low);
    if (c_.at_reference && !(c_.reference >= low - slack && c_.reference <= high + slack))
      refuse(fmt::format("--reference: {} is outside the travel measured", at(c_.reference)),
             fmt::format("{} to {}", at(low), at(high)), "name a position within it");
  }

  /// As known; linear between positions that are known.
  Point between(double x) const {
    if (x <= known_.front().x) return {x, known_.front().up, known_.front().down};
    const auto next = std::ranges::lower_bound(known_, x, {}, &Point::x);
    if (next == known_.end()) return {x, known_.back().up, known_.back().down};
    const Point &a = *(next - 1), &b = *next;
    const double share = (x - a.x) / (b.x - a.x);
    return {x, a.up + share * (b.up - a.up), a.down + share * (b.down - a.down)};
  }

  void resample() {
    points_.clear();
    for (const double x : step_positions(t_, c_)) points_.push_back(between(x));
  }

  /// The distance between positions, all equal.
  double interval() const {
    const double step = (points_.back().x - points_.front().x) / static_cast<double>(points_.size() - 1);
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (std::fabs(points_[i].x - points_.front().x - static_cast<double>(i) * step) > 1e-6 * step)
        refuse("the positions are not equidistant", "this control's table has one interval",
               fmt::format("use --step \"{:.10g} {}\"", read(fmt::format("{:.1g}", position(step))), unit()));
    return step;
  }

  /// What the control's table holds at its reference point is zero.
  double at_reference(bool up) const {
    const Point p = between(c_.at_reference ? c_.reference : points_.front().x);
    return up ? p.up : p.down;
  }
  double mean_at_reference() const { return (at_reference(true) + at_reference(false)) / 2; }

  double largest_reversal() const {
    double most = 0;
    for (const Point& p : points_) most = std::max(most, std::fabs(p.up - p.down));
    return most;
  }
  double mean_reversal() const {
    double sum = 0;
    for (const Point& p : points_) sum += p.up - p.down;
    return sum / static_cast<double>(points_.size());
  }

  /// What u contains, and what it does not, in lines of comment.
  std::string declared() const {
    std::string out;
    for (const bool contained : {true, false}) {
      std::vector<std::string> names;
      for (const auto& d : t_.declared)
        if (d.contained == contained) names.push_back(d.name);
      if (!names.empty())
        out += fmt::format("# u {} the declared uncertainty of {}\n", contained ? "contains" : "does not contain",
                           fmt::join(names, ", "));
    }
    return out;
  }

  std::string csv() {
    const bool length = t_.indication_si_unit == "m";
    const char* const e = length ? "um" : "arcsec";
    const double factor = length ? 1e6 : 3600 / degree;
    std::string out =
        fmt::format("# error: actual minus commanded position; correction: commanded minus actual, what the "
                    "control adds to the command\n"
                    "# direction: from which the position was reached, 1 upwards, -1 downwards, 0 either; u: "
                    "standard uncertainty of the error\n"
                    "# between the positions linear; beyond them nothing is known\n"
                    "{}position_{},direction,error_{},correction_{},u_{}\n",
                    declared(), unit(), e, e, e);
    for (const auto& row : t_.rows) {
      const std::string error = fmt::format("{:.4f}", row.error * factor);
      out += fmt::format("{:.10g},{},{},{:.4f},{:.4f}\n", position(row.position), row.direction, error,
                         -row.error * factor + 0.0, row.u * factor);
      for (const auto& [curve, direction] : {std::pair(&applied_.up, 1), {&applied_.down, -1}})
        if (row.direction == 0 || row.direction == direction) curve->emplace_back(row.position, read(error) / factor);
    }
    return out;
  }

  /// Linear between rows, end values beyond. Type 0: actual positions; type 1: trims, added to the command.
  std::string linuxcnc(bool trims) {
    if (points_.size() > 256)
      refuse(fmt::format("{} rows", points_.size()), "LinuxCNC reads 256", "use a longer --step");
    std::string out; // no comments: reading ends at the first line that is not three numbers
    for (const Point& p : points_) {
      const std::string x = fmt::format("{:.6f}", position(p.x));
      out += x;
      for (const auto& [curve, si] : {std::pair(&applied_.up, p.up), {&applied_.down, p.down}}) {
        const std::string text = number(trims ? -error(si) + 0.0 : position(p.x) + error(si));
        curve->emplace_back(p.x, error_si(trims ? -read(text) : read(text) - read(x)));
        out += ' ' + text;
      }
      out += '\n';
    }
    return out;
  }

  using Curves = std::vector<AppliedTable::Curve*>;

  /// A line of each point: `place` of its number, and its error less `zero`, which applies in these directions.
  template <class Place, class Error>
  std::string values(const Place& place, const Error& of, double zero, const Curves& curves) {
    std::string out;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::string text = number(error(of(points_[i]) - zero));
      for (AppliedTable::Curve* curve : curves) curve->emplace_back(points_[i].x, error_si(read(text)) + zero);
      out += place(i) + '=' + text + '\n';
    }
    return out;
  }

  std::string eec() {
    const double step = interval(), zero = mean_at_reference();
    std::string out = fmt::format("%_N_{}_EEC_INI\nCHANDATA(1)\n; error (actual minus commanded), {}, zero at the "
                                  "reference; a positive value moves the axis in the negative direction\n",
                                  c_.axis, unit());
    if (both())
      out += fmt::format("; mean of both directions; upwards minus downwards is {} {} on average and {} at most: the "
                         "control's backlash compensation takes that\n",
                         number(error(mean_reversal())), unit(), number(error(largest_reversal())));
    out += "; load with MD32700 = 0, then set it to 1 and reference\n";
    out += values([&](std::size_t i) { return fmt::format("$AA_ENC_COMP[0,{},{}]", i, c_.axis); },
                  [](const Point& p) { return p.mean(); }, zero, {&applied_.up, &applied_.down});
    for (const auto& [name, x] : {std::pair("STEP", step), {"MIN", points_.front().x}, {"MAX", points_.back().x}})
      out += fmt::format("$AA_ENC_COMP_{}[0,{}]={:.6f}\n", name, c_.axis, position(x));
    return out + fmt::format("$AA_ENC_COMP_IS_MODULO[0,{}]=0\nM17\n", c_.axis);
  }

  std::string cec() {
    const double step = interval();
    std::string out = fmt::format("%_N_NC_CEC_INI\nCHANDATA(1)\n; error (actual minus commanded), {}, {}zero at the "
                                  "reference; the sign is that of the encoder table: prove it by one step\n",
                                  unit(), both() ? "a table for each direction; their mean is " : "");
    for (int table = 0; table < (both() ? 2 : 1); ++table) {
      const bool up = table == 0;
      const double zero = mean_at_reference();
      const std::string t = std::to_string(table);
      const Curves curves = !both() ? Curves{&applied_.up, &applied_.down} : Curves{up ? &applied_.up : &applied_.down};
      out += values([&](std::size_t i) { return fmt::format("$AN_CEC[{},{}]", t, i); },
                    [&](const Point& p) { return up ? p.up : p.down; }, zero, curves);
      out += fmt::format("$AN_CEC_INPUT_AXIS[{0}]=({1})\n$AN_CEC_OUTPUT_AXIS[{0}]=({1})\n", t, c_.axis);
      for (const auto& [name, x] : {std::pair("STEP", step), {"MIN", points_.front().x}, {"MAX", points_.back().x}})
        out += fmt::format("$AN_CEC_{}[{}]={:.6f}\n", name, t, position(x));
      out += fmt::format("$AN_CEC_DIRECTION[{0}]={1}\n$AN_CEC_MULT_BY_TABLE[{0}]=0\n$AN_CEC_IS_MODULO[{0}]=0\n", t,
                         !both() ? 0
                         : up    ? 1
                                 : -1);
    }
    return out + "M17\n";
  }

  std::string component() const { return fmt::format("E{0}{0}", c_.axis); }
  double signed_mean(const Point& p) const { return (c_.negate ? -1 : 1) * error(p.mean()) + 0.0; }
  std::string said() const {
    return fmt::format(
        "// {}, {} and {}{}{}\n", c_.negate ? "commanded minus actual (negated)" : "actual minus commanded",
        angle_ ? "deg" : "mm", angle_ ? "rad" : "mm",
        both() ? fmt::format("; mean of both directions, which differ by {} at most", number(error(largest_reversal())))
               : "",
        "; the sign is a setting of the machine: prove it by one step");
  }

  /// A line of each point, its position and its error `apart`.
  std::string grid(char apart) {
    std::string out;
    for (const Point& p : points_) {
      const std::string text = number(signed_mean(p));
      for (AppliedTable::Curve* curve : {&applied_.up, &applied_.down})
        curve->emplace_back(p.x, (c_.negate ? -1 : 1) * error_si(read(text)));
      out += fmt::format("{:.6f}{}{}\n", position(p.x), apart, text);
    }
    return out;
  }
  std::string isg() { return said() + fmt::format("{}\t{}\n", c_.axis, component()) + grid('\t'); }
  std::string etalon() { return said() + fmt::format("[{}]\nGridpoints = {{\n", component()) + grid(' ') + "}\n"; }

  const Compensation& t_;
  const CompensationChoice& c_;
  bool angle_, radians_;
  std::vector<Point> points_; ///< of the table
  std::vector<Point> known_;
  AppliedTable applied_;
};

} // namespace

const std::vector<CompensationFormat>& compensation_formats() {
  static constexpr const char* negated =
      "with 0.010 at one point the axis must move 0.010 in the positive direction there; else leave out --negate";
  static const std::vector<CompensationFormat> all{
      {"csv", "error, correction and u at every position and direction", "", {}},
      {"linuxcnc",
       "COMP_FILE_TYPE = 0: the actual positions, upwards and downwards",
       "with one row at 100 mm of 100.010 the joint must be commanded to 99.990",
       {"step", "resolution"}},
      {"linuxcnc-trim",
       "COMP_FILE_TYPE = 1: corrections, added to the command, upwards and downwards",
       "with one row at 100 mm of 0.010 the joint must be commanded to 100.010",
       {"step", "resolution"}},
      {"sinumerik-eec",
       "encoder errors of one axis: error, one table for both directions, equidistant",
       "with 0.010 at one point the axis must move 0.010 in the negative direction there",
       {"axis", "step", "reference", "resolution"}},
      {"sinumerik-cec",
       "sag tables of one axis: error, a table for each direction, equidistant",
       "with 0.010 at one point the axis must move 0.010 in the negative direction there; else change the sign",
       {"axis", "step", "reference", "resolution"}},
      {"isg",
       "volumetric table of ISG and Beckhoff: error E_XX of ISO 230-1, mean of both directions",
       "with 0.010 at one point the axis must move 0.010 in the negative direction there; else use --negate",
       {"axis", "step", "resolution", "negate"},
       negated},
      {"etalon",
       "exchange text of Etalon: error E_XX of ISO 230-1, mean of both directions",
       "with 0.010 at one point the axis must move 0.010 in the negative direction there; else use --negate",
       {"axis", "step", "resolution", "negate"},
       negated}};
  return all;
}

std::vector<double> step_positions(const Compensation& table, const CompensationChoice& choice) {
  if (!(choice.step > 0)) return {};
  const double first = table.rows.front().position, end = table.rows.back().position;
  const double steps = (end - first) / choice.step;
  if (steps < 1 - 1e-9) refuse("the step is longer than the travel measured", "", "use a shorter --step");
  if (!(steps < most_points))
    refuse(fmt::format("--step: {:.3g} points", std::ceil(steps) + 1),
           fmt::format("a table has at most {}", most_points), "use a longer --step");
  std::vector<double> out;
  for (std::size_t i = 0, last = static_cast<std::size_t>(std::ceil(steps - 1e-9)); i <= last; ++i)
    out.push_back(first + static_cast<double>(i) * choice.step);
  if (!equidistant(choice)) out.back() = end;
  return out;
}

CompensationFile compensation_file(const Compensation& table, const CompensationChoice& choice) {
  return Writer(table, choice).write();
}

} // namespace gumshoe::calibration
