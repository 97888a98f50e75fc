#include "tracing/candidates/courses.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

#include "base/units.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

constexpr Index at_once = 64;

/// "38 min"
std::string shown(const Covariate& c, double si) {
  return fmt::format("{:.2g}{}", units::from_si(si, c.unit, c.si_unit, units::Kind::difference), units::suffix(c.unit));
}

/// All readings, or those of one part.
struct Members {
  const Grouping* label = nullptr; ///< null: all readings
  std::size_t group = 0;
  bool holds(std::size_t reading) const { return !label || label->group[reading] == group; }
};

/// From this place in the sequence on, of all readings or those of one part; or up to another place, which it is
/// without.
struct Instant {
  Index from = 0;
  Members part = {};
  Index until = std::numeric_limits<Index>::max();
  /// A reading is of one part of a label.
  bool operator==(const Instant& other) const { return from == other.from && part.label == other.part.label; }
};

/// The step between two successive readings of one indication, or two that cancel.
class Steps {
public:
  Steps(const Observations& o, std::size_t indication) : o_(o), indication_(index(indication)) {}

  Matrix columns(std::span<const Instant> instants) const {
    const Index n = index(o_.readings), k = index(o_.indications);
    Matrix out = Matrix::Zero(n * k, index(instants.size()));
    for (Index j = 0; j < out.cols(); ++j) {
      const auto& [from, part, until] = instants[static_cast<std::size_t>(j)];
      for (Index r = from; r < std::min(n, until); ++r)
        if (part.holds(o_.sequence[index(r)])) out(r * k + indication_, j) = 1;
    }
    return out;
  }

  /// The one that explains most.
  Instant best(const std::vector<Instant>& places, const Gain& gain) const {
    Instant found = places.front();
    double height = -1;
    for (std::size_t i = 0; i < places.size(); i += at_once) {
      const auto some = std::span(places).subspan(i, std::min<std::size_t>(at_once, places.size() - i));
      Index highest = 0;
      const double here = gain(columns(some), 1, criteria.absorbed_share).maxCoeff(&highest);
      if (here > height) height = here, found = some[static_cast<std::size_t>(highest)];
    }
    return found;
  }

private:
  const Observations& o_;
  Index indication_;
};

/// Places of the fitted readings in the sequence, of all or of one part.
std::vector<Index> fitted_places(const Observations& o, const std::vector<Index>& rows, const Members& part) {
  std::vector<Index> out;
  for (const Index row : rows)
    if (const Index place = row / index(o.indications);
        part.holds(o.sequence[index(place)]) && (out.empty() || out.back() != place))
      out.push_back(place);
  return out;
}

/// Places in the sequence where a step may begin, with a few fitted readings before and after; of a part, whose
/// readings seldom follow one another, with two of its own.
std::vector<Instant> instants(const Observations& o, const std::vector<Index>& rows, const Members& part = {}) {
  const std::vector<Index> fitted = fitted_places(o, rows, part);
  const std::size_t few = part.label ? criteria.least_repeats : static_cast<std::size_t>(criteria.few_readings) + 1;
  std::vector<Instant> out;
  for (std::size_t i = few; i + few <= fitted.size(); ++i) out.push_back({fitted[i], part});
  return out;
}

/// The same for every part in turn: one tool was hit, one artefact slipped.
std::vector<Instant> instants_of_parts(const Observations& o, const std::vector<Index>& rows, const Grouping& label) {
  std::vector<Instant> out;
  for (std::size_t g = 0; g < label.groups.size(); ++g)
    std::ranges::copy(instants(o, rows, {&label, g}), std::back_inserter(out));
  return out;
}

/// Those at which a block begins.
std::vector<Instant> beginnings_of_blocks(const Observations& o, const std::vector<Instant>& places) {
  std::vector<Instant> out;
  for (const Instant& at : places)
    if (!o.blocks.group.empty() &&
        o.blocks.group[o.sequence[index(at.from)]] != o.blocks.group[o.sequence[index(at.from - 1)]])
      out.push_back(at);
  return out;
}

/// What one part of a label may have been for a while: it was changed, or moved, and put back. Stretches of its fitted
/// readings, at least two, with one before and one after; where there are blocks they begin and end between blocks.
class Whiles {
public:
  Whiles(const Observations& o, const std::vector<Index>& rows, const Grouping& label) {
    for (std::size_t g = 0; g < label.groups.size(); ++g) {
      ends_.push_back({{&label, g}, {}});
      const std::vector<Index> places = fitted_places(o, rows, ends_.back().part);
      const auto block = [&](std::size_t i) { return o.blocks.group[o.sequence[index(places[i])]]; };
      for (std::size_t i = 1; i < places.size(); ++i)
        if (o.blocks.group.empty() || block(i) != block(i - 1)) ends_.back().at.push_back({i, places[i]});
    }
  }

  /// All there are, of which the best counts as the best of so many.
  std::size_t number() const {
    std::size_t out = 0;
    for (const Ends& e : ends_)
      for (std::size_t i = 0; i < e.at.size(); ++i)
        for (std::size_t j = i + 1; j < e.at.size(); ++j) out += e.is_one(i, j);
    return out;
  }

  /// The one that explains most: of a grid of ends, then of all near its ends, one end after the other.
  std::optional<Instant> best(const Steps& steps, const Gain& gain) const {
    std::vector<Instant> grid;
    for (const Ends& e : ends_)
      for (std::size_t i = 0; i < e.at.size(); i += e.stride())
        for (std::size_t j = i + e.stride(); j < e.at.size(); j += e.stride())
          if (e.is_one(i, j)) grid.push_back(e.between(i, j));
    if (grid.empty()) return std::nullopt;
    Instant found = steps.best(grid, gain);
    const Ends& own = ends_[found.part.group];
    for (int pass = 0; own.stride() > 1 && pass < 2; ++pass) {
      found = steps.best(own.near(found, own.stride(), 0), gain);
      found = steps.best(own.near(found, 0, own.stride()), gain);
    }
    return found;
  }

private:
  struct End {
    std::size_t before; ///< fitted readings of the part before it
    Index place;
  };
  /// Those of one part.
  struct Ends {
    Members part;
    std::vector<End> at;

    std::size_t stride() const {
      return std::max<std::size_t>(1, (at.size() + criteria.most_ends - 1) / criteria.most_ends);
    }
    bool is_one(std::size_t i, std::size_t j) const { return at[j].before - at[i].before >= criteria.least_repeats; }
    Instant between(std::size_t i, std::size_t j) const { return {at[i].place, part, at[j].place}; }

    /// Those whose ends lie so near to this one's, itself among them.
    std::vector<Instant> near(const Instant& one, std::size_t from, std::size_t until) const {
      const auto around = [&](Index place, std::size_t reach) {
        const auto i = static_cast<std::size_t>(std::ranges::find(at, place, &End::place) - at.begin());
        return std::pair(i - std::min(i, reach), std::min(i + reach, at.size() - 1));
      };
      const auto [first, last] = around(one.from, from);
      const auto [least, most] = around(one.until, until);
      std::vector<Instant> out;
      for (std::size_t i = first; i <= last; ++i)
        for (std::size_t j = std::max(least, i + 1); j <= most; ++j)
          if (is_one(i, j)) out.push_back(between(i, j));
      return out;
    }
  };

  std::vector<Ends> ends_;
};

/// The last reading of a part before a place, counted from 1.
std::size_t last_before(const Observations& o, Index place, const Members& part) {
  while (!part.holds(o.sequence[index(--place)]))
    ;
  return o.sequence[index(place)] + 1;
}

/// Time since the first reading, over the range, in the order of measurement.
Vector since_the_first(const Observations& o, const Covariate& c) {
  Vector out(index(o.readings));
  for (std::size_t i = 0; i < o.readings; ++i)
    out[index(i)] = (c.value[o.sequence[i]] - c.levels.front()) / (c.levels.back() - c.levels.front());
  return out;
}

double bell(double z) { return std::exp(-0.5 * z * z); }
/// The integral of a bell, from 0 to 1.
double gradual(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// A form in (t - middle) / width of one indication: a bell, or a gradual step.
class Placed {
public:
  struct Form {
    double middle, width; ///< over the range
  };

  Placed(const Observations& o, const Covariate& c, std::size_t indication, double (*form)(double))
      : o_(o), every_(index(o.indications)), indication_(index(indication)), t_(since_the_first(o, c)), form_(form) {}

  /// The reading nearest to its middle.
  std::size_t nearest(const Form& form) const {
    Index at = 0;
    (t_.array() - form.middle).abs().minCoeff(&at);
    return o_.sequence[static_cast<std::size_t>(at)];
  }

  Matrix columns(std::span<const Form> forms) const {
    Matrix out = Matrix::Zero(t_.size() * every_, index(forms.size()));
    for (Index j = 0; j < out.cols(); ++j) {
      const auto [middle, width] = forms[static_cast<std::size_t>(j)];
      out(Eigen::seq(indication_, Eigen::last, every_), j) = ((t_.array() - middle) / width).unaryExpr(form_);
    }
    return out;
  }

  /// The one that explains most: of a grid, then by Brent's method in one after the other. None is shorter than a few
  /// readings, or so long that it is a bend. Without a value: there is no such one.
  std::optional<Form> best(const Gain& gain) const {
    const double least = 2 / static_cast<double>(t_.size() - 1);
    std::vector<Form> grid;
    for (double width = least; width <= longest; width *= ratio)
      for (double middle = 0; middle <= 1; middle += step * width) grid.push_back({middle, width});
    std::optional<Form> found;
    double height = 0;
    for (std::size_t i = 0; i < grid.size(); i += at_once) {
      const auto some = std::span(grid).subspan(i, std::min<std::size_t>(at_once, grid.size() - i));
      Index highest = 0;
      const double here = gain(columns(some), 1, criteria.own_wave).maxCoeff(&highest);
      if (here > height) height = here, found = some[static_cast<std::size_t>(highest)];
    }
    if (!found) return found;
    const auto improve = [&](double& x, double low, double high) {
      const double before = x;
      const auto loss = [&](double at) {
        x = at;
        return -gain(columns({&*found, 1}), 1, criteria.own_wave)[0];
      };
      constexpr int bits = 12;
      const auto [at, least_loss] = boost::math::tools::brent_find_minima(loss, low, high, bits);
      x = -least_loss > height ? at : before;
      height = std::max(height, -least_loss);
    };
    for (int pass = 0; pass < 2; ++pass) {
      const double w = found->width, m = found->middle;
      improve(found->middle, std::max(0.0, m - step * w), std::min(1.0, m + step * w));
      improve(found->width, std::max(least, w / ratio), std::min(longest, w * ratio));
    }
    return found;
  }

private:
  static constexpr double longest = 1.0 / 6, ratio = 1.5, step = 0.5;
  const Observations& o_;
  Index every_, indication_;
  Vector t_;
  double (*form_)(double);
};

/// 1 - exp(-t / tau) of one indication, t being the time since the first reading.
class Drifts {
public:
  Drifts(const Observations& o, const Covariate& c, std::size_t indication)
      : range_(c.levels.back() - c.levels.front()), every_(index(o.indications)), indication_(index(indication)),
        t_(since_the_first(o, c)) {}

  /// @param shares  time constants over the range
  Matrix columns(const std::vector<double>& shares) const {
    Matrix out = Matrix::Zero(t_.size() * every_, index(shares.size()));
    for (Index j = 0; j < out.cols(); ++j)
      out(Eigen::seq(indication_, Eigen::last, every_), j) =
          1 - (-t_.array() / shares[static_cast<std::size_t>(j)]).exp();
    return out;
  }

  /// Share of the best of a grid, then by Brent's method about it.
  double best(const Gain& gain) const {
    const double low = std::log(std::max(criteria.shortest,
                                         static_cast<double>(criteria.few_readings) / static_cast<double>(t_.size()))),
                 step = (std::log(criteria.longest) - low) / grid;
    std::vector<double> shares;
    for (int i = 0; i <= grid; ++i) shares.push_back(std::exp(low + step * i));
    Index at = 0;
    gain(columns(shares), 1, criteria.absorbed_share).maxCoeff(&at);
    const auto loss = [&](double x) { return -gain(columns({std::exp(x)}), 1, criteria.absorbed_share)[0]; };
    const double middle = low + step * static_cast<double>(at);
    constexpr int bits = 12;
    return std::exp(boost::math::tools::brent_find_minima(loss, std::max(low, middle - step),
                                                          std::min(low + step * grid, middle + step), bits)
                        .first);
  }

  double range() const { return range_; }

private:
  static constexpr int grid = 8;
  double range_;
  Index every_, indication_;
  Vector t_;
};

Candidate shape(const Observations& o, const Covariate& c, std::size_t indication, const std::string& name,
                Matrix column) {
  Candidate a;
  a.family = Family::shape;
  a.name = name + (o.indications > 1 ? " of " + o.names[indication] : "");
  a.columns = std::move(column);
  a.amplitudes.resize(1);
  a.amplitudes[0].quantity = Amplitude::npos;
  a.amplitudes[0].name = "size";
  a.depends_on = {c.name};
  return a;
}

} // namespace

Candidate drift(const Observations& o, const Covariate& c, std::size_t indication, double logarithm) {
  const Drifts drifts(o, c, indication);
  const double share = std::exp(logarithm);
  Candidate out = shape(o, c, indication, "drift:" + c.name, drifts.columns({share}));
  out.shape = fmt::format("saturating, time constant {}", shown(c, share * drifts.range()));
  out.form = Form::drift;
  out.parameter = logarithm;
  return out;
}

std::vector<Candidate> courses(const Observations& o, const std::vector<Index>& rows, const Gain& gain) {
  std::vector<Candidate> out;
  const std::vector<Instant> places = instants(o, rows);
  for (const Covariate& c : o.covariates)
    for (std::size_t i = 0; c.course && !places.empty() && i < o.indications; ++i) {
      const double share = Drifts(o, c, i).best(gain);
      out.push_back(drift(o, c, i, std::log(share)));
      out.back().searched = criteria.drift_forms;
      if (c.comes_back) continue; // what happened at one instant, happened once
      const Steps steps(o, i);
      const auto add = [&](const std::string& name, const Instant& at, std::size_t among) {
        out.push_back(shape(o, c, i, name, steps.columns({&at, 1})));
        out.back().searched = static_cast<double>(among);
      };
      const auto step = [&](const Instant& at, const std::string& of, std::size_t among) {
        add(fmt::format("step:{}{} after reading {}", c.name, of, last_before(o, at.from, at.part)), at, among);
      };
      const auto of_part = [&](const Grouping& label, std::size_t group) {
        out.back().depends_on.push_back(label.name);
        out.back().amplitudes[0].labels = {{label.name, label.values[group][0]}};
      };
      const Instant from = steps.best(places, gain);
      step(from, "", places.size());
      // One that begins with a block may be what differs there (shape_order.h).
      if (const std::vector<Instant> beginnings = beginnings_of_blocks(o, places); !beginnings.empty())
        if (const Instant beginning = steps.best(beginnings, gain); !(beginning == from))
          step(beginning, "", places.size());
      for (const Grouping* label : part_labels(o)) {
        const std::vector<Instant> of_parts = instants_of_parts(o, rows, *label);
        if (of_parts.empty()) continue;
        const Instant at = steps.best(of_parts, gain);
        step(at, " with " + label->groups[at.part.group], of_parts.size());
        of_part(*label, at.part.group);
        const Whiles whiles(o, rows, *label);
        if (const auto a_while = whiles.best(steps, gain)) {
          const auto& [from, part, until] = *a_while;
          add(fmt::format("while:{} with {} from reading {} to reading {}", c.name, label->groups[part.group],
                          o.sequence[index(from)] + 1, last_before(o, until, part)),
              *a_while, whiles.number());
          of_part(*label, part.group);
        }
      }
      const double range = c.levels.back() - c.levels.front();
      const auto place = [&](const char* kind, double (*profile)(double), double length_of_width) {
        const Placed all(o, c, i, profile);
        const auto form = all.best(gain);
        if (!form) return;
        out.push_back(shape(o, c, i, fmt::format("{}:{} about reading {}", kind, c.name, all.nearest(*form) + 1),
                            all.columns({&*form, 1})));
        out.back().shape = "length " + shown(c, length_of_width * form->width * range);
        out.back().searched = static_cast<double>(places.size());
      };
      place("pulse", bell, 2.3548);    // at half of its height: 2 sqrt(2 ln 2)
      place("shift", gradual, 2.5631); // from a tenth of it to nine: twice the 0.9 quantile
    }
  return out;
}

} // namespace gumshoe::tracing
