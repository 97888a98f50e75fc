#include "calibration/compensation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "calibration/compensation_uncertainty.h"
#include "effects/effect.h"
#include "quantities/effect_of.h"

namespace gumshoe::calibration {

std::string whole_of(const std::string& name) {
  const auto without_number = [](const std::string& text) {
    const std::size_t end = text.find_last_not_of("0123456789");
    const bool numbered = end != std::string::npos && end > 0 && end + 1 < text.size() && text[end] == '_';
    return numbered ? text.substr(0, end) : text;
  };
  const std::string whole = without_number(name);
  return without_number(whole) == whole ? name : whole;
}

namespace {

using propagation::Experiment;
using propagation::Points;
using Key = std::pair<double, int>; ///< position, direction

/// Sizes that stand or fall together: those of one effect, or a quantity of the model.
struct Source {
  std::string name;
  std::vector<std::pair<std::size_t, double>> nulls; ///< quantity, and the value at which it changes nothing
};

bool is_size(const QuantityCard& card) { return card.role == Role::amplitude || card.role == Role::pair; }

class Composer {
public:
  Composer(const Experiment& e, const CompensationRequest& r)
      : e_(e), s_(e.scenario()), request_(r), card_(*e.model().card), at_(e.estimates()) {}

  Compensation compose() {
    find_conditions();
    make_cells();
    const std::vector<double> whole = indications(at_);
    std::vector<Source> kept;
    Points without = at_, base = at_;
    for (const Source& source : sources()) {
      Points less = at_;
      set_null(source, less);
      const std::vector<double> change = minus(whole, indications(less));
      if (std::ranges::all_of(change, [](double x) { return x == 0; })) continue;
      if (!request_.only.empty() && std::ranges::find(request_.only, source.name) == request_.only.end()) continue;
      set_null(source, base);
      if (const std::string why = why_not(source, change); !why.empty()) {
        out_.left_out.push_back({source.name, why});
        continue;
      }
      set_null(source, without);
      kept.push_back(source);
      out_.holds.push_back(source.name);
    }
    name_set_up(whole);
    if (kept.empty() && request_.only.empty()) refuse_nothing();
    const std::vector<double> held = minus(whole, indications(without));
    gather_deviations(whole, minus(whole, indications(base)));
    add_rows(held, kept, without);
    if (request_.only.empty()) join_directions();
    out_.coarse = coarse();
    return std::move(out_);
  }

private:
  [[noreturn]] void refuse(const std::string& what, const std::string& why, const std::string& remedy) const {
    throw InputError(s_.file + ": " + what, why, remedy);
  }

  /// A control corrects lengths and angles along lengths and angles.
  static bool corrected(std::string_view si_unit) { return si_unit == "m" || si_unit == "rad"; }
  void require_corrected(const VariableCard& c, const std::string& remedy) const {
    if (!corrected(c.si_unit))
      refuse(fmt::format("'{}' is {}, no length and no angle", c.name, units::kind_name(std::string(c.si_unit))),
             "a control corrects lengths and angles along lengths and angles", remedy);
  }

  [[noreturn]] void refuse_nothing() const {
    const auto& left = out_.left_out;
    refuse("nothing to compensate",
           left.empty()       ? "no effect has a size"
           : left.size() == 1 ? fmt::format("{} {}", left[0].name, left[0].why)
                              : fmt::format("{} {}, and {} more", left[0].name, left[0].why, left.size() - 1),
           "use the scenario that gumshoe trace or gumshoe estimate wrote, or name the quantities of the model that "
           "count, such as a gain: --with gain");
  }

  std::size_t condition(const std::string& name) const {
    std::vector<std::string> names;
    for (std::size_t c = 0; c < card_.conditions.size(); ++c) {
      if (card_.conditions[c].name == name) return c;
      names.emplace_back(card_.conditions[c].name);
    }
    refuse(fmt::format("'{}' is not a condition", name), "", fmt::format("use one of {}", fmt::join(names, ", ")));
  }

  std::set<double> values_of(std::size_t c) const {
    std::set<double> out;
    for (const auto& r : s_.readings) out.insert(r.conditions[c]);
    return out;
  }

  void find_conditions() {
    const auto& indications = card_.indications;
    while (indication_ < indications.size() && indications[indication_].name != request_.indication &&
           !(request_.indication.empty() && indications.size() == 1))
      ++indication_;
    if (indication_ == indications.size()) {
      std::vector<std::string> names;
      for (const auto& i : indications) names.emplace_back(i.name);
      if (names.empty())
        refuse("the model has no indication", "what a control corrects is an error of indications",
               "use the scenario of readings that gumshoe trace or gumshoe estimate wrote");
      refuse(request_.indication.empty() ? "there are several indications"
                                         : fmt::format("'{}' is not an indication", request_.indication),
             "", fmt::format("use --indication with one of {}", fmt::join(names, ", ")));
    }
    std::vector<std::size_t> positions;
    std::vector<std::string> names;
    for (std::size_t c = 0; c < card_.conditions.size(); ++c) {
      const std::string_view unit = card_.conditions[c].si_unit;
      if (request_.direction.empty() && card_.conditions[c].name == "direction" && values_of(c).size() > 1)
        direction_ = c;
      if (!corrected(unit) || values_of(c).size() < 2) continue;
      positions.push_back(c);
      names.emplace_back(card_.conditions[c].name);
    }
    if (!request_.direction.empty()) direction_ = condition(request_.direction);
    if (!request_.position.empty())
      position_ = condition(request_.position);
    else if (positions.size() == 1)
      position_ = positions[0];
    else
      refuse(positions.empty() ? "no length or angle is set to several values"
                               : "several conditions may be the position",
             "", positions.empty() ? "" : fmt::format("use --position with one of {}", fmt::join(names, ", ")));
    const std::string other = "use gumshoe run --predict, which says what to expect of readings";
    require_corrected(card_.conditions[position_],
                      names.empty() ? other : fmt::format("use --position with one of {}", fmt::join(names, ", ")));
    require_corrected(indications[indication_], other);
    out_.position = card_.conditions[position_].name;
    out_.position_si_unit = card_.conditions[position_].si_unit;
    out_.indication = indications[indication_].name;
    out_.indication_si_unit = indications[indication_].si_unit;
    if (direction_ != none) out_.direction = card_.conditions[direction_].name;
  }

  Key key_of(std::size_t reading) const {
    const auto& c = s_.readings[reading].conditions;
    return {c[position_], direction_ == none ? 0 : (c[direction_] > 0) - (c[direction_] < 0)};
  }
  void make_cells() {
    for (std::size_t r = 0; r < s_.readings.size(); ++r) cells_[key_of(r)].push_back(r);
  }

  /// Effects of the catalogue and stated ones by effect, then the quantities asked for.
  std::vector<Source> sources() const {
    std::vector<Source> out;
    std::set<std::string> met, names;
    const auto left_out = [&](const std::string& name) {
      const std::string whole = whole_of(name);
      names.insert(whole);
      const auto one = std::ranges::find_if(request_.without, [&](const auto& w) { return w == name || w == whole; });
      if (one == request_.without.end()) return false;
      met.insert(*one);
      return true;
    };
    for (const effects::Active& active : e_.forward().active()) {
      const EffectCard& effect = *effects::cards()[active.effect];
      Source one{std::string(effect.name), {}};
      for (std::size_t i = 0; i < effect.quantities.size(); ++i)
        if (is_size(effect.quantities[i]))
          one.nulls.emplace_back(e_.layout().effects[active.first + i], effect.quantities[i].default_value);
      if (!left_out(one.name)) out.push_back(std::move(one));
    }
    const propagation::Range sizes = e_.layout().sizes;
    for (std::size_t q = sizes.begin; q < sizes.end; ++q) {
      const std::string name = quantities::effect_of(s_.quantities[q].name);
      if (!left_out(name)) out.push_back({name, {{q, 0}}});
    }
    for (const std::string& name : request_.without)
      if (!met.contains(name))
        refuse(fmt::format("'{}' is not an effect that is compensated", name), "",
               names.empty() ? "leave out --without" : fmt::format("use one of {}", fmt::join(names, ", ")));
    for (const std::string& name : request_.with) {
      const auto known = std::ranges::find(card_.quantities, name, [](const auto& q) { return std::string(q.name); });
      if (known == card_.quantities.end())
        refuse(fmt::format("'{}' is not a quantity of the model", name), "", "gumshoe models lists them");
      out.push_back({name, {{static_cast<std::size_t>(known - card_.quantities.begin()), 0}}});
    }
    return out;
  }

  /// Quantities of the model, such as a gain, of which the caller did not speak: that these data gave, or that shift
  /// the readings from what they are at zero.
  void name_set_up(const std::vector<double>& whole) {
    for (std::size_t q = 0; q < card_.quantities.size(); ++q) {
      const std::string name(card_.quantities[q].name);
      if (std::ranges::find(request_.with, name) != request_.with.end()) continue;
      const bool known = s_.quantities[q].estimated || std::ranges::find(s_.trace.free, name) != s_.trace.free.end();
      if (!known && !shifts(q, whole)) continue;
      out_.set_up.push_back(name);
      out_.left_out.push_back(
          {name, "is a quantity of the model and may be the set-up's (--with " + name + " adds it)"});
    }
  }

  /// Whether a quantity that is zero unless it is stated moves a reading by its value.
  bool shifts(std::size_t q, const std::vector<double>& whole) const {
    if (card_.quantities[q].default_value != 0 || at_[0][q] == 0) return false;
    Points less = at_;
    set_null({"", {{q, 0}}}, less);
    return indications(less) != whole;
  }

  static void set_null(const Source& source, Points& at) {
    for (auto& point : at)
      for (const auto& [q, value] : source.nulls) point[q] = value;
  }

  std::vector<double> indications(const Points& at) const {
    const propagation::Responses f = e_.forward().indications(at);
    if (!f.ok()) refuse("the model has no value at a reading", "", "gumshoe check");
    std::vector<double> out;
    for (std::size_t r = 0; r < s_.readings.size(); ++r)
      out.push_back(f.at(0, r * card_.indications.size() + indication_));
    return out;
  }

  static std::vector<double> minus(std::vector<double> a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
    return a;
  }

  /// Why a change is no function of position and direction; empty if it is.
  std::string why_not(const Source& source, const std::vector<double>& change) const {
    double most = 0, low = change[0], high = change[0];
    for (const double x : change) low = std::min(low, x), high = std::max(high, x);
    for (const auto& [key, readings] : cells_)
      for (const std::size_t r : readings) most = std::max(most, std::fabs(change[r] - change[readings[0]]));
    if (most > same * std::max(std::fabs(low), std::fabs(high)))
      return "also depends on something else than the position";
    const auto unconfirmed = std::ranges::find(s_.trace.unconfirmed, source.name);
    return unconfirmed == s_.trace.unconfirmed.end() ? ""
                                                     : "could neither be confirmed nor rejected by held-out readings";
  }

  void add_rows(const std::vector<double>& change, const std::vector<Source>& kept, const Points& without) {
    std::vector<std::size_t> sizes;
    for (const Source& source : kept)
      for (const auto& [q, null] : source.nulls) sizes.push_back(q);
    // Between readings u only tells whether the errors' shape is chance, to which what all of them share adds nothing.
    ErrorUncertainty uncertainty(e_, indication_, at_, without, sizes, request_.only.empty());
    for (const auto& [key, readings] : cells_) {
      double error = 0;
      for (const std::size_t r : readings) error += change[r];
      const auto [u, u_of_sizes] = uncertainty.of_mean(readings);
      out_.rows.push_back({key.first, key.second, error / static_cast<double>(readings.size()), u, u_of_sizes});
    }
    out_.declared = uncertainty.declared();
    std::ranges::stable_sort(out_.rows, [](const auto& a, const auto& b) {
      return std::pair(a.position, -a.direction) < std::pair(b.position, -b.direction);
    });
  }

  /// @param whole  what the scenario expects  @param all  of that what effects and the quantities asked for give
  void gather_deviations(const std::vector<double>& whole, const std::vector<double>& all) {
    const auto gather = [&](const std::string& which, const auto& counts) {
      Compensation::Group group{which, {}};
      for (std::size_t r = 0; r < s_.readings.size(); ++r) {
        const quantities::Reading& reading = s_.readings[r];
        if (reading.indications.empty() || !counts(reading)) continue;
        const double rest = reading.indications[indication_] - whole[r];
        const auto [position, direction] = key_of(r);
        group.readings.push_back({position, direction, rest + all[r], rest, static_cast<double>(reading.repeats)});
      }
      if (!group.readings.empty()) out_.groups.push_back(std::move(group));
    };
    gather("these readings", [](const auto&) { return true; });
    const auto& final = s_.trace.final_blocks;
    if (final.empty()) return;
    gather(fmt::format("held-out readings ({} {})", s_.trace.blocks, fmt::join(final, ", ")), [&](const auto& reading) {
      const auto label = std::ranges::find(reading.labels, s_.trace.blocks, [](const auto& l) { return l.first; });
      return label != reading.labels.end() && std::ranges::find(final, label->second) != final.end();
    });
  }

  /// One row for both directions, where they agree at every position.
  void join_directions() {
    if (direction_ == none) return;
    std::map<double, std::vector<const CompensationRow*>> at;
    double most = 0, difference = 0;
    for (const auto& row : out_.rows) {
      at[row.position].push_back(&row);
      most = std::max(most, std::fabs(row.error));
    }
    for (const auto& [x, rows] : at)
      for (const auto* row : rows) difference = std::max(difference, std::fabs(row->error - rows[0]->error));
    if (difference > same * most) return;
    std::vector<CompensationRow> joined;
    for (const auto& [x, rows] : at) {
      joined.push_back(*rows[0]);
      joined.back().direction = 0;
    }
    out_.rows = std::move(joined);
    out_.direction.clear();
  }

  /// Whether the straight line between two neighbours misses the error at the position between them by as much as half
  /// of what the errors vary, and by more than these are uncertain.
  bool coarse() const {
    std::map<int, std::vector<const CompensationRow*>> by_direction;
    for (const CompensationRow& row : out_.rows) by_direction[row.direction].push_back(&row);
    double missed = 0, varied = 0, uncertain = 0;
    std::size_t n = 0;
    for (const auto& [direction, rows] : by_direction) {
      double mean = 0;
      for (const auto* row : rows) mean += row->error / static_cast<double>(rows.size());
      for (std::size_t i = 1; i + 1 < rows.size(); ++i, ++n) {
        const CompensationRow &a = *rows[i - 1], &b = *rows[i + 1], &at = *rows[i];
        const double share = (at.position - a.position) / (b.position - a.position);
        const double line = a.error + share * (b.error - a.error);
        missed += (at.error - line) * (at.error - line);
        varied += (at.error - mean) * (at.error - mean);
        uncertain += at.u_of_sizes * at.u_of_sizes;
      }
    }
    return n >= least_between && missed > 0.25 * varied && missed > 9 * uncertain;
  }

  static constexpr std::size_t least_between = 3; ///< positions between others: fewer say little
  static constexpr std::size_t none = ~std::size_t{0};
  static constexpr double same = 1e-6; ///< share of the largest error that is no difference
  const Experiment& e_;
  const scenario::Scenario& s_;
  const CompensationRequest& request_;
  const ModelCard& card_;
  Points at_;
  std::size_t indication_ = 0, position_ = none, direction_ = none;
  std::map<Key, std::vector<std::size_t>> cells_;
  Compensation out_;
};

} // namespace

Compensation compensation(const Experiment& experiment, const CompensationRequest& request) {
  return Composer(experiment, request).compose();
}

} // namespace gumshoe::calibration
