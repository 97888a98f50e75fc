#include "scenario/options.h"

namespace gumshoe::scenario {

Options<Adaptive> adaptive_options() {
  using enum StoppingRule;
  auto rule = option::word("rule", &Adaptive::rule, std::vector{jcgm_101, stein},
                           "JCGM 101 7.9 as printed, or Stein's two stages (Wuebbeler et al. 2010)");
  rule.usual = shape::json_string(name(stein)); // of a table that is there: without one the rule is none of them
  return {
      rule,
      option::whole("digits", &Adaptive::digits, 1, 4, "n_dig, number of meaningful significant digits of u"),
      option::whole("max_samples", &Adaptive::most, 20'000, option::largest_whole,
                    "number of samples at which the rule gives up"),
      option::flag("validation", &Adaptive::validation,
                   "aim at a fifth of the tolerance, so that the validation of the GUM framework is decided"),
  };
}

Options<RunOptions> run_options() {
  using enum Design;
  return {
      option::whole("samples", &RunOptions::samples, 2, option::largest_whole, "number of samples; excludes adaptive"),
      option::whole("seed", &RunOptions::seed, 0, option::largest_whole, "the same seed gives the same samples"),
      option::word("design", &RunOptions::design, std::vector{monte_carlo, latin_hypercube, sobol},
                   "how the samples are drawn; adaptive runs need monte_carlo"),
      option::share("max_failed_share", &RunOptions::max_failed_share, false,
                    "share of failed samples above which the run fails"),
      option::flag("store_samples", &RunOptions::store_samples,
                   "keep every sample in the result file, not only the summary"),
      option::flag("store_inputs", &RunOptions::store_inputs,
                   "keep the drawn deviations of the input quantities in the result file, too"),
      option::by_hand<RunOptions>("adaptive", table_shape(adaptive_options()),
                                  "adaptive run: as many samples as the results need for the stated digits"),
  };
}

Options<EstimateOptions> estimate_options() {
  using enum least_squares::Loss;
  return {
      option::word("loss", &EstimateOptions::loss, std::vector{squared, huber, cauchy, tukey},
                   "loss function; all except squared tolerate outliers"),
      option::positive("width", &EstimateOptions::width,
                       "width of the loss in standard deviations of a residual; default: that of 95 % efficiency"),
      option::whole("iterations", &EstimateOptions::iterations, 1, 1'000'000,
                    "largest number of iterations per attempt of the solver"),
      option::word("posterior", &EstimateOptions::t, {{"normal", false}, {"t", true}},
                   "distributions in the written scenario if the noise is estimated"),
  };
}

RunOptions read_run(Table table) {
  RunOptions out;
  read_options(table, run_options(), out);
  if (auto adaptive = table.table("adaptive")) {
    out.adaptive.rule = StoppingRule::stein;
    read_options(*adaptive, adaptive_options(), out.adaptive);
    adaptive->refuse_unknown();
    if (table.has("samples"))
      table.refuse_key("samples", "samples is given together with adaptive", "an adaptive run determines the number of samples",
                       "leave one out");
    if (out.design != Design::monte_carlo)
      table.refuse_key("design", "adaptive runs need independent samples", "", "design = \"monte_carlo\"");
  }
  table.refuse_unknown();
  return out;
}

EstimateOptions read_estimate(Table table) {
  EstimateOptions out;
  read_options(table, estimate_options(), out);
  if (table.has("width") && out.loss == least_squares::Loss::squared)
    table.refuse_key("width", "the squared loss has no width", "", "loss = \"huber\"");
  table.refuse_unknown();
  return out;
}

} // namespace gumshoe::scenario
