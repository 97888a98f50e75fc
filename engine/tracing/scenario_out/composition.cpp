#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <Eigen/QR>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/rounding.h"
#include "base/units.h"
#include "quantities/cells.h"
#include "quantities/effect_of.h"
#include "scenario/quantity.h"
#include "tracing/criteria.h"
#include "tracing/scenario_out/composition.h"
#include "tracing/scenario_out/corrections.h"
#include "tracing/scenario_out/lines.h"
#include "tracing/scenario_out/sources.h"

namespace gumshoe::tracing {
namespace {

using quantities::Labels;

class Composer {
public:
  Composer(const TraceContext& c, const Search& s, Trace& out) : c_(c), s_(s), out_(out), fit_(s.found) {}

  void compose() {
    c_.fitter.settle(fit_);
    at_ = c_.fitter.without_draws(fit_);
    write_shapes();
    absorb_shapes();
    constants();
    for (std::size_t t = 0; t < fit_.terms.size(); ++t)
      if (written_[t])
        correction(t);
      else
        term(t);
    add_components(c_, s_, left_, out_);
    known_draws();
    write();
    correlate();
  }

private:
  /// Shapes that can be written as corrections; they keep what the fit gave them.
  void write_shapes() {
    const auto taken = [&](const std::string& name) {
      const auto& quantities = out_.extended.quantities;
      return std::ranges::any_of(quantities, [&](const auto& q) {
        return q.name == name || q.name.starts_with(name + '.') || q.name.starts_with(name + '_');
      });
    };
    int number = 1;
    for (const Term& t : fit_.terms) {
      written_.emplace_back();
      if (!t.candidate.amplitudes[0].scenario_name.empty()) continue;
      while (taken(fmt::format("shape_{}", number))) ++number;
      written_.back() = written_shape(c_, t, fmt::format("shape_{}", number++));
    }
  }

  /// The sizes of a shape, one for each stated effect, or by label.
  void correction(std::size_t t) {
    const Term& one = fit_.terms[t];
    const Finding* f = finding_of(t);
    const std::string source =
        fmt::format("not in the catalogue{}: depends on {}", f ? fmt::format(", p = {:.2g}", f->p_value) : "",
                    fmt::join(one.candidate.depends_on, " and "));
    for (Correction& c : written_[t]->effects) {
      const auto j = static_cast<std::size_t>(&c - written_[t]->effects.data());
      const double margin = margin_of(c);
      c.source = source + "; known at the levels measured, and linear between those of one condition" +
                 (margin > 0 ? fmt::format(", and for {:g} % of the range beyond them", 100 * margin) : "") +
                 (before_and_after(c) ? "; beyond them as at the ends" : "");
      out_.extended.quantities.push_back({c.name + ".size", c.unit, c.si_unit, {}, true});
      sizes(t, written_[t]->shares[j], source);
      out_.corrections.push_back(c);
    }
    if (one.candidate.name.starts_with("hysteresis:") && depends_on_time(written_[t]->effects))
      out_.statements.push_back(
          fmt::format("the correction of {} is known by time alone; state the direction as a condition, "
                      "{{ column = \"...\", sense = true }} with the column of {}, and trace again",
                      one.candidate.name, one.candidate.depends_on[0]));
  }

  bool depends_on_time(const std::vector<Correction>& effects) const {
    return std::ranges::any_of(effects, [&](const Correction& c) {
      return std::ranges::any_of(c.keys, [&](const Correction::Key& key) {
        return std::ranges::any_of(c_.observations.covariates,
                                   [&](const Covariate& x) { return x.course && x.name == key.name; });
      });
    });
  }

  /// The sizes of an effect: one, or one for each group of the label.
  void sizes(std::size_t t, const Matrix& shares, const std::string& source) {
    const std::size_t q = out_.extended.quantities.size() - 1;
    auto& entries = out_.extended.quantities[q].entries;
    const Grouping* const label = written_[t]->label;
    std::vector<bool> done(index(shares.rows()), false);
    for (const std::size_t reading : c_.observations.sequence) {
      const std::size_t group = label ? label->group[reading] : 0;
      if (done[group]) continue;
      done[group] = true;
      entries.emplace_back();
      for (std::size_t l = 0; label && l < label->labels.size(); ++l)
        entries.back().labels.emplace_back(label->labels[l], label->values[group][l]);
      Line line{unknown(q, entries.size() - 1), 0, {}, {false, entries.back().labels, source}};
      if (shares.row(index(group)).hasNaN())
        of_a_group_not_measured(fit_, t, written_[t]->shares, line);
      else
        of_shares(fit_, t, shares.row(index(group)), line);
      lines_.push_back(std::move(line));
    }
    if (label && label->labels.size() == 1) others(t, *label, shares, source);
  }

  /// A group that these data do not have is one more of those that differ.
  void others(std::size_t t, const Grouping& label, const Matrix& shares, const std::string& source) {
    const auto& size = out_.extended.quantities.back();
    Line line{{}, 0, {}, {false, {}, source}};
    const std::size_t measured = of_a_group_not_measured(fit_, t, {shares}, line);
    if (measured < criteria.least_groups_for_others) return;
    const double u = std::sqrt(covariance_of(fit_.covariance, line.made_of, line.made_of) + line.spread * line.spread);
    out_.additions.push_back({size.name,
                              size.unit,
                              size.si_unit,
                              u,
                              {},
                              line.taken.source,
                              static_cast<double>(measured - 1),
                              {{label.labels[0], scenario::any_other}},
                              line.value + 0.0}); // no -0
  }

  /// What cannot be written as a correction is noise; free unknowns take as much of it as they can follow.
  void absorb_shapes() {
    const auto n = fit_.design.fixed.rows(), p = index(c_.fitter.unknowns().size());
    absorbed_ = Vector::Zero(p);
    std::vector<Index> all(index(n));
    std::iota(all.begin(), all.end(), 0);
    Design own = fit_.design;
    own.fixed = Matrix(fit_.design.fixed.leftCols(p));
    const auto use = independent(own, all);
    Vector scale(n);
    for (Index i = 0; i < n; ++i) scale[i] = 1 / own.reference[index(i) % own.indications];
    const Matrix free = own.fixed(Eigen::all, use);
    for (std::size_t t = 0; t < fit_.terms.size(); ++t) {
      const Term& term = fit_.terms[t];
      left_.emplace_back(Vector::Zero(n));
      if (written_[t] || !term.candidate.amplitudes[0].scenario_name.empty()) continue;
      left_.back() = term.candidate.columns * term.size;
      if (use.empty()) continue;
      const Vector x = (scale.asDiagonal() * free).colPivHouseholderQr().solve(scale.asDiagonal() * left_.back());
      left_.back() -= free * x;
      for (std::size_t i = 0; i < use.size(); ++i) absorbed_[use[i]] += x[index(i)];
    }
  }

  calibration::Unknown unknown(std::size_t quantity, std::size_t entry) const {
    const auto& q = out_.extended.quantities[quantity];
    Labels labels = q.entries[entry].labels;
    std::ranges::sort(labels); // as draws are named
    const std::string name = q.name + (labels.empty() ? "" : "[" + quantities::text_of(labels) + "]");
    return {.name = name, .quantity = quantity, .entry = entry, .unit = q.unit, .si_unit = q.si_unit};
  }

  /// At the first reading for which an entry holds.
  double value_at(std::size_t quantity, const Labels& labels) const {
    for (std::size_t r = 0; r < at_.size(); ++r)
      if (quantities::holds_for(labels, c_.experiment.scenario().readings[r].labels)) return at_[r][quantity];
    return 0;
  }

  /// Free unknowns, the offsets of blocks among them.
  void constants() {
    for (std::size_t u = 0; u < c_.fitter.unknowns().size(); ++u) {
      const FreeUnknown& free = c_.fitter.unknowns()[u];
      const auto column = index(u);
      if (!std::isfinite(fit_.covariance(column, column))) continue;
      const auto& quantity = out_.extended.quantities[free.quantity];
      const auto& entry = quantity.entries[free.entry];
      if (free.jump > 0) out_.jumping.push_back({quantity.name, quantity.unit, quantity.si_unit, free.jump});
      lines_.push_back({unknown(free.quantity, free.entry),
                        value_at(free.quantity, entry.labels) + absorbed_[column],
                        {{column, 1}},
                        {true, entry.labels,
                         fit_.terms.empty() ? "fitted to these readings"
                                            : "fitted to these readings together with what was found"}});
    }
  }

  const Finding* finding_of(std::size_t term) const {
    for (std::size_t i = 0; i < s_.findings.size() && i < out_.findings.size(); ++i)
      if (std::ranges::find(s_.findings[i].terms, term) != s_.findings[i].terms.end()) return &out_.findings[i];
    return nullptr;
  }

  /// Sizes of effects; of a description nothing.
  void term(std::size_t t) {
    const Term& one = fit_.terms[t];
    if (one.candidate.amplitudes[0].scenario_name.empty()) return;
    const Finding* f = finding_of(t);
    for (const auto& [shape, value] : one.candidate.held)
      if (std::ranges::none_of(one.candidate.amplitudes, [&](const Amplitude& a) { return a.quantity == shape; }))
        lines_.push_back({unknown(shape, 0), value, {}, {false, {}, "held at the best of the values tried"}});
    for (std::size_t j = 0; j < one.candidate.amplitudes.size(); ++j) {
      const Amplitude& a = one.candidate.amplitudes[j];
      const Index column = first_column(fit_, t) + index(j);
      const std::string source = f ? source_of(*f, a, c_.experiment.scenario()) : "";
      if (a.is_shape && !(std::sqrt(fit_.covariance(column, column)) <
                          criteria.normal_shape * std::fabs(a.held + one.size[index(j)]))) {
        lines_.push_back({unknown(a.quantity, 0),
                          a.held + one.size[index(j)],
                          {},
                          {false, {}, source + "; held, because a normal distribution would reach beyond zero", true}});
        continue;
      }
      if (!one.candidate.start.empty()) out_.jumping.push_back({a.scenario_name, a.unit, a.si_unit, found_size(one)});
      if (f && f->spread > 0 && !a.is_shape) widen(*f, t, index(j), column);
      if (a.quantity == Amplitude::npos)
        lines_.push_back({unknown(stated(a), 0), one.size[index(j)], {{column, 1}}, {false, {}, source}});
      else
        shifted(a, column, source);
    }
  }

  /// The members' predictions differ: the size is no better known than that (JCGM 100, F.2.4.5, in its spirit).
  void widen(const Finding& f, std::size_t t, Index j, Index column) {
    double square = 0;
    for (const Index row : c_.fitter.rows())
      square += fit_.terms[t].candidate.columns(row, j) * fit_.terms[t].candidate.columns(row, j);
    if (!(square > 0)) return;
    fit_.covariance(column, column) += f.spread * f.spread * static_cast<double>(c_.fitter.rows().size()) / square;
  }

  /// The size of a stated effect, which a scenario without it does not count among its quantities.
  std::size_t stated(const Amplitude& a) {
    auto& quantities = out_.extended.quantities;
    for (std::size_t q = 0; q < quantities.size(); ++q)
      if (quantities[q].name == a.scenario_name) return q;
    quantities.push_back({a.scenario_name, a.unit, a.si_unit, {quantities::Entry{}}, true});
    return quantities.size() - 1;
  }

  /// A quantity of model or effect: every entry that the shift moves. One that holds for more readings is taken apart.
  void shifted(const Amplitude& a, Index column, const std::string& source) {
    auto& entries = out_.extended.quantities[a.quantity].entries;
    std::vector<quantities::Entry> apart;
    for (const auto& entry : entries) {
      Labels missing;
      for (const auto& label : a.labels)
        if (!quantities::label_value(entry.labels, label.first)) missing.push_back(label);
      if (missing.empty()) {
        apart.push_back(entry);
        continue;
      }
      for (const auto& component : entry.components)
        if (std::ranges::any_of(missing, [&](const auto& l) {
              return std::ranges::find(component.per, l.first) == component.per.end();
            }))
          out_.statements.push_back(
              fmt::format("in the traced scenario {} has values by label; what was declared for all of "
                          "them together applies to each separately",
                          out_.extended.quantities[a.quantity].name));
      std::set<Labels> seen;
      for (const auto& reading : c_.experiment.scenario().readings) {
        if (!quantities::holds_for(entry.labels, reading.labels)) continue;
        quantities::Entry own = entry;
        for (const auto& [label, value] : missing)
          if (const std::string* here = quantities::label_value(reading.labels, label))
            own.labels.emplace_back(label, *here);
        if (seen.insert(own.labels).second) apart.push_back(std::move(own));
      }
    }
    entries = std::move(apart);
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const bool moved = quantities::holds_for(a.labels, entries[e].labels);
      // An effect of one part is exactly null at the others.
      const bool null = !moved && !quantities::effect_of(a.scenario_name).empty() && entries[e].components.empty();
      if (!moved && !null) continue;
      const Line line{unknown(a.quantity, e),
                      value_at(a.quantity, entries[e].labels),
                      null ? MadeOf{} : MadeOf{{column, 1}},
                      {false, moved ? a.labels : entries[e].labels, source}};
      // Found off twice, for all and for some: the later shift comes on top, and the value holds both.
      const auto known =
          std::ranges::find_if(lines_, [&](const Line& l) { return l.unknown.name == line.unknown.name; });
      if (known == lines_.end())
        lines_.push_back(line);
      else if (moved)
        known->made_of = line.made_of, known->taken = line.taken;
    }
  }

  /// Declared draws that all readings of an entry share, as these readings know them.
  void known_draws() {
    const DrawsGivenReadings given = c_.fitter.draws_given_readings(fit_);
    if (!given.informed && given.largest_correlation < criteria.told_correlation) return;
    const auto& plan = c_.experiment.plan();
    for (std::size_t i = 0; i < given.draws.size(); ++i) {
      const quantities::Variate& v = plan.variates[given.draws[i]];
      const auto& q = c_.experiment.scenario().quantities[v.quantity];
      const auto& entry = q.entries[v.entry];
      const auto& component = entry.components[v.component];
      const bool moved = out_.extended.quantities[v.quantity].entries.size() != q.entries.size() ||
                         std::ranges::any_of(lines_, [&](const Line& l) {
                           return l.unknown.quantity == v.quantity && l.unknown.entry == v.entry;
                         });
      if (!component.per.empty() || moved) continue;
      const Index at = fit_.design.fixed.cols() + index(i);
      // Where readings jump, a draw stays where the step to its mean by the linearised model is none for the better.
      const double u = v.distribution.standard_uncertainty(), stands = fit_.drawn[index(given.draws[i])],
                   mean = given.mean[index(i)],
                   x = std::fabs(mean - stands) > criteria.converged * std::sqrt(given.covariance(at, at)) ? stands
                                                                                                           : mean;
      known_at_.push_back(at);
      out_.known.push_back({q.name, q.unit, q.si_unit, entry.labels, v.component,
                            entry.components.size() > 1 ? component.name : "",
                            entry.value + v.distribution.mean() + u * x, u * std::sqrt(given.covariance(at, at))});
    }
    given_ = given.covariance;
  }

  /// Correlation of parameters and known draws.
  void correlate() {
    if (out_.known.empty()) return;
    const std::size_t p = lines_.size(), n = p + known_at_.size();
    const auto of = [&](std::size_t i) { return i < p ? lines_[i].made_of : MadeOf{{known_at_[i - p], 1}}; };
    const auto covariance = [&](std::size_t i, std::size_t j) {
      return covariance_of(given_, of(i), of(j)) + (i == j && i < p ? lines_[i].spread * lines_[i].spread : 0);
    };
    out_.correlation.assign(n * n, 0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        double& r = out_.correlation[i * n + j];
        if (i < p && j < p)
          r = out_.estimate.correlation[i * p + j];
        else if (const double square = covariance(i, i) * covariance(j, j); square > 0)
          r = i == j ? 1 : std::clamp(covariance(i, j) / std::sqrt(square), -1.0, 1.0);
      }
  }

  void write() {
    const std::size_t n = lines_.size();
    calibration::Estimate& e = out_.estimate;
    e.noise_declared = true; // u as found, no degrees of freedom
    e.covariance.assign(n * n, 0);
    e.correlation.assign(n * n, 0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        e.covariance[i * n + j] = e.covariance[j * n + i] =
            covariance_of(fit_.covariance, lines_[i].made_of, lines_[j].made_of) +
            (i == j ? lines_[i].spread * lines_[i].spread : 0);
    const auto u = [&](std::size_t i) { return std::sqrt(e.covariance[i * n + i]); };
    for (std::size_t i = 0; i < n; ++i) {
      e.parameters.push_back({lines_[i].unknown, lines_[i].value, u(i), false});
      out_.taken.push_back(lines_[i].taken);
      out_.extended.quantities[lines_[i].unknown.quantity].estimated = true;
      for (std::size_t j = 0; j < n; ++j)
        if (u(i) > 0 && u(j) > 0)
          e.correlation[i * n + j] = i == j ? 1 : std::clamp(e.covariance[i * n + j] / (u(i) * u(j)), -1.0, 1.0);
    }
    for (const Row& row : out_.rows)
      if (!row.held_out) e.rows.push_back({row.reading, row.indication});
  }

  const TraceContext& c_;
  const Search& s_;
  Trace& out_;
  JointFit fit_;
  Points at_;                                        ///< of the fit, declared draws at null
  std::vector<std::optional<WrittenShape>> written_; ///< by term: a shape as a correction
  Vector absorbed_;                                  ///< by unknown: what it takes of shapes
  std::vector<Vector> left_;                         ///< by term: what no unknown takes
  std::vector<Line> lines_;
  Matrix given_;                ///< covariance of the fixed columns and the declared draws
  std::vector<Index> known_at_; ///< by known draw: its row there
};

} // namespace

void compose(const TraceContext& c, const Search& s, Trace& out) { Composer(c, s, out).compose(); }

} // namespace gumshoe::tracing
