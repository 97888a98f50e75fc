#include "tracing/candidates/courses.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

#include "base/units.h"
#include "tracing/candidates/smooth_basis.h"
#include "tracing/candidates/steps.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// "38 min"
std::string shown(const Covariate& c, double si) {
  return fmt::format("{:.2g}{}", units::from_si(si, c.unit, c.si_unit, units::Kind::difference), units::suffix(c.unit));
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
      : o_(o), every_(index(o.indications)), indication_(index(indication)), t_(over_the_range(o, c)), form_(form) {}

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
        t_(over_the_range(o, c)) {}

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
  const std::vector<Stretch> places = steps(o, rows);
  for (const Covariate& c : o.covariates)
    for (std::size_t i = 0; c.course && !places.empty() && i < o.indications; ++i) {
      const double share = Drifts(o, c, i).best(gain);
      out.push_back(drift(o, c, i, std::log(share)));
      out.back().searched = criteria.drift_forms;
      if (c.comes_back) continue; // what happened at one instant, happened once
      const Steps columns(o, i), bends(o, i, over_the_range(o, c));
      const auto add = [&](const std::string& name, const Steps& of, const Stretch& at, std::size_t among) {
        out.push_back(shape(o, c, i, name, of.columns({&at, 1})));
        out.back().searched = static_cast<double>(among);
        if (!at.part.label) return;
        const Grouping& label = *at.part.label;
        out.back().depends_on.push_back(label.name);
        out.back().amplitudes[0].labels = {{label.name, label.values[at.part.group][0]}};
      };
      const auto of = [](const Members& part) {
        return part.label ? " with " + part.label->groups[part.group] : std::string();
      };
      const auto step = [&](const Stretch& at, std::size_t among) {
        add(fmt::format("step:{}{} after reading {}", c.name, of(at.part), last_before(o, at.from, at.part)), columns,
            at, among);
      };
      const auto bend = [&](const std::vector<Stretch>& some) {
        const Stretch at = bends.best(some, gain);
        add(fmt::format("bend:{}{} after reading {}", c.name, of(at.part), last_before(o, at.from, at.part)), bends, at,
            some.size());
      };
      const auto a_while = [&](const Grouping* label) {
        const Whiles whiles(o, rows, label);
        if (const auto at = whiles.best(columns, gain))
          add(fmt::format("while:{}{} from reading {} to reading {}", c.name, of(at->part),
                          o.sequence[index(at->from)] + 1, last_before(o, at->until, at->part)),
              columns, *at, whiles.number());
      };
      const Stretch from = columns.best(places, gain);
      step(from, places.size());
      // One that begins with a block may be what differs there (shape_order.h).
      if (const std::vector<Stretch> beginnings = at_beginnings_of_blocks(o, places); !beginnings.empty())
        if (const Stretch beginning = columns.best(beginnings, gain); beginning.from != from.from)
          step(beginning, places.size());
      bend(places);
      a_while(nullptr);
      for (const Grouping* label : part_labels(o)) {
        const std::vector<Stretch> of_parts = steps_of_parts(o, rows, *label);
        if (of_parts.empty()) continue;
        step(columns.best(of_parts, gain), of_parts.size());
        bend(of_parts);
        a_while(label);
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
