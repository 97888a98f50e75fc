#include "tracing/judgement/rounds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"
#include "tracing/judgement/evidence.h"
#include "tracing/judgement/hidden_pair.h"
#include "tracing/judgement/in_place_of_scatter.h"
#include "tracing/judgement/pruning.h"
#include "tracing/judgement/ranking.h"
#include "tracing/judgement/shape_order.h"
#include "tracing/judgement/trials.h"

namespace gumshoe::tracing {
namespace {

/// Sizes by which shapes and effects are compared. A harmonic is one wave: its phase costs it what chance gives, and no
/// more, lest an effect of two waves to a turn take one of three to a turn of any phase.
Index sizes(const Candidate& a) { return a.name.starts_with("harmonic:") ? 1 : a.columns.cols(); }

constexpr const char* impossible = "refused: no such effect has the size that would explain the residuals";
constexpr const char* not_by_the_model = "refused: by the whole model it explains little of what its signature does";
constexpr const char* not_predicted = "refused: it does not improve the prediction of held-out blocks";

bool at_a_limit(const Term& term) {
  for (Index j = 0; j < term.size.size(); ++j)
    if (term.candidate.amplitudes[index(j)].at_limit(term.size[j])) return true;
  return false;
}

std::string cannot_be_distinguished_from(const std::vector<RivalShape>& rivals) {
  std::vector<std::string> all;
  for (const RivalShape& one : rivals)
    all.push_back(one.shape + (one.never_apart ? " (the same in every reading)" : ""));
  return fmt::format("these data cannot distinguish it from {}", fmt::join(all, ", "));
}

std::string unknown_effect(const std::vector<std::string>& depends_on) {
  return fmt::format("an unknown effect of {}", fmt::join(depends_on, " and "));
}

/// Takes the steps that the decisions (decisions.h) ask for: fits, and keeps what was found.
class Searcher {
public:
  Searcher(const TraceContext& c, Sought sought) : c_(c), further_(further(c)), sought_(sought) {}

  Search run() {
    report_progress("fitting the declared model");
    out_.base = c_.fitter.fit({}, 0);
    c_.fitter.refine(out_.base);
    out_.found = out_.base;
    for (bool more = true; search_goes_on(more, out_.findings.size());) {
      const std::size_t terms = out_.found.terms.size();
      more = round();
      if (!more && !wide_ && out_.last.p_lack_of_fit <= now().alpha) {
        wide_ = true; // what repeats is a correction, however many values it has
        more = round();
      }
      if (out_.found.terms.size() <= terms) continue;
      prune(c_, out_, dropped_);
      c_.fitter.refine(out_.found);
      out_.stages.push_back({out_.found, out_.findings, out_.dropped});
    }
    if (out_.findings.size() >= criteria.most_findings) {
      const Evidence evidence(now(), out_.found, rounds_, dropped_);
      out_.last = evidence.assessment();
      out_.jumping = evidence.jumping();
      out_.capped = out_.last.p_anything <= now().alpha;
    }
    c_.fitter.widen_jumping(out_.found);
    for (SearchFinding& f : out_.findings) // found as well, it is no alternative
      for (const SearchFinding& other : out_.findings)
        if (other.finding.kind == Kind::not_in_catalogue &&
            f.finding.fits_better == unknown_effect(other.finding.depends_on))
          f.finding.fits_better.clear();
    return std::move(out_);
  }

private:
  const TraceContext& now() const { return out_.findings.empty() ? c_ : further_; }

  void report_progress(const std::string& what) const {
    if (c_.progress) c_.progress(what);
  }

  /// Adds a finding; a size of an effect that is named already joins it, as does a scatter that is known.
  void add(SearchFinding found) {
    const auto same = std::ranges::find_if(out_.findings, [&](const SearchFinding& f) {
      const bool one_kind = f.finding.kind == found.finding.kind;
      return one_kind && (f.finding.kind == Kind::scatter
                              ? f.component == found.component
                              : f.finding.kind == Kind::named && f.finding.members == found.finding.members);
    });
    if (same == out_.findings.end())
      out_.findings.push_back(std::move(found));
    else
      same->terms.insert(same->terms.end(), found.terms.begin(), found.terms.end());
  }

  /// Takes in one more effect; false if there is none.
  bool round() {
    const bool anything = !out_.findings.empty();
    report_progress(anything ? "searching for more" : "searching for what is missing from the declared model");
    const bool first = out_.findings.empty() && out_.first.p.empty();
    const Evidence evidence(now(), out_.found, rounds_++, dropped_, wide_);
    evidence_ = &evidence;
    out_.last = evidence.assessment();
    out_.jumping = evidence.jumping();
    if (first) {
      out_.first = evidence.assessment();
      out_.tried = static_cast<int>(evidence.candidates().size() + c_.observations.replicate_groups.size());
      out_.limits = detection_limits(evidence.scan(), evidence.assessment(), evidence.candidates());
    }
    bool more = look_for_signature(evidence.assessment(), now().alpha)
                    ? take_signature()
                    : sought_.names && take_pair(best_shape(), criteria.pairs_alpha);
    if (!more && look_for_scatter(evidence.assessment(), now().alpha)) more = take_component();
    if (first)
      out_.ranking =
          ranking(evidence.scan(), evidence.assessment(), evidence.candidates(), out_.base.design, outcomes_);
    return more;
  }

  const Candidate& candidate(std::size_t a) const { return evidence_->candidates()[a]; }

  /// A finding by one candidate, the next term of the fit or the one `behind` that.
  SearchFinding found_by(std::size_t a, Kind kind, std::size_t behind = 0) const {
    SearchFinding out;
    out.finding.kind = kind;
    out.finding.p_value = evidence_->assessment().p_signature;
    out.finding.depends_on = candidate(a).depends_on;
    if (kind != Kind::not_in_catalogue) out.finding.members = {candidate(a).name};
    out.threshold = evidence_->limit(a);
    out.terms = {out_.found.terms.size() + behind};
    if (const double own = evidence_->scan().identifiable(a);
        candidate(a).physical() && own < criteria.mostly_absorbed && !out.finding.depends_on.empty())
      out.finding.remarks.push_back(
          fmt::format("the declared model explains {:.0f} % of its signature as well; by the rest, another smooth "
                      "dependence on {} may look like it",
                      100 * (1 - own), fmt::join(out.finding.depends_on, " and ")));
    return out;
  }

  void adopt(const JointFit& fit) { out_.found = fitted_anew(c_, fit); }

  bool take_signature() {
    if (!sought_.names) return take_shape();
    const auto plain =
        evidence_->best_of([](const Candidate& a) { return a.family == Family::shape; }, criteria.rival_shapes);
    std::vector<Trial> denied;
    const std::vector<Trial> tried = physical_trials(*evidence_, denied);
    out_.impossible.clear();
    for (const Trial& t : denied) {
      const bool limited = at_a_limit(t.fit.terms.back());
      outcomes_[t.candidate] = limited ? impossible : not_by_the_model;
      if (limited) out_.impossible.push_back(candidate(t.candidate).name);
    }
    if (tried.empty()) return take_pair(best_shape()) || take_shape();
    const std::size_t best = tried[0].candidate;
    if (const auto shape = shape_instead(tried[0], plain)) {
      if (take_pair(plain.empty() ? 0 : evidence_->score(plain[0]))) return true;
      for (const Trial& t : tried)
        outcomes_[t.candidate] = "refused: " + with_shape(candidate(*shape)) + " fits better and is as simple";
    } else if (evidence_->predicts_better(tried[0].fit)) {
      take(tried);
      return true;
    } else {
      outcomes_[best] = not_predicted;
    }
    return take_shape();
  }

  /// A plain shape of no more parameters that fits better than the effect could let it. One that fits better, as the
  /// effect could seldom let it, is kept as `as_well_`.
  std::optional<std::size_t> shape_instead(const Trial& best, const std::vector<std::size_t>& plain) {
    as_well_.reset();
    for (const std::size_t g : plain) {
      if (sizes(candidate(g)) > sizes(candidate(best.candidate))) continue;
      double lead = evidence_->score(g) - best.score;
      // A step by a label is as likely as any effect that one part has.
      if (candidate(best.candidate).in_part() && !candidate(g).rare() && lead > -2 * std::log(criteria.rarity_of_part))
        return g;
      const auto excludes = [&] {
        return shape_excludes(lead, [&] { return evidence_->chance_of_lead(g, best.candidate, lead); });
      };
      if (!excludes()) {
        if (lead > criteria.equal_merit && !as_well_) as_well_ = g;
        continue;
      }
      // The whole model judges, as it judged the effect: its noise may differ from that of the search.
      const Trial whole = evidence_->trial(g);
      lead = whole.score - best.score;
      if (whole.fit.valid && excludes() && !evidence_->of_few(whole.fit)) return g;
    }
    return std::nullopt;
  }

  double best_shape() const {
    const auto best = evidence_->best_of([](const Candidate& a) { return !a.physical(); }, 1);
    return best.empty() ? 0 : evidence_->score(best[0]);
  }

  /// One masks the other: two effects together that explain more than shapes do.
  /// @param best_shape  a shape's score
  /// @param share       of alpha: 1 where something passes; else what a second search may use
  bool take_pair(double best_shape, double share = 1) {
    const auto pair = hidden_pair(*evidence_, best_shape, share * now().alpha);
    if (!pair) return false;
    std::vector<Term> both;
    for (const std::size_t a : pair->candidates)
      both.push_back(candidate(a).start.empty() ? Term{candidate(a), Vector::Zero(candidate(a).columns.cols())}
                                                : at_start(candidate(a)));
    const JointFit fit = evidence_->with_shapes(both);
    if (!fit.valid || !evidence_->predicts_better(fit)) return false;
    const auto& [a, b] = pair->candidates;
    if (share < 1 && out_.findings.empty())
      out_.first.p_anything = std::min(out_.first.p_anything, pair->p_value / share);
    for (const std::size_t i : {0, 1}) {
      SearchFinding found = found_by(i == 0 ? a : b, Kind::named, i);
      if (share < 1) found.finding.p_value = pair->p_value / share;
      found.finding.remarks.push_back("found together with " + candidate(i == 0 ? b : a).name +
                                      "; each masks the other");
      add(std::move(found));
    }
    outcomes_[a] = outcomes_[b] = alone;
    adopt(fit);
    return true;
  }

  /// The best of those tried, alone or with those that these data cannot distinguish from it.
  void take(const std::vector<Trial>& tried) {
    const Trial& best = tried[0];
    const std::string& winner = candidate(best.candidate).name;
    SearchFinding found = found_by(best.candidate, Kind::named);
    std::vector<std::size_t> members{best.candidate};
    for (std::size_t i = 1; i < tried.size(); ++i) {
      const std::size_t rival = tried[i].candidate;
      if (tried[i].implausible && !best.implausible) {
        outcomes_[rival] = impossible;
        continue;
      }
      const double lead = best.score - tried[i].score;
      switch (standing(
          lead, evidence_->correlation(best.candidate, rival),
          [&] { return evidence_->chance_of_lead(best.candidate, rival, lead); },
          [&] { return evidence_->gain_beside(best.candidate, rival); }, evidence_->limit(rival))) {
      case Standing::excluded:
        outcomes_[rival] = "refused: " + winner + " fits better";
        break;
      case Standing::separate:
        outcomes_[rival] = "counts in addition to " + winner;
        break;
      case Standing::member:
        members.push_back(rival);
        found.finding.members.push_back(candidate(rival).name);
        found.rivals.push_back(tried[i].fit.terms.back());
      }
    }
    if (members.size() > 1) found.finding.kind = Kind::equivalence_class;
    for (const std::size_t a : members) outcomes_[a] = members.size() > 1 ? in_class : alone;
    if (as_well_) {
      found.finding.fits_better = unknown_effect(candidate(*as_well_).depends_on);
      found.finding.remarks.push_back(with_shape(candidate(*as_well_)) + " fits better, as chance could have it");
      outcomes_[*as_well_] = "fits better than " + winner + ", as chance could have it";
    }
    add(std::move(found));
    adopt(best.fit);
  }

  /// An effect that does not pass by itself, in place of a shape that does: it has a cause, and explains as much.
  bool take_of_equal_merit(std::size_t shape, double score_of_shape) {
    if (!sought_.names) return false;
    for (const std::size_t a :
         evidence_->best_of([](const Candidate& x) { return x.physical() && !x.in_part(); }, criteria.most_refitted)) {
      if (evidence_->score(a) < evidence_->score(shape) - criteria.equal_merit) break;
      const Trial one = evidence_->trial(a);
      if (!one.fit.valid || one.implausible || at_a_limit(one.fit.terms.back()) || !is_significant(one.fit) ||
          one.score < score_of_shape - criteria.equal_merit || sizes(candidate(a)) > sizes(candidate(shape)) ||
          evidence_->gain_beside(a, shape) > evidence_->limit(shape) || !evidence_->predicts_better(one.fit))
        continue;
      as_well_ = shape;
      take({one});
      return true;
    }
    return false;
  }

  /// No known effect: the dependence itself, as smooth as the data ask for.
  bool take_shape() {
    const auto& assessment = evidence_->assessment();
    std::optional<std::pair<std::size_t, JointFit>> unconfirmed;
    std::vector<Trial> tried = shape_trials(c_, *evidence_, sought_.steps_last);
    if (tried.empty()) return false;
    std::vector<std::pair<std::size_t, JointFit>> described;
    for (auto& [a, fit, ratio, score, implausible] : tried) {
      if (evidence_->of_few(fit)) {
        outcomes_[a] = "refused: it is of a few successive readings only";
        continue;
      }
      if (evidence_->predicts_better(fit, Judged::as_declared)) {
        if (!take_of_equal_merit(a, score))
          add_shape(a, fit, assessment.p_signature, rivals_of(c_, *evidence_, a, tried));
        return true;
      }
      described.emplace_back(a, std::move(fit));
    }
    // A term that predicts other blocks goes before one that describes them, such as a curve in time.
    for (auto& [a, fit] : described) {
      if (evidence_->predicts_better(fit, Judged::given_the_others)) {
        add_shape(a, fit, assessment.p_signature, rivals_of(c_, *evidence_, a, tried));
        return true;
      }
      outcomes_[a] = not_predicted;
      if (!unconfirmed) unconfirmed.emplace(a, std::move(fit));
    }
    // What shows in one block only cannot be predicted from the others: there it is nevertheless.
    if (!unconfirmed || !out_.findings.empty()) return false;
    add_shape(unconfirmed->first, unconfirmed->second, assessment.p_signature, {},
              "it does not improve the prediction of held-out blocks; it may belong to some blocks only");
    return true;
  }

  void add_shape(std::size_t a, const JointFit& fit, double p, std::vector<RivalShape> rivals = {},
                 const std::string& remark = {}) {
    SearchFinding found = found_by(a, Kind::not_in_catalogue);
    found.finding.p_value = p;
    found.finding.described_by = candidate(a).name;
    // A time constant is told as it is fitted in the end.
    const bool fixed = candidate(a).form == Form::fixed && !is_one_of_several_forms(*evidence_, a);
    found.finding.remarks.push_back("described by " + (fixed ? with_shape(candidate(a)) : candidate(a).name));
    if (!rivals.empty()) found.finding.remarks.push_back(cannot_be_distinguished_from(rivals));
    found.finding.rivals = std::move(rivals);
    if (!remark.empty()) found.finding.remarks.push_back(remark);
    outcomes_[a] = "describes an unknown effect";
    add(std::move(found));
    adopt(fit);
  }

  /// A variance component, or an effect that these data cannot distinguish from it. True if an effect was taken in.
  bool take_component() {
    auto found = scatter_shown(now(), out_.found, evidence_->assessment());
    if (!found) return false;
    if (found->component >= 0) {
      const InPlaceOfScatter instead = in_place_of_scatter(c_, *evidence_, *found);
      if (sought_.names && !instead.effects.terms.empty()) {
        for (const std::size_t a : instead.members) outcomes_[a] = "explains the scatter";
        add(instead.effects);
        adopt(instead.fit);
        return true;
      }
      if (instead.shape) {
        const auto lasts = sought_.steps_last ? lasting_in_place_of(c_, *evidence_, *instead.shape) : std::nullopt;
        if (lasts)
          add_shape(lasts->candidate, lasts->fit, found->finding.p_value);
        else
          add_shape(*instead.shape, instead.with_shape, found->finding.p_value);
        return true;
      }
      if (instead.as_well) found->finding.members.push_back(candidate(*instead.as_well).name);
    }
    if (found->component < 0) {
      if (sought_.shapes_for_noise)
        if (const auto instead = in_place_of_larger_noise(now(), *evidence_)) {
          add_shape(instead->candidate, instead->fit, found->finding.p_value);
          return true;
        }
      // Sizes that explain more than chance, and with which readings jump, may be all of it, though none was found.
      for (std::string& name : evidence_->jumping(0)) found->finding.members.push_back(std::move(name));
    }
    add(*found);
    return false;
  }

  const TraceContext& c_;
  TraceContext further_; ///< once something was found
  Sought sought_;
  Search out_;
  const Evidence* evidence_ = nullptr; ///< of this round
  std::size_t rounds_ = 0;
  std::optional<std::size_t> as_well_; ///< candidate that fits better than the effect taken in this round
  bool wide_ = false;                  ///< tables of many cells are tried
  std::set<std::string> dropped_;      ///< names of candidates that another finding made superfluous
  std::map<std::size_t, std::string> outcomes_;
};

} // namespace

Search search_in_rounds(const TraceContext& c, Sought sought) { return Searcher(c, sought).run(); }

} // namespace gumshoe::tracing
