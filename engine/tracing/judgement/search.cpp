#include "tracing/judgement/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "tracing/candidates/shapes.h"
#include "tracing/judgement/cross_validation.h"
#include "tracing/judgement/ranking.h"

namespace gumshoe::tracing {
namespace {

/// Likelihood ratios closer than this (2 ln, chi-squared 0.95 of one) decide nothing.
constexpr double decisive = 3.84;
/// Beyond this no simulation is needed.
constexpr double beyond_doubt = 25;
/// Projected signatures as alike as this are one and the same to any data of this design.
constexpr double alike = 0.995;
constexpr std::size_t most_findings = 5;

class Searcher {
public:
  explicit Searcher(const Circumstances& c) : c_(c) {}

  Search run() {
    say("fits the declared model");
    out_.base = out_.found = c_.fitter.fit({}, 0);
    const auto mean_square = [](const JointFit& fit) { return fit.noise * fit.noise * fit.variance; };
    for (bool more = true; more && out_.steps.size() < most_findings;) {
      const double before = mean_square(out_.found);
      const std::size_t known = out_.steps.size();
      more = step();
      for (std::size_t i = known; i < out_.steps.size(); ++i)
        out_.steps[i].removed_share = (before - mean_square(out_.found)) / mean_square(out_.base) /
                                      static_cast<double>(out_.steps.size() - known);
    }
    c_.fitter.widen_jumping(out_.found);
    return std::move(out_);
  }

private:
  void say(const std::string& what) const {
    if (c_.progress) c_.progress(what);
  }

  bool taken(const Alternative& a) const {
    for (const Term& t : out_.found.terms)
      if (t.alternative.name == a.name && (a.amplitudes[0].scenario_name.empty() ||
                                           t.alternative.amplitudes[0].scenario_name == a.amplitudes[0].scenario_name))
        return true;
    return false;
  }

  void prepare() {
    const JointFit& fit = out_.found;
    const double size = std::sqrt(std::max(1e-300, fit.variance)) * fit.design.reference[0];
    alternatives_ = physical_candidates(c_.experiment, c_.simulator, fit.at, c_.observations, 3 * size,
                                        [&](const Alternative& a) { return taken(a); });
    for (Alternative& a : shapes(c_.observations))
      if (!taken(a)) alternatives_.push_back(std::move(a));
    pointers_.clear();
    for (const Alternative& a : alternatives_) pointers_.push_back(&a);
    scan_ = std::make_unique<Scan>(fit.design, c_.fitter.rows(), pointers_, c_.threads);
    data_ = scan_->whitened(scan_->plain()).take(fit.residual);
  }

  /// Takes in one more effect; false if there is none.
  bool step() {
    say(out_.steps.empty() ? "looks for what the declared model lacks" : "looks for more");
    prepare();
    const double declared = c_.fitter.noise_declared() ? 1 / out_.found.noise : 0;
    assessment_ = assess(*scan_, data_, c_.draws, c_.seed + out_.steps.size(), c_.alpha, declared,
                         [&](const Structure& s, double variance) { return scatter_response(s, variance); });
    const bool first = out_.steps.empty() && out_.first.p.empty();
    if (first) {
      out_.first = assessment_;
      out_.alternatives = alternatives_;
      out_.tried = static_cast<int>(alternatives_.size()) + static_cast<int>(c_.observations.redone.size());
      out_.limits = detection_limits(*scan_, assessment_, alternatives_);
    }
    out_.last = assessment_;
    bool more = false;
    if (assessment_.p_anything <= c_.alpha && assessment_.p_signature <= c_.alpha) more = take_signature();
    if (!more && assessment_.p_anything <= c_.alpha) more = take_component();
    if (first) out_.candidates = ranking(*scan_, assessment_, alternatives_, out_.base.design, refused_);
    return more;
  }

  /// Where a clamping's seat makes readings jump, its draws must jump, too.
  Matrix scatter_response(const Structure& structure, double variance) const {
    const JointFit& fit = out_.found;
    const auto seat = seat_at_null(c_.experiment);
    if (!seat || structure.scatter < 0 || fit.design.indications > 1) return {};
    const double s = std::sqrt(variance), u = structure.ratio * fit.design.reference[0] * s;
    const Matrix bent = bent_response(c_.simulator, fit.at, *seat, u);
    return bent.size() > 0 ? Matrix(in_sequence(c_.observations, bent) / s) : bent;
  }

  double score(std::size_t a) const {
    return assessment_.data.ratio(static_cast<Index>(a), 0) - 2 * assessment_.null[a].mean;
  }

  /// The likelihood ratio of a term with the whole model, from the fit at hand; its size.
  struct Finalist {
    std::size_t alternative = 0;
    JointFit fit;
    double ratio = 0, score = 0;
  };

  Finalist refit(std::size_t a) const {
    Finalist out;
    out.alternative = a;
    auto terms = out_.found.terms;
    terms.push_back({alternatives_[a], scan_->fit(a, data_).size});
    out.fit = c_.fitter.fit(terms, out_.found.noise, &out_.found);
    if (!out.fit.valid) return out;
    // At the fitted size, beside the same unknowns as without the term.
    Design without = out.fit.design;
    without.fixed = Matrix(without.fixed.leftCols(without.fixed.cols() - alternatives_[a].columns.cols()));
    const Scan scan(without, c_.fitter.rows(), {}, c_.threads);
    out.ratio =
        assessment_.data.criterion[0] - scan.run(scan.whitened(scan.plain()).take(out.fit.residual)).criterion[0];
    if (!std::isfinite(out.ratio)) out.ratio = 0;
    out.score = out.ratio - 2 * assessment_.null[a].mean;
    return out;
  }

  double left_out(const JointFit& fit, const Structure& structure) const {
    return cross_validated(c_.observations, c_.fitter.rows(), fit, structure);
  }

  /// Parts of the training readings that are left out in turn: does the fit predict them better than without its term?
  bool predicts_better(const JointFit& fit) const {
    return left_out(fit, fit.structure) < left_out(out_.found, fit.structure);
  }

  /// The best alternatives of different names among those that `fits`, best first.
  std::vector<std::size_t> best_of(const std::function<bool(const Alternative&)>& fits, std::size_t most) const {
    std::vector<std::size_t> order;
    for (std::size_t a = 0; a < alternatives_.size(); ++a)
      if (fits(alternatives_[a]) && assessment_.data.ratio(static_cast<Index>(a), 0) > 0) order.push_back(a);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return score(a) > score(b); });
    std::vector<std::size_t> out;
    std::set<std::string> names;
    for (const std::size_t a : order) {
      if (out.size() == most) break;
      if (names.insert(alternatives_[a].name).second) out.push_back(a);
    }
    return out;
  }

  /// Chance that `better` would lead `than` by so much, were `than` the truth.
  double chance_of_lead(std::size_t better, std::size_t than, double lead) const {
    constexpr std::size_t sets = 199;
    const Fit truth = scan_->fit(than, data_);
    const Whitened& w = scan_->whitened(truth.structure);
    const Vector signal = w.take(alternatives_[than].columns) * truth.size;
    Departures departures = assessment_.departures;
    departures.scatter = scatter_response(scan_->all_structures()[truth.structure], out_.found.variance);
    Matrix drawn = w.draw(sets, c_.seed ^ 0x41a7ull, departures);
    const double s = std::sqrt(out_.found.variance);
    drawn = (s * drawn).colwise() + signal;
    const Scan both(out_.found.design, c_.fitter.rows(), {&alternatives_[better], &alternatives_[than]}, c_.threads);
    const Statistics statistics = both.run(drawn);
    const double shift = 2 * (assessment_.null[than].mean - assessment_.null[better].mean);
    int as_much = 0;
    for (Index j = 0; j < static_cast<Index>(sets); ++j)
      as_much += statistics.ratio(0, j) - statistics.ratio(1, j) + shift >= lead;
    return (1.0 + as_much) / (1.0 + sets);
  }

  bool take_signature() {
    const auto physical = best_of([](const Alternative& a) { return a.physical(); }, 12);
    const auto plain = best_of([](const Alternative& a) { return a.family == Family::shape; }, 3);
    // Finalists by the full model; only those that could still win are fitted.
    std::vector<Finalist> finalists;
    for (const std::size_t a : physical) {
      if (assessment_.p[a] > assessment_.threshold && !finalists.empty()) break;
      if (!finalists.empty() && score(a) < 0.6 * score(physical[0]) - 5) break;
      finalists.push_back(refit(a));
      if (!finalists.back().fit.valid) finalists.pop_back();
    }
    std::sort(finalists.begin(), finalists.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
    const bool significant =
        !finalists.empty() &&
        (assessment_.p[finalists[0].alternative] <= assessment_.threshold ||
         finalists[0].ratio > assessment_.null[finalists[0].alternative].quantile(assessment_.threshold));
    if (significant) {
      const Finalist& best = finalists[0];
      if (const auto better = refused_for(best, plain); better.empty()) {
        if (predicts_better(best.fit)) return take(finalists);
        refused_[best.alternative] = "refused: blocks held out are predicted no better with it";
      } else {
        if (take_pair(plain)) return true;
        for (const Finalist& f : finalists)
          refused_[f.alternative] = "refused: " + better + " fits better, as simple as it is";
      }
    }
    return take_shape();
  }

  /// A plain shape of no more parameters that fits better than the effect could let it; empty if there is none.
  std::string refused_for(const Finalist& best, const std::vector<std::size_t>& plain) const {
    for (const std::size_t g : plain) {
      const auto parameters = [&](std::size_t a) { return alternatives_[a].columns.cols(); };
      if (parameters(g) > parameters(best.alternative)) continue;
      const double lead = score(g) - best.score;
      if (lead < decisive) continue;
      if (lead > beyond_doubt || chance_of_lead(g, best.alternative, lead) < 0.01)
        return alternatives_[g].name + (alternatives_[g].shape.empty() ? "" : " (" + alternatives_[g].shape + ")");
    }
    return {};
  }

  /// One masks the other: two effects together that explain more than any shape alone.
  bool take_pair(const std::vector<std::size_t>& plain) {
    const auto many = best_of([](const Alternative& a) { return a.physical(); }, 60);
    const std::size_t k = assessment_.data.structure[0];
    double best = 0;
    std::pair<std::size_t, std::size_t> pair{0, 0};
    const auto all = physical_all();
    for (const std::size_t a : many)
      for (const std::size_t b : all) {
        if (b == a || alternatives_[a].name == alternatives_[b].name) continue;
        const double s = scan_->pair_ratio(a, b, data_, k) - 2 * (assessment_.null[a].mean + assessment_.null[b].mean);
        if (s > best) best = s, pair = {a, b};
      }
    const double shape = plain.empty() ? 0 : score(plain[0]);
    if (!(best > shape + decisive)) return false;
    for (const std::size_t a : {pair.first, pair.second}) {
      // Each must count beside the other.
      const std::size_t other = a == pair.first ? pair.second : pair.first;
      if (best - score(other) < assessment_.null[a].quantile(assessment_.threshold)) return false;
    }
    auto terms = out_.found.terms;
    for (const std::size_t a : {pair.first, pair.second}) {
      Term t{alternatives_[a], scan_->fit(a, data_).size};
      t.size.setZero();
      terms.push_back(std::move(t));
    }
    JointFit fit = c_.fitter.fit(terms, out_.found.noise, &out_.found);
    if (!fit.valid || !predicts_better(fit)) return false;
    for (const std::size_t a : {pair.first, pair.second}) {
      Step s;
      s.kind = Kind::named;
      s.members = {alternatives_[a].name};
      s.p_value = assessment_.p_signature;
      s.threshold = assessment_.null[a].quantile(assessment_.threshold);
      s.depends_on = alternatives_[a].depends_on;
      s.terms = {out_.found.terms.size() + (a == pair.first ? 0 : 1)};
      s.remarks.push_back("found together with " + alternatives_[a == pair.first ? pair.second : pair.first].name +
                          ": each hides the other");
      out_.steps.push_back(std::move(s));
      refused_[a] = "named";
    }
    out_.found = c_.fitter.fit(fit.terms, 0, &fit);
    return true;
  }

  std::vector<std::size_t> physical_all() const {
    std::vector<std::size_t> out;
    for (std::size_t a = 0; a < alternatives_.size(); ++a)
      if (alternatives_[a].physical() && scan_->identifiable(a) > absorbed_share) out.push_back(a);
    return out;
  }

  /// The best of the finalists, alone or with those that these data cannot tell from it.
  bool take(std::vector<Finalist>& finalists) {
    const Finalist& best = finalists[0];
    Step s;
    s.members = {alternatives_[best.alternative].name};
    s.p_value = assessment_.p_signature;
    s.threshold = assessment_.null[best.alternative].quantile(assessment_.threshold);
    s.depends_on = alternatives_[best.alternative].depends_on;
    s.terms = {out_.found.terms.size()};
    refused_[best.alternative] = "named";
    const std::size_t k = assessment_.data.structure[0];
    for (std::size_t i = 1; i < finalists.size(); ++i) {
      const Finalist& rival = finalists[i];
      const double lead = best.score - rival.score;
      const double correlation = scan_->correlation(best.alternative, rival.alternative, k);
      const bool same = correlation > alike && lead <= decisive; // by the whole model too
      if (!same && (lead > beyond_doubt ||
                    (lead > decisive && chance_of_lead(best.alternative, rival.alternative, lead) < 0.05))) {
        refused_[rival.alternative] = "refused: " + alternatives_[best.alternative].name + " fits better";
        continue;
      }
      // What still counts beside the best is another effect, not the same under another name.
      if (!same && scan_->pair_ratio(best.alternative, rival.alternative, data_, k) -
                           scan_->pair_ratio(best.alternative, best.alternative, data_, k) >
                       assessment_.null[rival.alternative].quantile(assessment_.threshold)) {
        refused_[rival.alternative] = "counts beside " + alternatives_[best.alternative].name;
        continue;
      }
      s.members.push_back(alternatives_[rival.alternative].name);
      s.rivals.push_back(rival.fit.terms.back());
    }
    if (s.members.size() > 1) {
      s.kind = Kind::equivalence_class;
      for (const Finalist& f : finalists)
        if (std::find(s.members.begin(), s.members.end(), alternatives_[f.alternative].name) != s.members.end())
          refused_[f.alternative] = "in the class";
    }
    out_.steps.push_back(std::move(s));
    out_.found = c_.fitter.fit(best.fit.terms, 0, &best.fit);
    return true;
  }

  /// No known effect: the dependence itself, as smooth as the data ask for.
  bool take_shape() {
    const auto all = best_of([](const Alternative& a) { return !a.physical(); }, 6);
    std::vector<std::pair<std::size_t, JointFit>> unconfirmed;
    for (const std::size_t a : all) {
      if (assessment_.p[a] > assessment_.threshold) continue;
      auto terms = out_.found.terms;
      terms.push_back({alternatives_[a], scan_->fit(a, data_).size});
      JointFit fit = c_.fitter.fit(terms, out_.found.noise, &out_.found);
      if (!fit.valid) continue;
      if (predicts_better(fit)) {
        add_shape(a, fit, {});
        return true;
      }
      refused_[a] = "refused: blocks held out are predicted no better with it";
      unconfirmed.emplace_back(a, std::move(fit));
    }
    // What shows in one block only cannot be predicted from the others: there it is nevertheless.
    if (unconfirmed.empty() || !out_.steps.empty()) return false;
    add_shape(unconfirmed[0].first, unconfirmed[0].second,
              "blocks held out are predicted no better with it: it may belong to some of them only");
    return true;
  }

  void add_shape(std::size_t a, const JointFit& fit, const std::string& remark) {
    Step s;
    s.kind = Kind::not_in_catalogue;
    s.p_value = assessment_.p_signature;
    s.threshold = assessment_.null[a].quantile(assessment_.threshold);
    s.depends_on = alternatives_[a].depends_on;
    s.terms = {out_.found.terms.size()};
    s.remarks.push_back("described by " + alternatives_[a].name +
                        (alternatives_[a].shape.empty() ? "" : " (" + alternatives_[a].shape + ")"));
    if (!remark.empty()) s.remarks.push_back(remark);
    refused_[a] = "describes what is not in the catalogue";
    out_.steps.push_back(std::move(s));
    out_.found = c_.fitter.fit(fit.terms, 0, &fit);
  }

  /// A variance component, or an effect that these data cannot tell from it. True if an effect was taken in.
  bool take_component() {
    for (std::size_t c = 0; c < assessment_.p_component.size(); ++c) {
      const bool largest =
          assessment_.data.scatter(static_cast<Index>(c), 0) == assessment_.data.scatter.col(0).maxCoeff();
      if (!largest || assessment_.p_component[c] > c_.alpha) continue;
      Step s;
      s.kind = Kind::scatter;
      s.component = static_cast<int>(c);
      s.p_value = assessment_.p_component[c];
      s.depends_on = c_.observations.redone[c].labels;
      s.members = {"scatter:" + c_.observations.redone[c].name};
      if (take_instead(s)) return true;
      out_.steps.push_back(std::move(s));
      return false;
    }
    if (assessment_.p_noise_overall <= c_.alpha && assessment_.p_signature > c_.alpha && out_.steps.empty()) {
      const bool scatters = std::any_of(assessment_.p_component.begin(), assessment_.p_component.end(),
                                        [&](double p) { return p <= c_.alpha; });
      if (scatters) return false;
      Step s;
      s.kind = Kind::scatter;
      s.p_value = assessment_.p_noise_overall;
      s.depends_on = {"reading"};
      s.members = {"scatter:reading"};
      out_.steps.push_back(std::move(s));
    }
    return false;
  }

  /// A slow drift looks like scatter from one clamping to the next: beside the scatter it is not worth its name.
  /// Effects that explain as much without the component, and predict what is left out, make a class with it. Not what
  /// is declared of one label or another: of so many, some look like scatter by chance.
  bool take_instead(const Step& scatter) {
    Design alone = out_.found.design;
    alone.scatter.clear();
    const Scan scan(alone, c_.fitter.rows(), pointers_, c_.threads);
    const Statistics without = scan.run(data_);
    const double gain = assessment_.data.scatter(scatter.component, 0);
    const auto more = [&](std::size_t a) {
      return without.ratio(static_cast<Index>(a), 0) - 2 * assessment_.null[a].mean;
    };
    std::map<std::string, std::size_t> best;
    for (const std::size_t a : physical_all()) {
      if (alternatives_[a].family == Family::declared || !(more(a) >= gain)) continue;
      const auto [at, first] = best.try_emplace(alternatives_[a].name, a);
      if (!first && more(a) > more(at->second)) at->second = a;
    }
    Step s = scatter;
    s.kind = Kind::equivalence_class;
    s.members.clear();
    std::vector<std::size_t> order;
    for (const auto& [name, a] : best) order.push_back(a);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return more(a) > more(b); });
    JointFit taken;
    for (const std::size_t a : order) {
      const Fit linear = scan.fit(a, data_);
      auto terms = out_.found.terms;
      terms.push_back({alternatives_[a], linear.size});
      JointFit fit = c_.fitter.fit(terms, out_.found.noise, &out_.found);
      const Structure& structure = scan.all_structures()[linear.structure];
      if (!fit.valid || left_out(fit, structure) >= left_out(out_.found, structure)) continue;
      refused_[a] = "in the class";
      s.members.push_back(alternatives_[a].name);
      if (s.terms.empty()) {
        s.terms = {out_.found.terms.size()};
        s.threshold = assessment_.null[a].quantile(assessment_.threshold);
        s.depends_on = alternatives_[a].depends_on;
        taken = std::move(fit);
      } else {
        s.rivals.push_back(fit.terms.back());
      }
    }
    if (s.terms.empty()) return false;
    s.members.push_back(scatter.members[0]);
    out_.steps.push_back(std::move(s));
    out_.found = c_.fitter.fit(taken.terms, 0, &taken);
    return true;
  }

  const Circumstances& c_;
  Search out_;
  std::vector<Alternative> alternatives_;
  std::vector<const Alternative*> pointers_;
  std::unique_ptr<Scan> scan_;
  Vector data_;
  Assessment assessment_;
  std::map<std::size_t, std::string> refused_;
};

} // namespace

Search search(const Circumstances& circumstances) { return Searcher(circumstances).run(); }

} // namespace gumshoe::tracing
