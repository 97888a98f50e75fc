#include "tracing/judgement/in_place_of_names.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tracing/candidates/shapes.h"
#include "tracing/criteria.h"
#include "tracing/judgement/apart.h"
#include "tracing/judgement/decisions.h"
#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {
namespace {

using Names = std::set<std::string>;

Names depends_on(const Candidate& a) { return {a.depends_on.begin(), a.depends_on.end()}; }

/// Twice what chance gives a candidate: of so many sizes, the best of so many forms.
double chance(const Candidate& a) { return 2 * static_cast<double>(a.columns.cols()) + 2 * std::log(a.searched); }

/// A named effect and a shape among the findings, and what may be there in their place.
class Both {
public:
  Both(const TraceContext& c, const Search& s, std::size_t named, std::size_t rest)
      : c_(c), found_(s.found), named_(s.findings[named]), shape_(s.findings[rest]), places_{named, rest},
        terms_(named_.terms) {
    terms_.insert(terms_.end(), shape_.terms.begin(), shape_.terms.end());
    less_ = without(c, found_, terms_);
    for (const std::size_t t : terms_) {
      chance_ += chance(found_.terms[t].candidate);
      sizes_ += found_.terms[t].candidate.columns.cols();
    }
  }

  /// @param all  shapes. One that is the named effect's own signature is no other.
  std::optional<InPlaceOfNames> instead(const std::vector<Candidate>& all) const {
    if (!less_.valid) return std::nullopt;
    if (auto plain = best(all, [&](const Candidate& a) {
          return a.family == Family::shape && !a.rare() && a.columns.cols() <= sizes_;
        }))
      if (explains_both(lead_of(*plain))) return plain;
    const Names of_shape = depends_on(found_.terms[shape_.terms[0]].candidate),
                of_named = depends_on(found_.terms[named_.terms[0]].candidate);
    if (of_named.empty() || !std::ranges::includes(of_shape, of_named)) return std::nullopt;
    auto free = best(all, [&](const Candidate& a) { return a.family == Family::omnibus && depends_on(a) == of_shape; });
    return free && !still_counts(added_to(*free), named_.threshold) ? free : std::nullopt;
  }

private:
  template <class Fits> std::optional<InPlaceOfNames> best(const std::vector<Candidate>& all, const Fits& fits) const {
    std::vector<const Candidate*> some{&found_.terms[named_.terms[0]].candidate};
    for (const Candidate& a : all)
      if (fits(a)) some.push_back(&a);
    const Scan scan(less_.design, c_.fitter.rows(), some, c_.threads);
    const Statistics linear = scan.run(scan.whitened(scan.plain()).take(less_.residual));
    const auto score = [&](std::size_t a) { return linear.ratio(index(a), 0) - chance(*some[a]); };
    const auto is_the_name = [&](std::size_t a) {
      return some[a]->columns.cols() == some[0]->columns.cols() &&
             scan.correlation(0, a, scan.plain()) > criteria.alike;
    };
    std::size_t most = 0;
    for (std::size_t a = 1; a < some.size(); ++a)
      if ((most == 0 || score(a) > score(most)) && !is_the_name(a)) most = a;
    if (most == 0) return std::nullopt;
    Term shape{apart(*some[most], less_, c_.observations, c_.fitter.rows()), {}};
    shape.size = Vector::Zero(shape.candidate.columns.cols());
    std::vector<Term> terms = less_.terms;
    terms.push_back(std::move(shape));
    InPlaceOfNames out{places_[0], places_[1], *some[most], c_.fitter.fit(terms, found_.noise, &less_)};
    return out.fit.valid ? std::optional(std::move(out)) : std::nullopt;
  }

  /// Lead of one shape over the two, by the whole model.
  double lead_of(const InPlaceOfNames& one) const {
    const std::size_t last = one.fit.terms.size() - 1;
    return gain_of(c_, one.fit, {last}) - gain_of(c_, found_, terms_) + chance_ - chance(one.shape);
  }

  /// Likelihood ratio that the effect adds to a shape, by the whole model.
  double added_to(const InPlaceOfNames& one) const {
    std::vector<Term> terms = one.fit.terms;
    std::vector<std::size_t> own;
    for (const std::size_t t : named_.terms) {
      own.push_back(terms.size());
      terms.push_back(found_.terms[t]);
    }
    const JointFit with = c_.fitter.fit(terms, found_.noise, &one.fit);
    return with.valid ? gain_of(c_, with, own, named_.component >= 0) : 0;
  }

  const TraceContext& c_;
  const JointFit& found_;
  const SearchFinding &named_, &shape_;
  std::size_t places_[2];
  std::vector<std::size_t> terms_; ///< of both
  JointFit less_;                  ///< without them
  double chance_ = 0;              ///< twice what chance gives them
  Index sizes_ = 0;
};

} // namespace

std::optional<InPlaceOfNames> in_place_of_names(const TraceContext& c, const Search& s) {
  const auto is = [](const SearchFinding& f, auto... kinds) {
    return !f.terms.empty() && ((f.finding.kind == kinds) || ...);
  };
  std::optional<std::vector<Candidate>> all;
  for (std::size_t i = 0; i < s.findings.size(); ++i)
    for (std::size_t j = 0; j < s.findings.size(); ++j) {
      if (!is(s.findings[i], Kind::named, Kind::equivalence_class) || !is(s.findings[j], Kind::not_in_catalogue))
        continue;
      if (!all) all = shapes(c.observations, criteria.most_table_cells);
      if (auto one = Both(c, s, i, j).instead(*all)) return one;
    }
  return std::nullopt;
}

} // namespace gumshoe::tracing
