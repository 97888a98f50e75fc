/// Decisions of the search, each on made-up statistics: no model, no fit.
#include <catch2/catch.hpp>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"

using namespace gumshoe::tracing;

namespace {

/// An assessment in which nothing is found, with two variance components.
Assessment nothing() {
  Assessment a;
  a.p_anything = a.p_signature = a.p_noise_overall = 0.5;
  a.p_component = {0.5, 0.5};
  a.data.scatter = Matrix::Constant(2, 1, 1.0);
  return a;
}

/// A figure that must not be asked for: it would cost a simulation.
double unasked() {
  FAIL("the decision was clear without this figure");
  return 0;
}

} // namespace

TEST_CASE("the search looks for a signature only if it is significant over all that was tried", "[tracing]") {
  Assessment a = nothing();
  CHECK_FALSE(look_for_signature(a, 0.05));
  CHECK_FALSE(look_for_scatter(a, 0.05));
  a.p_anything = 0.05; // a component, say
  CHECK_FALSE(look_for_signature(a, 0.05));
  CHECK(look_for_scatter(a, 0.05));
  a.p_signature = 0.05;
  CHECK(look_for_signature(a, 0.05));
  a.p_anything = 0.051; // the largest signature alone is not enough
  CHECK_FALSE(look_for_signature(a, 0.05));
}

TEST_CASE("the search ends when a round takes nothing in, or at the cap", "[tracing]") {
  CHECK(search_goes_on(true, 0));
  CHECK(search_goes_on(true, criteria.most_findings - 1));
  CHECK_FALSE(search_goes_on(true, criteria.most_findings));
  CHECK_FALSE(search_goes_on(false, 0));
}

TEST_CASE("the best candidates are of different names", "[tracing]") {
  const std::vector<Scored> all{{"growth", 5}, {"latency", 9}, {"growth", 8}, {"scale", 20, false}, {"backlash", 7}};
  CHECK(best_of(all, 3) == std::vector<std::size_t>{1, 2, 4});
  CHECK(best_of(all, 2) == std::vector<std::size_t>{1, 2});
  CHECK(best_of({}, 3).empty());
}

TEST_CASE("a candidate is refitted as long as it could still win", "[tracing]") {
  const double best = 50, margin = criteria.contender_share * best - criteria.contender_margin; // 25
  CHECK(could_still_win(margin, best));
  CHECK_FALSE(could_still_win(margin - 0.1, best));
  // A finding that another one explains is dropped, by more than chance.
  CHECK(still_counts(12 - criteria.decisive + 0.01, 12));
  CHECK_FALSE(still_counts(12 - criteria.decisive - 0.01, 12));
  // Once refitted it counts by either fit: the whole model may show what the linear one hides.
  CHECK(passes(0.01, 0.01, 0, 12));
  CHECK(passes(0.02, 0.01, 12.1, 12));
  CHECK_FALSE(passes(0.02, 0.01, 12, 12));
}

TEST_CASE("a shape excludes an effect only by a lead that the effect would hardly let it have", "[tracing]") {
  CHECK_FALSE(shape_excludes(4.0, unasked));
  CHECK_FALSE(shape_excludes(10, [] { return 0.01; }));
  CHECK(shape_excludes(10, [] { return 0.005; }));
  CHECK(shape_excludes(25.1, unasked));
}

TEST_CASE("a rival is excluded, another effect, or a member of the class", "[tracing]") {
  const auto never = [] { return 1.0; };
  const auto nothing_beside = [] { return 0.0; };
  // Signatures that no data of the design distinguish: the whole model decides, without a simulation.
  CHECK(standing(3.8, 0.999, unasked, unasked, 10) == Standing::member);
  CHECK(standing(26, 0.999, unasked, unasked, 10) == Standing::excluded);
  // A small lead excludes nothing, a large one anything; in between the rival's truth is simulated.
  CHECK(standing(3.8, 0.5, unasked, nothing_beside, 10) == Standing::member);
  CHECK(standing(26, 0.5, unasked, unasked, 10) == Standing::excluded);
  CHECK(standing(
            10, 0.5, [] { return 0.04; }, unasked, 10) == Standing::excluded);
  CHECK(standing(
            10, 0.5, [] { return 0.05; }, nothing_beside, 10) == Standing::member);
  // A rival that counts in addition to the best is another effect.
  CHECK(standing(
            10, 0.5, never, [] { return 10.1; }, 10) == Standing::separate);
  CHECK(standing(
            10, 0.5, never, [] { return 10.0; }, 10) == Standing::member);
}

TEST_CASE("two effects are found together if each counts given the other and no shape explains as much", "[tracing]") {
  const double limits[] = {12, 14};
  CHECK(pair_found(60, {40, 45}, limits, 50));
  CHECK_FALSE(pair_found(60, {40, 45}, limits, 57));   // a shape explains nearly as much
  CHECK_FALSE(pair_found(60, {40, 48.1}, limits, 50)); // the first adds 11.9
  CHECK_FALSE(pair_found(60, {46.1, 45}, limits, 50)); // the second adds 13.9
}

TEST_CASE("one shape is there rather than a name and a shape only if it explains more", "[tracing]") {
  CHECK(explains_both(0.1));
  CHECK_FALSE(explains_both(0));
}

TEST_CASE("scatter is found in the largest component, larger noise only where nothing scatters", "[tracing]") {
  Assessment a = nothing();
  CHECK_FALSE(scatter_found(a, 0.05));
  a.data.scatter << 30, 20;
  a.p_component = {0.001, 0.002};
  CHECK(scatter_found(a, 0.05) == 0u);
  a.data.scatter << 20, 30;
  CHECK(scatter_found(a, 0.05) == 1u);
  a.p_component = {0.001, 0.06}; // of the largest only
  CHECK_FALSE(scatter_found(a, 0.05));

  a = nothing();
  a.p_noise_overall = 0.01;
  CHECK(larger_noise_found(a, 0.05));
  a.p_component[1] = 0.05;
  CHECK_FALSE(larger_noise_found(a, 0.05));
  a = nothing();
  a.p_noise_overall = a.p_signature = 0.01; // a signature explains it
  CHECK_FALSE(larger_noise_found(a, 0.05));
}

TEST_CASE("effects that explain as much as scatter are tried in its place", "[tracing]") {
  const std::vector<Scored> all{
      {"growth", 31}, {"growth", 33}, {"expansion", 35}, {"latency", 29.9}, {"scale", 50, false}};
  CHECK(explain_scatter(all, 30) == std::vector<std::size_t>{2, 1});
  CHECK(explain_scatter(all, 36).empty());
}

TEST_CASE("hold-out blocks veto what does not predict them better", "[tracing]") {
  constexpr double noise = 3e-6; // m: 97.5 % of what noise alone gives
  const auto none = [] { return 0.0; };
  CHECK(judge_holdout({30, 2e-6}, {25, 2e-6}, {3, 0}, noise, none) == Holdout::confirms);
  CHECK(judge_holdout({30, 2e-6}, {26.5, 2e-6}, {3, 0}, noise, none) == Holdout::favours); // 2 ln L below 3.84
  CHECK(judge_holdout({30, 2e-6}, {30, 1e-6}, {2, 0}, noise, none) ==
        Holdout::vetoes); // no better in units of all that is declared
  // The root mean square grows by more than 5 %.
  CHECK(judge_holdout({30, 2e-6}, {29, 2.11e-6}, {2, 0}, noise, none) == Holdout::vetoes);
  CHECK(judge_holdout({30, 2e-6}, {25, 2.09e-6}, {3, 0}, noise, none) == Holdout::confirms);
  CHECK(judge_holdout({30, 2e-6}, {31, 2.2e-6}, {1, 0}, noise, none) ==
        Holdout::unsure); // as chance gives were the finding true
}

TEST_CASE("hold-out blocks veto what leaves them with more than noise and no less than before", "[tracing]") {
  constexpr double noise = 1e-6;
  const auto none = [] { return 0.0; };
  CHECK(judge_holdout({30, 2e-6}, {31, 2e-6}, {1, 0}, noise, none) == Holdout::vetoes);
  CHECK(judge_holdout({30, 2e-6}, {31, 1.9e-6}, {1, 0}, noise, none) == Holdout::unsure); // something else may be left
  CHECK(judge_holdout({30, 0.8e-6}, {31, 0.9e-6}, {1, 0}, noise, none) == Holdout::unsure); // noise gives as much
  CHECK(judge_holdout({30, 2e-6}, {25, 2.05e-6}, {1, 0}, noise, none) ==
        Holdout::confirms); // in units of all that is declared
}

TEST_CASE("hold-out blocks veto what all readings together show only if it is overstated by far", "[tracing]") {
  constexpr double noise = 1e-6;
  const auto far_beyond = [] { return 27.0; };
  CHECK(judge_holdout({30, 2e-6}, {45, 2.4e-6}, {2.9, 0}, noise, far_beyond) == Holdout::outweighed); // 27 - 15 > 10
  CHECK(judge_holdout({30, 2e-6}, {48, 2.4e-6}, {2.9, 0}, noise, far_beyond) == Holdout::vetoes);     // 27 - 18 < 10
  CHECK(judge_holdout({30, 2e-6}, {45, 2.4e-6}, {3.1, 0}, noise, far_beyond) ==
        Holdout::vetoes); // one of 1,000 right ones
  CHECK(judge_holdout({30, 2e-6}, {29, 2.4e-6}, {2, 3.1}, noise, far_beyond) == Holdout::vetoes); // scatter hides it
}

TEST_CASE("after a veto scatter remains, effects do not", "[tracing]") {
  CHECK_FALSE(left_by_veto(Kind::named, false, false));
  CHECK_FALSE(left_by_veto(Kind::equivalence_class, false, false));
  CHECK(left_by_veto(Kind::equivalence_class, true, false) == Kind::scatter);
  CHECK_FALSE(left_by_veto(Kind::equivalence_class, true, true)); // it is a finding of its own
  CHECK(left_by_veto(Kind::scatter, true, true) == Kind::scatter);
  CHECK(left_by_veto(Kind::not_in_catalogue, false, false) == Kind::not_in_catalogue);
}

TEST_CASE("the ranking says why a candidate came no further", "[tracing]") {
  CHECK(refusal(1e-6, "laser_z", 1e-9, 0.01) == "not testable: absorbed by laser_z");
  CHECK(refusal(1e-6, "", 1e-9, 0.01) == "not testable: absorbed by the fit");
  CHECK(refusal(0.5, "", 0.02, 0.01) == "refused: no more than chance");
  CHECK(refusal(0.5, "", 0.001, 0.01) == "refused: another candidate explains the residuals better");
}

TEST_CASE("an effect and a simpler shape are there rather than one shape of many sizes", "[tracing]") {
  // Scores alone 5 and 150, of the one shape 180; the effect adds 40 to the simpler shape, each must exceed 12.
  CHECK(counts_beside(186, {5, 150}, 40, {12, 12}, 180));
  CHECK_FALSE(counts_beside(175, {5, 150}, 40, {12, 12}, 180));   // the one shape explains more
  CHECK_FALSE(counts_beside(186, {5, 180}, 10, {12, 12}, 180));   // the effect adds too little
  CHECK_FALSE(counts_beside(186, {180, 150}, 40, {12, 12}, 180)); // the simpler shape adds too little
}
