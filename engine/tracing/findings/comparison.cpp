#include "tracing/findings/comparison.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "propagation/experiment.h"
#include "tracing/criteria.h"
#include "tracing/findings/errors.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/noise_alone.h"
#include "tracing/judgement/decisions.h"
#include "tracing/judgement/evidence.h"
#include "tracing/judgement/holdout.h"
#include "tracing/noise/pure_error.h"

namespace gumshoe::tracing {
namespace {

double root_mean_square(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

/// Root mean square and 95 % of what noise alone gives.
void set_noise_alone(std::vector<double> sizes, double& middle, double& low, double& high) {
  middle = root_mean_square(sizes);
  std::ranges::sort(sizes);
  const auto quantile = [&](double p) {
    return sizes[std::min(sizes.size() - 1, static_cast<std::size_t>(p * static_cast<double>(sizes.size())))];
  };
  low = quantile(0.025);
  high = quantile(0.975);
}

class Comparison {
public:
  Comparison(const TraceContext& c, const Search& s, Trace& out)
      : c_(c), search_(s), rows_(c.fitter.rows()), base_(s.base), before_(s.base), after_(s.found), judged_(s.found),
        previous_(s.stages.size() > 1 ? s.stages[s.stages.size() - 2].fit : s.base), has_previous_(s.stages.size() > 1),
        out_(out) {
    // Scatter is declared from now on, with the size that the traced scenario states: what is an outlier, and how large
    // the noise is, are judged given its draws, as a trace of that scenario does. The verdict knows only what was
    // found.
    const FittedScatter scatter = fitted_scatter(c, s.found, s.findings);
    for (const bool all : {false, true}) {
      std::vector<MoreNoise> declared;
      for (const SearchFinding& f : s.findings)
        std::ranges::copy(larger_noise(s.found, f.finding), std::back_inserter(declared));
      for (const Component& one : scatter.components)
        if (all || one.found) std::ranges::copy(noise_of(one, s.found), std::back_inserter(declared));
      if (declared.empty()) continue;
      if (JointFit fit = c.fitter.with_noise(s.found, declared); fit.valid) (all ? after_ : judged_) = std::move(fit);
      if (std::ranges::all_of(scatter.components, &Component::found)) {
        after_ = judged_;
        break;
      }
    }
    // Judged in the units of one noise: the fit without the effect takes it for noise. Each predicts by its own
    // covariance model, as a trace of the scenario would that it stands for.
    for (JointFit* fit : {&before_, &previous_}) {
      fit->design.local = judged_.design.local;
      fit->design.reference = judged_.design.reference;
    }
    noise_ = noise_of_readings(c_, after_);
    predicted_noise_ = noise_of_predicted(c_, after_, noise_);
  }

  bool compare() {
    const Vector after_in_first = in_first(c_.observations, after_.design);
    const InSample before = in_sample(base_, rows_, base_.residual, in_first(c_.observations, base_.design)),
                   after = in_sample(after_, rows_, after_.residual, after_in_first);
    out_.rms.before = before.rms[0];
    out_.rms.after = after.rms[0];
    const Vector noise = in_sample(after_, rows_, noise_, after_in_first).rms;
    set_noise_alone({noise.data(), noise.data() + noise.size()}, out_.rms.noise, out_.rms.noise_low,
                    out_.rms.noise_high);
    replicate_floor();
    const Blocks blocks = predicted_blocks(c_.observations);
    const bool held_out = !c_.observations.holdout_blocks.empty();
    out_.rms.holdout = blocks.rows.empty() ? "none"
                       : held_out          ? fmt::format("{}", fmt::join(blocks.names, ", "))
                                           : "each block left out in turn; the search has used these data";
    const bool refused = !blocks.rows.empty() && hold_out_blocks(blocks);
    fill_rows(before.left, refused ? before.left : after.left, refused ? base_ : after_);
    if (c_.observations.indications > 1) fill_indications();
    return refused;
  }

private:
  /// Scatter of readings of equal conditions; its interval by what the fitted noise gives in draws.
  void replicate_floor() {
    const PureError pure(after_.design, rows_, c_.fitter.replicates(), c_.threads, after_.covariance_model);
    if (!pure.known()) return;
    const double reference = after_.design.reference[0];
    Vector drawn = pure.scale(noise_(rows_, Eigen::all));
    const double middle = std::sqrt(drawn.squaredNorm() / static_cast<double>(drawn.size()));
    std::ranges::sort(drawn);
    const auto ratio = [&](double p) {
      return drawn[static_cast<Index>(p * static_cast<double>(drawn.size()))] / middle;
    };
    Rms& rms = out_.rms;
    rms.replicate_floor = reference * pure.scale(after_.residual(rows_))[0];
    rms.replicate_floor_low = rms.replicate_floor / ratio(0.975);
    rms.replicate_floor_high = rms.replicate_floor / ratio(0.025);
    out_.lack_of_fit.freedom = pure.freedom();
    out_.lack_of_fit.cells = static_cast<int>(pure.cells());
  }

  Scores predict(const JointFit& fit, const Matrix& residual, const Blocks& blocks) const {
    return score(fit, residual, rows_, blocks, after_.covariance_model, in_first(c_.observations, fit.design));
  }

  /// As the verdict has it: without these excesses, by the covariance model of what was found.
  Scores verdict(const JointFit& fit, const Vector& bad, const Blocks& blocks) const {
    return score(fit, fit.residual - bad, rows_, blocks, judged_.covariance_model,
                 in_first(c_.observations, fit.design));
  }

  /// What the error cannot fall below: the replicates' scatter, else the declared noise.
  double floor() const {
    if (std::isfinite(out_.rms.replicate_floor)) return out_.rms.replicate_floor;
    return c_.fitter.noise_declared() ? after_.design.reference[0] / after_.noise : Rms::none;
  }

  /// True if they veto.
  bool hold_out_blocks(const Blocks& blocks) {
    Rms& rms = out_.rms;
    scored_before_ = predict(base_, base_.residual, blocks);
    scored_after_ = predict(after_, after_.residual, blocks);
    if (scored_before_.scored())
      set_noise_alone(predict(after_, not_fitted(c_, after_, predicted_noise_), blocks).rms, rms.holdout_noise,
                      rms.holdout_noise_low, rms.holdout_noise_high);
    else
      rms.holdout += "; not scored, because it has no more readings than block offsets";
    const Vector bad = excess(scored_before_, scored_after_, after_.design);
    const Scores clean_before = predict(base_, base_.residual - bad, blocks);
    Scores clean_after = predict(after_, after_.residual - bad, blocks);
    const Scores judged = verdict(judged_, bad, blocks);
    const bool rejected = judge(blocks, verdict(before_, bad, blocks), judged) || last_spoils(blocks, bad, judged),
               refused = rejected && !confirmed_between_blocks();
    if (rejected && !refused) out_.unconfirmed = true; // of readings to come nothing is known
    if (refused) {
      scored_after_ = scored_before_;
      clean_after = clean_before;
      rms.after = rms.before;
    }
    rms.holdout_before = scored_before_.rms[0];
    rms.holdout_after = scored_after_.rms[0];
    rms.holdout_before_winsorised = clean_before.rms[0];
    rms.holdout_after_winsorised = clean_after.rms[0];
    rms.worst_block_before = scored_before_.worst_block;
    rms.worst_block_after = scored_after_.worst_block;
    rms.worst_block = scored_after_.worst_name;
    const auto square = [](double x) { return x * x; };
    const double removable = square(rms.holdout_before) - square(floor());
    if (removable > 0) rms.share_removed = (square(rms.holdout_before) - square(rms.holdout_after)) / removable;
    rms.worst_point_before = scored_before_.worst_point();
    rms.worst_point_after = scored_after_.worst_point();
    if (const Index row = scored_after_.worst_row(); row >= 0) {
      rms.worst_point = c_.experiment.reading_text(after_.design.reading[index(row)]);
    }
    return refused;
  }

  /// What the findings explain of the training data, each given all others, beyond what it had to; zero if it is of a
  /// few readings.
  double beyond_chance() const {
    double out = 0;
    if (explains_few(c_, search_.base, search_.found)) return out;
    for (const SearchFinding& f : search_.findings)
      if (!f.terms.empty()) out += gain_of(c_, search_.found, f.terms, f.component >= 0) - f.threshold;
    return out;
  }

  /// Blocks that are insensitive to what was found can neither confirm nor reject it. One bad reading must not decide.
  bool judge(const Blocks& blocks, const Scores& before, const Scores& after) {
    if (c_.observations.holdout_blocks.empty() || !scored_before_.scored() || after_.terms.empty()) return false;
    const bool sensitive = std::ranges::any_of(after_.terms, [&](const Term& t) {
      return std::ranges::any_of(blocks.rows, [&](const std::vector<Index>& rows) {
        const Matrix& columns = t.candidate.columns;
        return columns(rows, Eigen::all).norm() > criteria.insensitive * columns.norm();
      });
    });
    out_.unconfirmed = !sensitive;
    if (!sensitive) {
      const double was = scored_before_.rms[0], is = scored_after_.rms[0];
      constexpr double visible = 0.02;
      const bool changes = std::fabs(is - was) > visible * was;
      out_.statements.push_back(
          fmt::format("the hold-out blocks are insensitive to the finding and can neither confirm nor reject it{}",
                      changes ? "; their error changes only because everything else is fitted together with it" : ""));
      return false;
    }
    const Holdout says = judge_holdout({before.whitened, before.rms[0]}, {after.whitened, after.rms[0]},
                                       overstated(before, after, judged_.design), out_.rms.holdout_noise_high,
                                       [&] { return beyond_chance(); });
    out_.unconfirmed = says == Holdout::favours || says == Holdout::unsure || says == Holdout::outweighed;
    if (says == Holdout::favours)
      out_.statements.push_back("the hold-out blocks are predicted better with what was found, but by no more than "
                                "chance gives: they can neither confirm nor reject it");
    if (says == Holdout::unsure)
      out_.statements.push_back("the hold-out blocks are predicted no better with what was found, but no worse than "
                                "chance gives: they can neither confirm nor reject it");
    if (says == Holdout::outweighed)
      out_.statements.push_back("the hold-out blocks are predicted worse with what was found, as chance seldom gives, "
                                "but the training data show it by far more: confirm it by another measurement");
    return says == Holdout::vetoes;
  }

  /// Whether they are predicted much worse with what the last round found than without it, though better than before.
  bool last_spoils(const Blocks& blocks, const Vector& bad, const Scores& after) const {
    if (c_.observations.holdout_blocks.empty() || !scored_before_.scored() || !has_previous_) return false;
    const Scores before = verdict(previous_, bad, blocks);
    return after.whitened > before.whitened && after.rms[0] > criteria.veto_growth * before.rms[0] &&
           overstated(before, after, judged_.design).plain > criteria.overstated_surely;
  }

  /// Names of what was found to depend on, of which the hold-out readings lie outside the training range.
  std::vector<std::string> extrapolated() const {
    const Observations& o = c_.observations;
    std::vector<std::string> out;
    for (const Covariate& covariate : o.covariates) {
      const bool found = std::ranges::any_of(after_.terms, [&](const Term& t) {
        const auto& on = t.candidate.depends_on;
        return std::ranges::find(on, covariate.name) != on.end();
      });
      double low = 1e300, high = -1e300;
      for (std::size_t r = 0; r < o.readings; ++r)
        if (!o.held_out[r]) low = std::min(low, covariate.value[r]), high = std::max(high, covariate.value[r]);
      bool outside = found;
      for (std::size_t r = 0; r < o.readings && outside; ++r)
        outside = !o.held_out[r] || covariate.value[r] < low || covariate.value[r] > high;
      if (outside) out.push_back(covariate.name);
    }
    return out;
  }

  /// A drift cannot be judged by blocks beyond its end, to which it would have to be extrapolated: every block between
  /// the first and the last is predicted from all others as well. The search has used most of these, so that only a
  /// gain beyond doubt outweighs the veto.
  bool confirmed_between_blocks() {
    const auto names = extrapolated();
    const Observations& o = c_.observations;
    // Where what was found goes astray beyond its end, it is no description that goes on.
    if (scored_after_.rms[0] > criteria.astray * scored_before_.rms[0]) return false;
    if (names.empty() || o.blocks.groups.size() < criteria.blocks_for_folds) return false;
    Blocks between;
    for (std::size_t g = 1; g + 1 < o.blocks.groups.size(); ++g) { // numbered in the order of measurement
      std::vector<bool> chosen;
      for (std::size_t r = 0; r < o.readings; ++r) chosen.push_back(o.blocks.group[r] == g);
      between.rows.push_back(rows_where(o, chosen));
      between.names.push_back(o.blocks.groups[g]);
    }
    const std::vector<Index> all = rows_where(o, std::vector<bool>(o.readings, true));
    const auto predicted = [&](const JointFit& fit) {
      return score(fit, fit.residual, all, between, judged_.covariance_model, in_first(o, fit.design));
    };
    const Scores before = predicted(previous_), after = predicted(judged_);
    const bool rejected = !before.scored() || !(before.whitened - after.whitened > criteria.beyond_doubt);
    out_.statements.push_back(fmt::format(
        "the hold-out blocks lie beyond the {} of the training data, to which what was found does not extend; blocks "
        "between the first and the last, each predicted from all others, {}",
        fmt::join(names, " and "), rejected ? "do not confirm it" : "confirm it there, not beyond"));
    return !rejected;
  }

  /// Training residuals in sample, held-out ones as predicted.
  void fill_rows(const Matrix& left_before, const Matrix& left_after, const JointFit& winsorised) {
    const Observations& o = c_.observations;
    out_.rows.resize(index(after_.residual.size()));
    for (std::size_t i = 0; i < out_.rows.size(); ++i) {
      Row& row = out_.rows[i];
      row.reading = after_.design.reading[i];
      row.indication = i % o.indications;
      row.order = o.order[row.reading];
      if (!o.blocks.groups.empty()) row.block = o.blocks.groups[o.blocks.group[row.reading]];
      row.held_out = o.held_out[row.reading];
      row.measured = o.measured[row.reading * o.indications + row.indication];
      row.before = row.held_out ? scored_before_.residual[index(i)] : Rms::none;
      row.after = row.held_out ? scored_after_.residual[index(i)] : Rms::none;
      row.noise_u = after_.design.local[i / o.indications].row(index(row.indication)).norm();
    }
    const Vector bad =
        scored_after_.residual.size() > 0 ? excess(scored_after_, scored_after_, after_.design) : Vector();
    for (Index i = 0; i < bad.size(); ++i)
      if (Row& row = out_.rows[index(i)]; row.held_out && bad[i] != 0) {
        row.weight = 1 - bad[i] / row.after;
        add_outlier(row);
      }
    Matrix weight;
    const Whitened plain(after_.design, rows_, independent(after_.design, rows_), {});
    plain.winsorised(plain.take(winsorised.residual), nullptr, &weight);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      Row& row = out_.rows[index(rows_[i])];
      row.before = left_before(index(i), 0);
      row.after = left_after(index(i), 0);
      row.weight = weight(index(i), 0);
      if (row.weight < 1) add_outlier(row);
    }
    std::ranges::stable_sort(out_.outliers, {}, &Outlier::weight);
    out_.noise.outliers = static_cast<int>(out_.outliers.size());
  }

  /// Root mean squares by indication, in its own unit, corrected for degrees of freedom by the factor of the whole.
  void fill_indications() {
    const auto cards = c_.experiment.model().card->indications;
    for (const VariableCard& card : cards)
      out_.of_indications.push_back({std::string(card.name), std::string(card.unit), std::string(card.si_unit)});
    const auto fill = [&](double whole, double IndicationError::*member, const Vector& count_as, const auto& residual) {
      const Index indications = count_as.size();
      Vector squares = Vector::Zero(indications), n = squares;
      for (Index i = 0; i < index(out_.rows.size()); ++i) {
        const double r = residual(i);
        if (!std::isfinite(r)) continue;
        squares[i % indications] += r * r;
        n[i % indications] += 1;
      }
      const double mean = count_as.cwiseAbs2().dot(squares) / n.sum();
      for (Index k = 0; k < indications; ++k)
        out_.of_indications[index(k)].*member = mean > 0 ? whole * std::sqrt(squares[k] / n[k] / mean) : squares[k];
    };
    const auto in_sample = [&](double Row::*member) {
      return [this, member](Index i) { return out_.rows[index(i)].held_out ? Rms::none : out_.rows[index(i)].*member; };
    };
    using E = IndicationError;
    const Vector first_before = in_first(c_.observations, base_.design),
                 first_after = in_first(c_.observations, after_.design);
    fill(out_.rms.before, &E::before, first_before, in_sample(&Row::before));
    fill(out_.rms.after, &E::after, first_after, in_sample(&Row::after));
    for (IndicationError& e : out_.of_indications) e.unit = units::error_unit(e.unit, e.si_unit, e.before);
    if (!scored_before_.scored()) return;
    for (const auto& [scores, whole, member] :
         {std::tuple{&scored_before_, out_.rms.holdout_before, &E::holdout_before},
          {&scored_after_, out_.rms.holdout_after, &E::holdout_after}})
      fill(whole, member, scores->in_first, [&](Index i) { return scores->residual[i]; });
  }

  /// None whose weight is shown as 1.00.
  void add_outlier(const Row& row) {
    if (row.weight >= 0.995) return;
    const VariableCard& v = c_.experiment.model().card->indications[row.indication];
    out_.outliers.push_back({c_.experiment.reading_text(row.reading), row.block, std::string(v.name),
                             std::string(v.unit), std::string(v.si_unit), row.after, row.weight});
  }

  const TraceContext& c_;
  const Search& search_;
  const std::vector<Index>& rows_;
  JointFit base_;   ///< the declared model with its own noise: where the round before ended
  JointFit before_; ///< the same in units of the noise of `judged_`
  JointFit after_;
  JointFit judged_;   ///< the same for the verdict, with only the scatter that was found
  JointFit previous_; ///< without what the last round found
  bool has_previous_; ///< it is not the first round
  Trace& out_;
  Matrix noise_;           ///< draws of the fitted noise, all rows x sets
  Matrix predicted_noise_; ///< the same of readings that were not fitted
  Scores scored_before_, scored_after_;
};

} // namespace

bool compare(const TraceContext& c, const Search& s, Trace& out) { return Comparison(c, s, out).compare(); }

} // namespace gumshoe::tracing
