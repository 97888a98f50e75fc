#include "tracing/findings/findings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "quantities/cells.h"
#include "tracing/findings/interval.h"
#include "tracing/findings/splitting.h"

namespace gumshoe::tracing {
namespace {

std::string shown(double si, const std::string& unit, const std::string& si_unit) {
  return fmt::format("{:.3g}{}", units::from_si(si, unit, si_unit, units::Kind::difference),
                     unit == "1" ? "" : " " + unit);
}

/// Lengths are told in um.
std::string length(double si, const Rms& rms) {
  return rms.si_unit == "m" ? fmt::format("{:.2g} um", si * 1e6) : shown(si, rms.unit, rms.si_unit);
}

std::vector<SizedQuantity> sizes(const Circumstances& c, const Term& term, const Vector& u, double threshold,
                                 const JointFit& fit) {
  std::vector<SizedQuantity> out;
  for (Index j = 0; j < term.size.size(); ++j) {
    const Amplitude& a = term.alternative.amplitudes[static_cast<std::size_t>(j)];
    if (a.scenario_name.empty()) continue;
    SizedQuantity q;
    q.name = a.name;
    q.unit = a.unit;
    q.si_unit = a.si_unit;
    q.scenario_name = a.scenario_name;
    q.labels = a.labels;
    q.value = term.size[j];
    q.u = u[j];
    // A size alone was reported because it passed the threshold; of a pair neither was.
    const double least = term.size.size() == 1 ? std::sqrt(threshold) * u[j] : 0;
    std::tie(q.low95, q.high95) = interval_after_selection(q.value, q.u, least);
    // A declared quantity is told as it stands; by its shift where it stands differently from reading to reading.
    if (term.alternative.family == Family::declared) {
      double low = 1e300, high = -1e300;
      for (std::size_t r = 0; r < fit.at.size(); ++r) {
        if (!quantities::holds_for(a.labels, c.experiment.scenario().readings[r].labels)) continue;
        low = std::min(low, fit.at[r][a.quantity]);
        high = std::max(high, fit.at[r][a.quantity]);
      }
      if (low == high) {
        const double declared = low - q.value;
        q.value += declared;
        q.low95 += declared;
        q.high95 += declared;
      } else {
        q.name = "shift of " + q.name;
      }
    }
    out.push_back(std::move(q));
  }
  return out;
}

void add_curve(const Circumstances& c, const JointFit& fit, std::size_t term, Finding& finding) {
  const Alternative& a = fit.terms[term].alternative;
  const auto& o = c.observations;
  for (const std::string& name : finding.depends_on) {
    Curve curve;
    curve.against = name;
    std::size_t indication = 0;
    for (std::size_t i = 0; i < o.indications; ++i)
      if (a.columns(Eigen::seq(static_cast<Index>(i), Eigen::last, static_cast<Index>(o.indications)), Eigen::all)
              .norm() > 0)
        indication = i;
    const auto& card = c.experiment.model().card->indications[indication];
    curve.indication = card.name;
    curve.indication_unit = card.unit;
    curve.indication_si_unit = card.si_unit;
    const Index first = first_column(fit, term), d = fit.terms[term].size.size();
    const Matrix covariance = fit.covariance.block(first, first, d, d);
    const auto add = [&](double x, const std::vector<bool>& chosen) {
      // The mean over the readings there.
      Vector mean = Vector::Zero(a.columns.cols());
      double count = 0;
      for (std::size_t i = 0; i < o.sequence.size(); ++i)
        if (chosen[o.sequence[i]] && !o.final[o.sequence[i]]) {
          mean += a.columns.row(static_cast<Index>(i * o.indications + indication)).transpose();
          ++count;
        }
      if (count == 0) return false;
      mean /= count;
      curve.x.push_back(x);
      curve.y.push_back(mean.dot(fit.terms[term].size));
      curve.u.push_back(std::sqrt(std::max(0.0, mean.dot(covariance * mean))));
      return true;
    };
    for (const Covariate& covariate : o.covariates) {
      if (covariate.name != name) continue;
      curve.unit = covariate.unit;
      curve.si_unit = covariate.si_unit;
      const std::size_t bins = std::min<std::size_t>(covariate.levels.size(), 24);
      for (std::size_t b = 0; b < bins; ++b) {
        std::vector<bool> chosen;
        double sum = 0, count = 0;
        for (const double x : covariate.value) {
          const auto rank = static_cast<std::size_t>(
              std::lower_bound(covariate.levels.begin(), covariate.levels.end(), x) - covariate.levels.begin());
          chosen.push_back(rank * bins / covariate.levels.size() == b);
          if (chosen.back()) sum += x, ++count;
        }
        if (count > 0) add(sum / count, chosen);
      }
    }
    for (const Grouping& g : o.labels) {
      if (g.name != name) continue;
      for (std::size_t i = 0; i < g.groups.size(); ++i) {
        std::vector<bool> chosen;
        for (const std::size_t x : g.group) chosen.push_back(x == i);
        if (add(static_cast<double>(i), chosen)) curve.levels.push_back(g.groups[i]);
      }
    }
    if (!curve.x.empty()) finding.curves.push_back(std::move(curve));
  }
}

void remark_on_size(const Term& term, Finding& finding) {
  for (Index j = 0; j < term.size.size(); ++j) {
    const Amplitude& a = term.alternative.amplitudes[static_cast<std::size_t>(j)];
    if (a.typical > 0 && std::fabs(term.size[j]) > 5 * a.typical)
      finding.remarks.push_back(fmt::format("{} is far beyond what is usual ({}): something else may stand behind it",
                                            shown(term.size[j], a.unit, a.si_unit),
                                            "up to " + shown(a.typical, a.unit, a.si_unit)));
    if (const double times = std::fabs(term.size[j]) / a.declared; a.declared > 0 && times > 10)
      finding.remarks.push_back(
          fmt::format("{:.0f} times its declared standard uncertainty off: something else may stand behind it", times));
    if (term.size[j] == a.low || term.size[j] == a.high)
      finding.remarks.push_back(a.name + " is held by a limit of its card: something else may stand behind it");
  }
  if (!term.alternative.held.empty() && !term.alternative.shape.empty())
    finding.remarks.push_back("with " + term.alternative.shape + ", of the shapes tried the best");
}

} // namespace

void describe_noise(const Circumstances& c, const Search& s, Trace& out) {
  out.noise.declared = c.fitter.noise_declared();
  out.noise.scale = s.found.noise * std::sqrt(s.found.variance);
  out.noise.correlation = s.found.structure.correlation;
  if (s.found.structure.scatter >= 0) {
    out.noise.scatter = c.observations.redone[static_cast<std::size_t>(s.found.structure.scatter)].name;
    out.noise.scatter_u =
        s.found.structure.ratio *
        s.found.design.reference[static_cast<std::size_t>(std::max(0, s.found.structure.indication))] *
        std::sqrt(s.found.variance);
  }
  out.noise.chi_squared_p = s.first.p_noise;
  if (s.last.noise_small && out.noise.declared)
    out.statements.push_back(fmt::format(
        "the noise is smaller than declared ({:.2g} times): its uncertainty is over-stated", out.noise.scale));
  if (out.noise.correlation >= 0.2)
    out.statements.push_back(
        fmt::format("each reading's noise resembles the one before (correlation about {:.1f}): allowed for",
                    out.noise.correlation));
}

void collect(const Circumstances& c, const Search& s, Trace& out) {
  const JointFit& fit = s.found;
  if (out.vetoed) {
    out.statements.push_back("an effect was found in the training data, but the final blocks are predicted no better "
                             "with it: nothing is added");
    for (const Step& step : s.steps)
      if (step.kind == Kind::named || step.kind == Kind::equivalence_class)
        out.statements.push_back(
            fmt::format("refused by the final blocks: {} (p = {:.2g})", fmt::join(step.members, ", "), step.p_value));
  }
  for (const Step& found : s.steps) {
    Step step = found;
    const bool told = std::any_of(s.steps.begin(), s.steps.end(), [&](const Step& other) {
      return other.kind == Kind::scatter && other.component == step.component;
    });
    if (out.vetoed && step.kind == Kind::equivalence_class && step.component >= 0 && !told) { // the scatter remains
      const Grouping& redone = c.observations.redone[static_cast<std::size_t>(step.component)];
      step.kind = Kind::scatter;
      step.members = {"scatter:" + redone.name};
      step.depends_on = redone.labels;
      step.terms.clear();
    }
    if (out.vetoed && (step.kind == Kind::named || step.kind == Kind::equivalence_class)) continue;
    Finding f;
    f.kind = step.kind;
    f.members = step.members;
    f.p_value = step.p_value;
    f.depends_on = step.depends_on;
    f.remarks = step.remarks;
    f.removed_share = step.removed_share;
    f.name = step.kind == Kind::not_in_catalogue ? "not in the catalogue" : step.members.front();
    if (step.kind == Kind::equivalence_class) f.name = fmt::format("{}", fmt::join(step.members, " | "));
    for (const std::size_t t : step.terms) {
      const Index first = first_column(fit, t), d = fit.terms[t].size.size();
      Vector u(d);
      for (Index j = 0; j < d; ++j) u[j] = std::sqrt(fit.covariance(first + j, first + j));
      if (step.kind == Kind::not_in_catalogue) {
        add_curve(c, fit, t, f);
        continue;
      }
      f.quantities = sizes(c, fit.terms[t], u, step.threshold, fit);
      remark_on_size(fit.terms[t], f);
    }
    if (step.kind == Kind::equivalence_class) {
      f.alternatives.push_back(f.quantities);
      for (const Term& rival : step.rivals) {
        auto terms = fit.terms;
        terms[step.terms[0]] = rival;
        JointFit with = c.fitter.fit(terms, fit.noise, &fit);
        c.fitter.widen_jumping(with);
        const Index first = first_column(with, step.terms[0]);
        Vector u(rival.size.size());
        for (Index j = 0; j < u.size(); ++j) u[j] = std::sqrt(with.covariance(first + j, first + j));
        f.alternatives.push_back(sizes(c, with.terms[step.terms[0]], u, step.threshold, with));
        for (const Index row : c.fitter.rows())
          f.spread += (with.residual[row] - fit.residual[row]) * (with.residual[row] - fit.residual[row]);
      }
      f.spread = std::sqrt(f.spread / static_cast<double>(step.members.size() * c.fitter.rows().size()));
      f.suggestion = splitting_measurement(c, s, step);
      if (step.component >= 0) {
        const auto group = fmt::format(
            "{}", fmt::join(c.observations.redone[static_cast<std::size_t>(step.component)].labels, " and "));
        if (!f.suggestion.empty()) f.suggestion += "; and ";
        f.suggestion +=
            step.depends_on == std::vector<std::string>{"time"}
                ? fmt::format("measure the same again within one {}, as much later as the next one is", group)
                : fmt::format("within one {} vary {} as much as from one to the next", group,
                              fmt::join(step.depends_on, " and "));
      }
      if (f.suggestion.empty()) f.remarks.push_back("no change of a condition that was tried would tell them apart");
    }
    if (step.kind == Kind::scatter) describe_scatter(c, out.vetoed ? s.base : fit, step, f);
    out.findings.push_back(std::move(f));
  }
  out.outcome = out.findings.empty() ? Outcome::nothing_found : Outcome::found;
}

void speak(Trace& out) {
  const Rms& r = out.rms;
  if (out.outcome == Outcome::insufficient_data) {
    out.plain = {"These data cannot tell what the model lacks."};
    if (!out.statements.empty()) out.plain.push_back("Why: " + out.statements.back() + ".");
    return;
  }
  if (out.findings.empty() && out.vetoed) {
    out.plain = {
        "Something was found in the data of the search, but readings kept apart are predicted no better with it.",
        "Nothing is added to the model; measure more blocks to decide."};
    return;
  }
  if (out.findings.empty()) {
    out.plain.push_back(
        fmt::format("The measured values agree with the model: what is left ({}) is no more than its noise ({}).",
                    length(r.before, r), length(r.noise, r)));
    out.plain.push_back("Effects smaller than the detection limits may still be there; the table lists them.");
    return;
  }
  const Finding& f = out.findings.front();
  std::string size;
  if (!f.quantities.empty())
    size = fmt::format(" ({} {})", f.quantities[0].name,
                       shown(f.quantities[0].value, f.quantities[0].unit, f.quantities[0].si_unit));
  switch (f.kind) {
  case Kind::named:
    if (f.name.starts_with("declared:"))
      out.plain.push_back(fmt::format("What the scenario declares is not what the readings show: {}{}.",
                                      f.name.substr(std::string("declared:").size()), size));
    else
      out.plain.push_back(fmt::format("The machine does something that the model leaves out: {}{}.", f.name, size));
    break;
  case Kind::equivalence_class:
    out.plain.push_back(
        fmt::format("The machine does something that the model leaves out, one of: {}; these data cannot tell which.",
                    fmt::join(f.members, ", ")));
    break;
  case Kind::scatter:
    out.plain.push_back(fmt::format("The readings scatter more than declared from one {} to the next{}.",
                                    fmt::join(f.depends_on, " and "), size));
    break;
  case Kind::not_in_catalogue:
    out.plain.push_back(fmt::format("Something that no known effect explains changes the readings with {}.",
                                    fmt::join(f.depends_on, " and ")));
    break;
  }
  if (f.kind == Kind::scatter)
    out.plain.push_back("No correction removes it; it belongs into the uncertainty budget.");
  else if (f.kind == Kind::equivalence_class && !f.suggestion.empty())
    out.plain.push_back("To tell: " + f.suggestion + ".");
  else if (std::isfinite(r.holdout_after))
    out.plain.push_back(
        fmt::format("On readings kept apart the error falls from {} to {} with it; noise alone gives {}.",
                    length(r.holdout_before, r), length(r.holdout_after, r), length(r.holdout_noise, r)));
  else
    out.plain.push_back(fmt::format(
        "In the data of the search the error falls from {} to {} with it; no readings were kept apart to check.",
        length(r.before, r), length(r.after, r)));
}

} // namespace gumshoe::tracing
