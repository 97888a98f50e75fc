/// The size of what is not in the catalogue, as a curve.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include <Eigen/QR>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/rounding.h"
#include "base/units.h"
#include "math/senses.h"
#include "quantities/cells.h"
#include "tracing/criteria.h"
#include "tracing/findings/period.h"
#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {
namespace {

/// The indication that a term moves, by more than rounding: the last, if it moves several.
std::size_t moved_indication(const Matrix& columns, std::size_t indications) {
  const double rounding = 1e-9 * columns.norm();
  for (std::size_t i = indications; i-- > 1;)
    if (columns(Eigen::seq(index(i), Eigen::last, index(indications)), Eigen::all).norm() > rounding) return i;
  return 0;
}

/// "readings" of differences along what counts them; else empty.
std::string counted(const Covariate& c) { return counts_readings(c) ? "readings" : ""; }

class CurveMaker {
public:
  CurveMaker(const TraceContext& c, const JointFit& fit, std::size_t term, const Rms& rms)
      : o_(c.observations), readings_(c.experiment.scenario().readings), term_(fit.terms[term]),
        indication_(moved_indication(term_.candidate.columns, o_.indications)) {
    const Index first = first_column(fit, term), d = term_.size.size();
    covariance_ = fit.covariance.block(first, first, d, d);
    const auto& card = c.experiment.model().card->indications[indication_];
    empty_.indication = card.name;
    empty_.indication_unit = card.unit;
    empty_.indication_si_unit = card.si_unit;
    rounding_ = 1e-9 * term_.candidate.columns.cwiseAbs().maxCoeff();
    unit_ = display_unit(rms, empty_.indication_unit, empty_.indication_si_unit);
  }

  /// Whether a curve is more than rounding: along one condition the ways of a hysteresis may cancel.
  bool shows(const Curve& curve) const {
    return std::ranges::any_of(curve.y, [](double y) { return y != 0; });
  }

  /// Unit of errors of the indication.
  const std::string& unit() const { return unit_; }

  Curve against(const Covariate& covariate) const {
    Curve out = empty_;
    out.against = covariate.name;
    out.unit = covariate.unit;
    out.si_unit = covariate.si_unit;
    const auto group = neighbours(covariate, criteria.most_curve_points);
    std::vector<std::size_t> own = group; // of what acts on one part alone: that part's
    for (std::size_t r = 0; r < own.size(); ++r)
      if (!quantities::holds_for(term_.candidate.amplitudes[0].labels, readings_[r].labels)) own[r] = none;
    for (std::size_t g = 0; g <= *std::ranges::max_element(group); ++g) {
      double sum = 0, count = 0;
      for (std::size_t r = 0; r < own.size(); ++r)
        if (own[r] == g) sum += covariate.value[r], ++count;
      if (count > 0) add(sum / count, own, g, out);
    }
    return out;
  }

  Curve against(const Grouping& label) const {
    Curve out = empty_;
    out.against = label.name;
    for (std::size_t g = 0; g < label.groups.size(); ++g)
      if (add(static_cast<double>(g), label.group, g, out)) out.levels.push_back(label.groups[g]);
    return out;
  }

  /// Unit of a rate: of s, min, h and d the shortest in which it has a digit before the point, "um/h".
  static std::string per_time(const std::string& above, double rate, const std::string& si_unit) {
    std::string out;
    for (const char* time : {"s", "min", "h", "d"}) {
      out = fmt::format("{}/{}", above, time);
      if (std::fabs(units::from_si(rate, out, si_unit, units::Kind::difference)) >= 1) break;
    }
    return out;
  }

  bool is_bend() const { return term_.candidate.name.starts_with("bend:"); }

  /// "0.49 um/K, u = 0.02 um/K" of a straight line against the covariate, where the term acts; empty of anything else.
  std::string slope(const Covariate& covariate) const {
    const Matrix& columns = term_.candidate.columns;
    if (columns.cols() != 1) return "";
    std::vector<double> xs, ys;
    for (std::size_t i = 0; i < o_.readings; ++i) {
      if (!quantities::holds_for(term_.candidate.amplitudes[0].labels, readings_[o_.sequence[i]].labels)) continue;
      const double y = columns(index(i * o_.indications + indication_), 0);
      if (y == 0 && is_bend()) continue; // before it
      xs.push_back(covariate.value[o_.sequence[i]]);
      ys.push_back(y);
    }
    const Vector x = Eigen::Map<const Vector>(xs.data(), index(xs.size())),
                 y = Eigen::Map<const Vector>(ys.data(), index(ys.size()));
    const Vector dx = x.array() - x.mean(), dy = y.array() - y.mean();
    const double per_size = dx.dot(dy) / dx.squaredNorm();
    constexpr double rounding = 1e-9;
    if (!((dy - per_size * dx).norm() <= rounding * dy.norm())) return "";
    const std::string unit = units::quotient(unit_, units::difference_unit(covariate.unit, covariate.si_unit)),
                      si_unit = units::quotient(empty_.indication_si_unit, covariate.si_unit);
    const double slope = term_.size[0] * per_size, u = std::sqrt(covariance_(0, 0)) * std::fabs(per_size);
    const std::string text = with_u(slope, u, covariate.unit == "s" ? per_time(unit_, slope, si_unit) : unit, si_unit);
    return counts_readings(covariate) ? text + ", per reading" : text;
  }

  /// "38 min, u = 4 min" of a drift or a lag; empty of anything else.
  std::string time_constant(const Covariate& time) const {
    const Candidate& a = term_.candidate;
    if (!(a.form == Form::drift || a.form == Form::lag) || term_.size.size() != 1 || !(a.parameter_u > 0)) return "";
    const double constant = std::exp(a.parameter) * (time.levels.back() - time.levels.front());
    return with_u(constant, constant * a.parameter_u, unit_of_duration(time, constant), time.si_unit, counted(time));
  }

  /// "38 min, u = 4 min; until it levels off it changes by 6.1 um, u = 0.3 um" of a drift; empty of anything else.
  std::string drift(const Covariate& time) const {
    const std::string constant = term_.candidate.form == Form::drift ? time_constant(time) : "";
    if (constant.empty()) return "";
    return fmt::format("{}; until it levels off it changes by {}", constant,
                       with_u(term_.size[0], size_u(), unit_, empty_.indication_si_unit));
  }

  /// "time constant 38 min, u = 4 min; in the end 1.5 um/K, u = 0.1 um/K" of a lag; empty of anything else.
  std::string lag(const Covariate& condition, const Covariate& time) const {
    const std::string constant = term_.candidate.form == Form::lag ? time_constant(time) : "";
    if (constant.empty()) return "";
    const double range = condition.levels.back() - condition.levels.front();
    const std::string per = units::difference_unit(condition.unit, condition.si_unit);
    return fmt::format("time constant {}; once it has settled {}", constant,
                       with_u(term_.size[0] / range, size_u() / range, units::quotient(unit_, per),
                              units::quotient(empty_.indication_si_unit, condition.si_unit)));
  }

  /// "period 3.31 s, u = 0.01 s; amplitude 1.5 um, u = 0.2 um" of a wave; empty of anything else.
  std::string wave(const Covariate& covariate) const {
    const double cycles = term_.candidate.parameter;
    if (term_.candidate.form != Form::wave || term_.size.size() != 2) return "";
    const double amplitude = term_.size.norm();
    const Vector direction = term_.size / amplitude;
    const double u = std::sqrt(direction.dot(covariance_ * direction));
    const double range = covariate.levels.back() - covariate.levels.front();
    if (const auto others = other_periods(covariate, range / cycles); !others.empty())
      return fmt::format(
          "period {}, or as well {}, which these readings cannot distinguish because of the gaps between "
          "them; amplitude {}",
          shown_period(covariate, range / cycles), fmt::join(others, " or "),
          with_u(amplitude, u, unit_, empty_.indication_si_unit));
    return fmt::format("period {}; amplitude {}{}",
                       with_u(range / cycles, range / cycles / cycles * term_.candidate.parameter_u,
                              unit_of_duration(covariate, range / cycles), covariate.si_unit, counted(covariate)),
                       with_u(amplitude, u, unit_, empty_.indication_si_unit), aliases(covariate, range / cycles));
  }

  /// Periods with which the training readings would show nearly the same.
  std::vector<std::string> other_periods(const Covariate& covariate, double period) const {
    std::vector<double> along, wave;
    for (std::size_t i = 0; i < o_.readings; ++i) {
      const std::size_t reading = o_.sequence[i];
      if (o_.held_out[reading]) continue;
      along.push_back(covariate.value[reading]);
      wave.push_back(term_.candidate.columns.row(index(i * o_.indications + indication_)).dot(term_.size));
    }
    std::vector<std::string> out;
    for (const double other : alike(Eigen::Map<const Vector>(along.data(), index(along.size())),
                                    Eigen::Map<const Vector>(wave.data(), index(wave.size())), period))
      out.push_back(shown_period(covariate, other));
    return out;
  }

  /// "1 wave per turn 3.6 um, u = 0.1 um; 2 waves ..." of a dependence on an angle that goes round: those that exceed
  /// three u. Empty of any other.
  std::string waves_per_turn(const Covariate& angle) const {
    if (!angle.angle || angle.levels.back() - angle.levels.front() <= 1.5 * std::numbers::pi) return "";
    const auto n = index(o_.readings);
    const auto most = index(std::min(criteria.most_harmonics, (angle.levels.size() - 1) / 2));
    Matrix basis(n, 1 + 2 * most);
    basis.col(0).setOnes();
    for (Index i = 0; i < n; ++i)
      for (Index h = 1; h <= most; ++h) {
        const double turn = static_cast<double>(h) * angle.value[o_.sequence[index(i)]];
        basis(i, 2 * h - 1) = std::cos(turn);
        basis(i, 2 * h) = std::sin(turn);
      }
    const Matrix own =
        term_.candidate.columns(Eigen::seq(index(indication_), Eigen::last, index(o_.indications)), Eigen::all);
    const Matrix by_size = basis.completeOrthogonalDecomposition().solve(own);
    const Vector size = by_size * term_.size;
    const Matrix covariance = by_size * covariance_ * by_size.transpose();
    std::string out;
    for (Index h = 1; h <= most; ++h) {
      const Vector wave = size.segment(2 * h - 1, 2);
      const double amplitude = wave.norm();
      constexpr double rounding = 1e-9;
      if (!(amplitude > rounding * size.norm())) continue;
      const double u = std::sqrt(wave.dot(covariance.block(2 * h - 1, 2 * h - 1, 2, 2) * wave)) / amplitude;
      if (amplitude > criteria.shown_wave * u)
        out += fmt::format("{}{} wave{} {}, u = {}", out.empty() ? "" : "; ", h, h > 1 ? "s" : "",
                           shown_size(amplitude, unit_, empty_.indication_si_unit),
                           shown_size(u, unit_, empty_.indication_si_unit));
    }
    return out;
  }

  /// "1.5 um, u = 0.2 um" by which one group differs from the others; empty of anything else.
  std::string step() const {
    const Matrix& columns = term_.candidate.columns;
    if (columns.cols() != 1) return "";
    const Vector y = columns(Eigen::seq(index(indication_), Eigen::last, index(o_.indications)), 0);
    const double low = y.minCoeff(), high = y.maxCoeff();
    const bool gradual = term_.candidate.name.starts_with("shift:");
    if (!gradual && ((y.array() - low) * (y.array() - high)).abs().maxCoeff() > 0) return "";
    return with_u(term_.size[0] * (high - low), std::sqrt(covariance_(0, 0)) * (high - low), unit_,
                  empty_.indication_si_unit);
  }

  /// "4.2 um, u = 0.3 um": the largest difference that it makes between two training readings.
  std::string reach() const {
    std::vector<Index> rows;
    for (std::size_t i = 0; i < o_.readings; ++i)
      if (!o_.held_out[o_.sequence[i]]) rows.push_back(index(i * o_.indications + indication_));
    const Matrix columns = term_.candidate.columns(rows, Eigen::all);
    const Vector y = columns * term_.size;
    Index low = 0, high = 0;
    const double most = y.maxCoeff(&high) - y.minCoeff(&low);
    const Vector apart = (columns.row(high) - columns.row(low)).transpose();
    return with_u(most, std::sqrt(std::max(0.0, apart.dot(covariance_ * apart))), unit_, empty_.indication_si_unit);
  }

  /// By all of these together, if there are two readings of each combination or more; else without rows.
  CellTable by(const std::vector<const Covariate*>& covariates, const std::vector<const Grouping*>& labels) const {
    std::map<std::vector<double>, std::vector<std::size_t>> cells; // in the order of the keys: reproducible
    std::size_t readings = 0;
    for (std::size_t r = 0; r < o_.readings; ++r) {
      if (o_.held_out[r]) continue;
      std::vector<double> level;
      for (const Covariate* c : covariates) level.push_back(c->value[r]);
      for (const Grouping* g : labels) level.push_back(static_cast<double>(g->group[r]));
      cells[std::move(level)].push_back(r);
      ++readings;
    }
    CellTable out;
    if (cells.size() > criteria.most_table_cells || cells.size() * criteria.least_repeats > readings) return out;
    out.indication = empty_.indication;
    out.indication_unit = empty_.indication_unit;
    out.indication_si_unit = empty_.indication_si_unit;
    for (const Covariate* c : covariates) out.keys.push_back({c->name, c->unit, c->si_unit, {}, {}});
    for (const Grouping* g : labels) out.keys.push_back({g->name, "1", "1", {}, {}});
    for (const auto& [level, members] : cells) {
      std::vector<std::size_t> group(o_.readings, 0);
      for (const std::size_t r : members) group[r] = 1;
      Curve one = empty_;
      if (!add(0, group, 1, one)) continue;
      for (std::size_t k = 0; k < level.size(); ++k)
        if (k < covariates.size())
          out.keys[k].x.push_back(level[k]);
        else
          out.keys[k].levels.push_back(labels[k - covariates.size()]->groups[static_cast<std::size_t>(level[k])]);
      out.y.push_back(one.y[0]);
      out.u.push_back(one.u[0]);
      out.readings.push_back(static_cast<double>(members.size()));
    }
    return out;
  }

private:
  static constexpr std::size_t none = ~std::size_t{0}; ///< no group

  /// u of a single size, which holds whatever the parameter of its form is.
  double size_u() const { return std::max(term_.candidate.size_u, std::sqrt(covariance_(0, 0))); }

  /// The mean over the training readings of a group, if there are any.
  bool add(double x, const std::vector<std::size_t>& group, std::size_t which, Curve& out) const {
    const Matrix& columns = term_.candidate.columns;
    Vector mean = Vector::Zero(columns.cols());
    double count = 0;
    for (std::size_t i = 0; i < o_.sequence.size(); ++i)
      if (group[o_.sequence[i]] == which && !o_.held_out[o_.sequence[i]]) {
        mean += columns.row(index(i * o_.indications + indication_)).transpose();
        ++count;
      }
    if (count == 0) return false;
    mean /= count;
    if (mean.cwiseAbs().maxCoeff() <= rounding_) mean.setZero(); // nothing: no value, and no uncertainty
    out.x.push_back(x);
    out.y.push_back(mean.dot(term_.size));
    out.u.push_back(std::sqrt(std::max(0.0, mean.dot(covariance_ * mean))));
    return true;
  }

  const Observations& o_;
  const std::vector<quantities::Reading>& readings_;
  const Term& term_;
  std::size_t indication_;
  Matrix covariance_;
  double rounding_ = 0; ///< of a loading
  Curve empty_;
  std::string unit_; ///< of errors
};

} // namespace

namespace {

/// By which way the values of a condition were reached, rising 1 and falling -1: a hysteresis depends on it where no
/// condition says the same.
std::optional<Covariate> sense_of(const Candidate& a, const std::vector<const Covariate*>& depends_on,
                                  const Observations& o) {
  if (depends_on.size() != 1 || !a.name.starts_with("hysteresis:")) return std::nullopt;
  std::vector<double> x;
  for (const std::size_t reading : o.sequence) x.push_back(depends_on[0]->value[reading]);
  const std::vector<double> way = senses(x);
  Covariate out{"sense of " + depends_on[0]->name, "1", "1", std::vector<double>(o.readings), {-1, 1}};
  for (std::size_t i = 0; i < way.size(); ++i) out.value[o.sequence[i]] = way[i];
  return out;
}

} // namespace

void add_curves(const TraceContext& c, const JointFit& fit, std::size_t term, const Rms& rms, Finding& finding) {
  const CurveMaker make(c, fit, term, rms);
  const auto add = [&](const auto& all, const std::string& name) {
    for (const auto& one : all)
      if (one.name == name)
        if (Curve curve = make.against(one); !curve.x.empty() && make.shows(curve))
          finding.curves.push_back(std::move(curve));
  };
  for (const std::string& name : finding.depends_on) {
    add(c.observations.covariates, name);
    add(c.observations.labels, name);
  }
  std::vector<const Covariate*> covariates;
  std::vector<const Grouping*> labels;
  for (const std::string& name : finding.depends_on) {
    for (const Covariate& one : c.observations.covariates)
      if (one.name == name) covariates.push_back(&one);
    for (const Grouping& one : c.observations.labels)
      if (one.name == name) labels.push_back(&one);
  }
  if (covariates.empty() && labels.empty()) return;
  const bool of_one = covariates.size() + labels.size() == 1;
  const std::size_t remarks = finding.remarks.size();
  const auto sense = sense_of(fit.terms[term].candidate, covariates, c.observations);
  if (sense) covariates.push_back(&*sense);
  CellTable table = make.by(covariates, labels);
  const Candidate& shape = fit.terms[term].candidate;
  if (of_one) {
    if (const std::string wave = labels.empty() ? make.wave(*covariates[0]) : ""; !wave.empty())
      finding.remarks.push_back(fmt::format("a wave along {}: {}", covariates[0]->name, wave));
    else if (const std::string drift = labels.empty() ? make.drift(*covariates[0]) : ""; !drift.empty())
      finding.remarks.push_back("time constant " + drift);
    else if (const std::string waves = labels.empty() ? make.waves_per_turn(*covariates[0]) : ""; !waves.empty())
      finding.remarks.push_back(fmt::format("per turn of {}: {}", covariates[0]->name, waves));
    else if (const std::string wave_there =
                 fit.terms[term].candidate.name.starts_with("table:") ? wave_of(table, make.unit()) : "";
             !wave_there.empty())
      finding.remarks.push_back(wave_there);
    else if (const std::string step = make.step(); !step.empty())
      finding.remarks.push_back("it differs by " + step);
    else if (const std::string slope = labels.empty() ? make.slope(*covariates[0]) : ""; !slope.empty())
      finding.remarks.push_back(fmt::format("{}a straight line against {}: {}", make.is_bend() ? "from then on " : "",
                                            covariates[0]->name, slope));
  } else if (const std::string step =
                 covariates.empty() || shape.name.starts_with("step:") || shape.name.starts_with("while:") ? make.step()
                                                                                                           : "";
             !step.empty()) {
    finding.remarks.push_back("it differs by " + step);
  } else if (const std::string lag = covariates.size() == 2 ? make.lag(*covariates[0], *covariates[1]) : "";
             !lag.empty()) {
    finding.remarks.push_back(fmt::format("it follows {} with a lag: {}", covariates[0]->name, lag));
  } else if (shape.rare() && covariates.size() == 1) {
    finding.remarks.push_back(
        fmt::format("{} alone has {}a straight line against {}: {}", quantities::text_of(shape.amplitudes[0].labels),
                    make.is_bend() ? "from then on " : "", covariates[0]->name, make.slope(*covariates[0])));
  }
  if (finding.remarks.size() == remarks) finding.remarks.push_back("it makes readings differ by up to " + make.reach());
  if (!table.y.empty()) finding.tables.push_back(std::move(table));
}

} // namespace gumshoe::tracing
