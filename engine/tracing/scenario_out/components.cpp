#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "scenario/quantity.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"
#include "tracing/scenario_out/composition.h"
#include "tracing/scenario_out/corrections.h"

namespace gumshoe::tracing {
namespace {

class Components {
public:
  Components(const TraceContext& c, const Search& s, Trace& out) : c_(c), fit_(s.found), out_(out) {}

  /// A component of an indication's noise. Readings of different noise share no draw: there it is drawn for each.
  void of_noise(std::size_t indication, double u, std::vector<std::string> per, std::string source,
                double degrees_of_freedom = std::numeric_limits<double>::infinity()) {
    const auto& card = c_.experiment.model().card->indications[indication];
    if (!(u > 0)) return;
    for (const auto& q : out_.extended.quantities)
      if (q.name == card.name && q.entries.size() > 1 && per != std::vector<std::string>{"reading"}) {
        per = {"reading"};
        source += "; drawn for each reading, since their declared noise differs";
      }
    out_.additions.push_back({std::string(card.name),
                              units::error_unit(std::string(card.unit), std::string(card.si_unit)),
                              std::string(card.si_unit), u, std::move(per), std::move(source), degrees_of_freedom});
  }

  /// The part of an indication's noise that grows with a condition: u at its largest value.
  void growing(std::size_t indication, double u, const NoiseGrowth& grows, const std::string& source,
               double degrees_of_freedom) {
    const auto& card = c_.experiment.model().card->indications[indication];
    const Covariate& x = c_.observations.covariates[grows.covariate];
    Correction effect = noise_effect(card, x.name, "grows with", source);
    effect.keys = {{x.name, x.unit, x.si_unit, {std::min(0.0, x.levels.front()), std::max(0.0, x.levels.back())}}};
    for (const double level : effect.keys[0].levels) effect.loading.push_back(level / grows.largest);
    out_.additions.push_back(
        {effect.name + ".size", effect.unit, effect.si_unit, u, {"reading"}, source, degrees_of_freedom});
    out_.statements.push_back(
        fmt::format("the noise of {} grows with {}: u = {} at {} and {} at {}; readings are weighted so", card.name,
                    x.name, shown_size(u / grows.ratio, effect.unit, effect.si_unit), "0" + units::suffix(x.unit),
                    shown_size(u, effect.unit, effect.si_unit), shown_size(grows.largest, x.unit, x.si_unit)));
    out_.noise_effects.push_back(std::move(effect));
  }

  /// The noise of an indication that the groups of a label have beyond the least of them. @param u  of a ratio of 1
  void by_label(std::size_t indication, double u, const NoiseByLabel& differs, const std::string& source) {
    const auto& card = c_.experiment.model().card->indications[indication];
    const Grouping& label = *differs.label;
    Correction effect = noise_effect(card, label.name, "differs by", source);
    const auto& ratios = differs.ratio[indication];
    const auto& freedoms = differs.freedom[indication];
    const double least = std::pow(*std::ranges::min_element(ratios), 2);
    std::map<double, std::vector<std::string>> told; // by ratio
    for (std::size_t g = 0; g < label.groups.size(); ++g) {
      quantities::Labels of;
      for (std::size_t l = 0; l < label.labels.size(); ++l) of.emplace_back(label.labels[l], label.values[g][l]);
      const double ratio = ratios[g], freedom = freedoms[g];
      out_.additions.push_back({effect.name + ".size",
                                effect.unit,
                                effect.si_unit,
                                u * std::sqrt(ratio * ratio - least),
                                {"reading"},
                                source,
                                freedom > 0 ? freedom : std::numeric_limits<double>::infinity(),
                                std::move(of)});
      told[ratio].push_back(fmt::format("{}", fmt::join(label.values[g], " ")));
    }
    if (label.labels.size() == 1) {
      double square = 0, freedom = 0;
      for (std::size_t g = 0; g < label.groups.size(); ++g) {
        square += freedoms[g] * (ratios[g] * ratios[g] - least);
        freedom += freedoms[g];
      }
      out_.additions.push_back({effect.name + ".size",
                                effect.unit,
                                effect.si_unit,
                                u * std::sqrt(square / freedom),
                                {"reading"},
                                source + "; of others what these have on average",
                                std::numeric_limits<double>::infinity(),
                                {{label.labels[0], scenario::any_other}}});
    }
    std::vector<std::string> sizes;
    for (const auto& [ratio, groups] : told)
      sizes.push_back(
          fmt::format("{} of {}", shown_size(u * ratio, effect.unit, effect.si_unit), fmt::join(groups, " and ")));
    out_.statements.push_back(fmt::format("the noise of {} differs by {}: u = {}; readings are weighted so", card.name,
                                          label.name, fmt::join(sizes, ", ")));
    out_.noise_effects.push_back(std::move(effect));
  }

  /// What single readings scatter beyond what is declared.
  void larger(const Finding& f) {
    for (const MoreNoise& one : larger_noise(fit_, f)) of_noise(one.indication, one.u, {"reading"}, source_of(f));
  }

  /// What the readings of a group share: a finding of its own or not, new readings scatter so.
  void shared(const Component& component) {
    const auto& labels = component.group->labels;
    const auto f = std::ranges::find_if(
        out_.findings, [&](const Finding& one) { return one.kind == Kind::scatter && one.depends_on == labels; });
    const bool found = f != out_.findings.end() && !f->quantities.empty();
    std::string source = found ? source_of(*f)
                               : fmt::format("scatter by {}, fitted to these readings; no finding of its own",
                                             fmt::join(labels, " and "));
    if (found && f->quantities[0].low95 < f->quantities[0].high95)
      source += fmt::format("; 95 % interval of u in the indication: {} to {}",
                            shown_size(f->quantities[0].low95, f->quantities[0].unit, f->quantities[0].si_unit),
                            shown_size(f->quantities[0].high95, f->quantities[0].unit, f->quantities[0].si_unit));
    const std::vector<MoreNoise> more = noise_of(component, fit_);
    const auto seat = seat_at_null(c_.experiment);
    if (const double loading = found && seat && fit_.design.indications == 1 ? loading_of(*seat) : 0; loading > 0) {
      const auto& q = c_.experiment.scenario().quantities[*seat];
      out_.additions.push_back({q.name, q.unit, q.si_unit, more[0].u / loading, labels, source, component.freedom});
      return;
    }
    for (const MoreNoise& one : more) of_noise(one.indication, one.u, labels, source, component.freedom);
  }

  void not_in_catalogue(const SearchFinding& found, const Finding& f, const std::vector<Vector>& left) {
    std::vector<std::string> per{"reading"};
    for (const Grouping& g : c_.observations.labels)
      if (f.depends_on == std::vector<std::string>{g.name}) per = {g.name};
    const bool corrected = std::ranges::all_of(found.terms, [&](std::size_t t) { return left[t].isZero(0); });
    for (std::size_t i = 0; i < fit_.design.indications && !corrected; ++i) {
      double square = 0, count = 0;
      for (const Index row : c_.fitter.rows()) {
        if (index(row) % fit_.design.indications != i) continue;
        double sum = 0;
        for (const std::size_t t : found.terms) sum += left[t][row];
        square += sum * sum;
        ++count;
      }
      of_noise(
          i, std::sqrt(square / count), per,
          fmt::format("not in the catalogue, p = {:.2g}: depends on {}; not corrected (JCGM 100:2008, F.2.4.5); u is "
                      "the root mean square of the effect found",
                      f.p_value, fmt::join(f.depends_on, " and ")));
    }
  }

  /// Noise of a reading that was not declared.
  void estimated(const FittedScatter& scatter) {
    const std::string source = "noise, estimated from the residuals of these readings";
    for (std::size_t i = 0; i < fit_.design.indications; ++i) {
      double u = fit_.design.reference[i] * std::sqrt(scatter.variance / c_.fitter.mean_variance(i));
      double freedom = scatter.freedom;
      if (c_.fitter.noise_of_each()) freedom /= static_cast<double>(fit_.design.indications);
      if (const auto& grows = c_.fitter.noise_growth()) growing(i, u * grows->ratio, *grows, source, freedom);
      if (const auto& differs = c_.fitter.noise_by_label()) {
        const auto& ratio = differs->ratio[i];
        const auto least = std::ranges::min_element(ratio);
        if (*std::ranges::max_element(ratio) > *least) by_label(i, u, *differs, source);
        u *= *least;
        if (const double own = differs->freedom[i][index(least - ratio.begin())]; own > 0)
          freedom = std::min(freedom, own);
      }
      of_noise(i, beyond_display(i, u), {"reading"}, source, freedom);
    }
  }

private:
  /// What the noise of an indication has in addition to the step of its display, which stays declared.
  double beyond_display(std::size_t indication, double u) const {
    const auto& s = c_.experiment.scenario();
    const double step = s.quantities[c_.experiment.layout().indications[indication]].display_alone;
    return std::sqrt(std::max(0.0, u * u - step * step / 12));
  }

  /// A stated effect whose size is noise, of a reading each.
  static Correction noise_effect(const VariableCard& card, const std::string& by, const char* how,
                                 const std::string& source) {
    Correction out;
    out.name = fmt::format("noise_of_{}_by_{}", card.name, by);
    out.indication = card.name;
    out.si_unit = card.si_unit;
    out.unit = unit_of_size(card);
    out.meaning = fmt::format("noise of {} that {} {}", card.name, how, by);
    out.source = source;
    return out;
  }

  static std::string source_of(const Finding& f) {
    return fmt::format("scatter by {}, p = {:.2g}", fmt::join(f.depends_on, " and "), f.p_value);
  }

  /// Change of the indication with a quantity, root mean square; 0 if the model has no derivative there.
  double loading_of(std::size_t quantity) const {
    Vector f;
    Matrix derivative;
    if (!c_.simulator.derivatives(fit_.at, {quantity}, f, derivative)) return 0;
    return std::sqrt(derivative.squaredNorm() / static_cast<double>(derivative.rows()));
  }

  const TraceContext& c_;
  const JointFit& fit_;
  Trace& out_;
};

} // namespace

void add_components(const TraceContext& c, const Search& s, const std::vector<Vector>& left, Trace& out) {
  Components components(c, s, out);
  const FittedScatter scatter = fitted_scatter(c, s.found, s.findings);
  for (const Finding& f : out.findings) components.larger(f);
  for (std::size_t i = 0; i < s.findings.size() && i < out.findings.size(); ++i)
    if (out.findings[i].kind == Kind::not_in_catalogue)
      components.not_in_catalogue(s.findings[i], out.findings[i], left);
  for (const Component& one : scatter.components) components.shared(one);
  if (!c.fitter.noise_declared()) components.estimated(scatter);
}

} // namespace gumshoe::tracing
