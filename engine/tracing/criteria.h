#pragma once
/// Every threshold, cap and number of draws that a trace decides by, with its meaning, unit and reason.
///
/// "2 ln L" means twice the natural logarithm of a likelihood ratio, without unit. Values marked "tuned" were chosen on
/// the synthetic data of tests/recovery; the others follow from the source or the argument given. Guards against
/// rounding (1e-12 of a sum of squares, and the like) stand where they are used.
#include <array>
#include <cstddef>

#include "tracing/matrix.h"

namespace gumshoe::tracing {

struct Criteria {
  // ---- Noise ----
  /// Residuals beyond this many robust standard deviations are winsorised. Normal noise exceeds it once in 2,150.
  double winsor_limit = 3.5;
  /// Winsorised residuals change the fit, and so all residuals: it is repeated until none changes by more than this
  /// many robust standard deviations. A reading that pulls h of the fit towards itself needs ln(1e-2) / ln(h) steps.
  double winsor_settled = 0.01;
  int most_winsor_steps = 20;
  /// One outlying reading in so many, and one in any case, does not stand for the noise of all: they are set aside
  /// before noise is called larger than declared. Of noise with so many beyond 3.5 robust standard deviations, these
  /// are its shape.
  std::size_t readings_for_outlier = 20;
  /// Serial correlations tried, from one reading to the next in the order of measurement. Tuned.
  std::array<double, 5> correlations{0.0, 0.2, 0.4, 0.6, 0.8};
  /// Fewer readings than this do not distinguish serial correlation from a trend: only zero is tried. Tuned.
  std::size_t readings_for_correlation = 12;
  /// Share of alpha for each finding after the first: a search after a finding may add a wrong name by chance.
  double further_share = 0.5;
  /// Share of a display's step below which the scatter of repeated readings leaves rounding that repeats: at half a
  /// step, what it leaves is 1 % of one.
  double coarse = 0.5;
  /// So many different readings show the step in which they were recorded; of fewer, two in one cell must differ: 0 and
  /// 10 um may be readings in steps of 1 um.
  std::size_t values_of_steps = 4;
  /// Ratio of the noise of two indications from which it is not taken to be equal: of fifty readings, chance gives 1.3.
  double unequal_spread = 1.5;
  /// Noise that is not declared grows with a condition if 2 ln of the likelihood says so by this much: of one
  /// condition, equal normal noise exceeds it less than once in a thousand.
  double noise_grows = 12;
  /// Noise that is not declared differs by a label if equal normal noise would say so as plainly with this probability.
  double noise_differs = 2e-3;
  /// It is judged about a straight line for each group of every pass, unless chance explains these with this
  /// probability.
  double no_drift = 0.05;
  /// 2 ln L by which two of its groups must differ: 5 % of what chance gives.
  double noise_alike = 3.84;
  /// So many groups of a label tell what another one will have: of three, Student's t has no standard deviation.
  std::size_t least_groups_for_others = 4;
  /// Groups with fewer degrees of freedom than this have the noise of all. Tuned.
  double least_group_freedom = 5;
  /// Fewer degrees of freedom than this do not tell how noise grows. Tuned.
  std::ptrdiff_t freedom_for_growth = 20;
  /// Ratios tried, of the part that grows at the largest value met to the part that does not: steps of a factor that
  /// the likelihood hardly sees.
  std::array<double, 9> growth_ratios{1, 2, 4, 8, 16, 32, 64, 128, 256};
  /// 2 ln L within which a lesser ratio does as well: a standard deviation. Where only readings at zero tell more from
  /// less, a large one would weight these as if they had no noise; 3.84 would weight purely relative noise too little.
  double as_well_grown = 1;
  /// Standard deviations of a variance component tried, in units of the typical noise: steps of about a factor two,
  /// because the likelihood is flat in the logarithm.
  std::array<double, 7> scatter_ratios{0.35, 0.7, 1.4, 2.8, 6.0, 15.0, 50.0};
  /// Ratios at which the component of one indication alone is tried, too: (low, high), the middle of the grid.
  double single_scatter_low = 0.5, single_scatter_high = 10;
  /// Readings that bend about a straight line by less than this share of their movement are taken as straight. Tuned.
  double straight = 0.02;
  /// Half a step leaves a quarter of what a smooth function bends about its tangent; a kink leaves half, and jumps
  /// about seven tenths. More than this share is not smooth.
  double curved = 0.4;
  /// Equally likely values of a scattering quantity at which the model is evaluated.
  int response_nodes = 16;
  /// Groups that a stated and an unstated replicate label need: fewer do not show a variance.
  std::size_t stated_replicates = 5, found_replicates = 6;
  std::size_t most_replicate_groups = 3; ///< labels or pairs tried as variance components, by cost
  /// A label with more groups than so many per five readings cannot be distinguished from the noise of a reading.
  std::size_t most_groups_of_five = 4;
  /// Degrees of freedom that the scatter of readings under equal conditions needs: with eight it is known within 25 %.
  double least_pure_freedom = 8;
  /// Readings of a cell from which a straight line in time is projected out of them: two of four are left.
  std::size_t repeats_for_line = 4;
  /// Cells up to which the covariance of the noise is judged by the scatter about their means, by cost.
  std::size_t most_cells_of_noise = 200;
  /// 2 ln L by which the scatter about the cells' means must speak against more correlation: three standard deviations.
  double too_much_structure = 9;
  /// p-value below which means differ by more than their repeats explain, as it is said of repeats and declared noise.
  double repeats_share_p = 1e-3;
  std::size_t readings_of_block = 6; ///< indications of a block that show its scatter
  /// What repeats depends on a factor if, without it, this many standard deviations more of squares are left.
  double factor_counts = 3;
  /// The noise of a label's groups is judged about the means of cells; a factor that chance explains with this
  /// probability divides no cells there.
  double idle_factor = 0.01;
  std::size_t blocks_for_holdout = 4;    ///< at least: one is held out, three remain to train on
  std::size_t holdout_part = 4;          ///< one block in so many is held out, the last in the order of measurement
  std::size_t least_training_blocks = 2; ///< blocks that must remain to train on

  // ---- Candidates ----
  /// Finite steps of an effect's size move the indications by this many standard deviations of the noise, and are no
  /// longer than this many typical sizes. Tuned.
  double secant_step = 3;
  /// Two signatures of one candidate whose cosine is above this are the same; a secant must differ more. Tuned.
  double same_signature = 0.9995;
  /// A signature that moves the readings by less than this share of `secant_step` per SI unit is rounding.
  double least_signature = 1e-7;
  /// Readings jump with a size if they move twice as far as by their derivative, and if `less` of a step moves them by
  /// more than `curved` of that, in a pattern whose cosine with that of the step is above this: else no size shows.
  /// Half a step may not reach the first jump.
  double less = 0.75, follows = 0.3;
  int most_halvings = 12; ///< of the size that moves readings by what is left of them, from the one by the derivative
  /// Sizes tried where readings jump: up to so many times that size, because what explains the residuals is of their
  /// size; in so many steps of each sign, or steps and directions of a pair. A step is a fraction of a jump.
  double most_start = 4;
  int steps_of_size = 32, steps_of_pair = 12, start_directions = 32;
  /// If one of them explains something (`decisive`), more are tried about so many of the best, so many about each: this
  /// often, first at distances of a step, then at this share of the distance before.
  Index close_starts = 8, starts_between = 16;
  int closer_starts = 2;
  double closer_start = 0.3;
  /// A size counts so many times the angle, in rad, by which its signature turns from that of its neighbour, up to one:
  /// t / sqrt(2 pi), by which a tube of this length is more probable than one signature to reach t = 5 (Hotelling
  /// 1939).
  double turn_counts = 2;
  std::size_t most_cells = 60;          ///< groups of readings for which a declared quantity is tried apart, by cost
  std::size_t most_parts = 12;          ///< values of a label at which effects are tried apart, by cost
  double dependence_share = 0.1;        ///< share of a signature's variance that a condition must explain to be named
  std::size_t dependence_bins = 8;      ///< groups of neighbouring values of a condition there
  std::size_t most_label_groups = 30;   ///< groups of a label for which steps and dependence are tried
  std::size_t most_omnibus_groups = 12; ///< groups of a label for which "any value per group" is tried
  std::size_t most_table_cells = 60;    ///< levels, or combinations of levels, at which "any value" is tried, by cost
  /// The same where nothing else explains what repeats; and readings times cells up to which it is, by cost.
  std::size_t most_wide_cells = 400, most_wide_entries = 600000;
  std::size_t least_repeats = 2; ///< readings at each of them, on average
  std::size_t most_harmonics = 6;
  /// Periods tried: so many to the resolution of the range (a peak's loss on the grid is about 5 % at most), and cycles
  /// over the range up to which they are, by cost.
  double wave_grid = 4, most_cycles = 500;
  /// Share of a step by which levels may miss an even grid; on such a grid the search ends at two steps a period.
  double jittered_step = 0.1;
  /// Times that many cycles are sought where levels are uneven, as ISO 230-2 sets targets. By cost.
  double uneven_reach = 4;
  /// The same share for the note on shorter periods that look the same: an alias as long as a step is then off by an
  /// eighth of a radian.
  double uneven_step = 0.02;
  double shown_wave = 3;  ///< amplitude in u from which a wave per turn is told
  double own_wave = 0.5;  ///< share of a wave that the declared model must leave
  /// Places tried, by cost, where a part may have been changed or changed back, before those between the best two.
  std::size_t most_ends = 30;
  double drift_forms = 4; ///< independent forms of a drift that levels off, between the shortest and the longest
  double lag_forms = 4;   ///< the same of a condition that acts late
  double recorded_lag = 0.95; ///< correlation with another column from which this says what acts late
  /// A shape of which so many successive readings hold this share is one of outliers.
  Index few_readings = 3;
  double few_share = 0.75;
  /// The same of what is removed without what other readings lose by it, as three of ten readings hold that are all
  /// moved alike.
  double few_gain = 0.3;
  /// Time constants tried: so many, from this share of the duration (three readings at least) to this multiple of it.
  /// Beyond the ends a rise is a step or a line.
  int time_constants = 6;
  double shortest = 1.0 / 30, longest = 2;
  int omnibus_columns = 5, fine_omnibus_columns = 12; ///< columns of a smooth dependence, and of a finer one
  std::size_t levels_for_fine_omnibus = 30;           ///< more levels than this for the finer one
  double confounded = 0.98; ///< covariates correlated more than this have no product of their own

  // ---- Fit ----
  /// A signature of which the declared model leaves a smaller share is not tested: what is left is of the size of what
  /// a linearised model neglects.
  double absorbed_share = 1e-5;
  /// 2 ln L by which no signature's gain on pure noise differs between two covariance models.
  double beyond_chance = 20;
  /// 2 ln L that decides between two explanations: the 95 % quantile of chi-squared with one degree of freedom.
  double decisive = 3.84;
  double as_good = 1e-6;           ///< 2 ln L within which covariance models are equal: far above rounding
  int most_iterations = 14;        ///< Gauss-Newton iterations: smooth models need four, others gain nothing by more
  int most_scales = 10;            ///< scales of the noise in turn
  int most_offset_iterations = 20; ///< the same for offsets of blocks outside the fit
  int most_optima = 4;             ///< optima left for a better one where readings jump
  double converged = 1e-3;         ///< largest step of an unknown, in its standard uncertainty
  double stalled = 0.1;            ///< the same where no shorter step reduces the residuals: still a fit
  double noise_settled = 0.02;     ///< change of ln variance below which the scale of the noise is kept
  double noise_far = 0.5;          ///< share of the variance at which noise of unknown size is far from settled
  double noise_prior = 4;          ///< weight of the declared size of the noise, as a number of readings
  /// Sizes tried where readings jump: up to so many standard uncertainties either side, in these two spacings.
  double profile_reach = 6, profile_spacing = 0.25, profile_coarse = 1.5;
  int most_reaches = 6; ///< reaches tried, each twice the one before, while the likelihood rises to the end of one
  /// Readings jump if they bend by more than this many standard deviations of the noise, and by less than this share of
  /// their movement; beyond it some size would fit anything. Tuned.
  double least_jump = 0.1, most_jump = 0.25;
  /// Sizes with which readings jump are tried at random about the best so far, so many at once, from this share of
  /// their own size down to the second, each `jump_closer` times as far as before where none was better. Where another
  /// term came or went, from the third.
  Index jump_tries = 48;
  double jump_reach = 0.5, least_jump_reach = 0.005, jump_reach_again = 0.1, jump_closer = 0.7;
  int most_jump_batches = 40;
  /// Batches that tell how far the readings know these sizes; tries by size from which the next batch takes its spread,
  /// at least; and the finest spread, as a share of half their own size.
  int jump_samples = 12;
  std::size_t tries_that_tell = 5;
  double finest_jump_reach = 1e-3;
  double tangent_serves = 0.1; ///< largest difference of the tangent from the line through the steps, as its share

  // ---- Judgement ----
  std::size_t most_findings = 5; ///< terms or scatter found in one trace
  double equal_shapes = 2;       ///< 2 ln L by which shapes may differ that describe readings equally well
  /// A wave in a table by position is told: of so many levels chance seldom gives a wave so large a share.
  std::size_t levels_of_waves = 15;
  double share_of_waves = 0.8;
  /// Slopes by group that are told: of groups and levels enough, far beyond what correlated noise shows as well.
  std::size_t groups_of_alignments = 3, levels_of_alignments = 5;
  double share_of_alignments = 0.5, p_of_alignments = 1e-6;
  /// An effect that one rod or one tool alone has is taken to be so many times rarer than one of them all.
  double rarity_of_part = 10;
  /// A size far above typical ones, or of a sign that no such effect has, is taken to be so many times rarer.
  double rarity_of_implausible = 1000;
  double beyond_doubt = 25; ///< 2 ln L beyond which no simulation is needed: five standard deviations
  /// 2 ln L up to which a shape that fits better than an effect is of equal merit: the effect has a cause.
  double equal_merit = 4;
  /// A p-value between these multiples of alpha asks for more draws, each time this many times as many, up to the
  /// second factor, unless it is this many standard deviations of the draws away from alpha.
  double unsure_low = 0.4, unsure_high = 2, more_draws = 4, most_draws = 16, sure = 3;
  double alike = 0.995;           ///< cosine of projected signatures that no data of this design distinguish. Tuned.
  std::size_t rival_draws = 199;  ///< simulated data sets that judge a lead
  double shape_lead_p = 0.01;     ///< p-value below which a shape's lead over an effect excludes the effect
  double rival_lead_p = 0.05;     ///< p-value below which a lead excludes a rival from the class
  std::size_t most_refitted = 12; ///< candidates refitted with the whole model, by cost
  std::size_t rival_shapes = 3;   ///< plain shapes compared with the best effect
  std::size_t most_shapes = 6;    ///< shapes tried where no effect passes
  std::size_t most_paired = 60;   ///< candidates whose pairs with all others are tried, by cost
  double pairs_alpha = 0.2;       ///< share of alpha that pairs may use where nothing passes alone
  /// A candidate could still win if its score is at least this share of the best one's, less a constant (2 ln L).
  /// Tuned.
  double contender_share = 0.6, contender_margin = 5;
  double noise_small_p = 1e-3;             ///< the noise is called smaller than declared below this
  std::size_t robust_freedom = 30;         ///< degrees of freedom from which the robust scale measures the noise's size
  std::size_t blocks_for_folds = 3;        ///< blocks from which cross-validation leaves out blocks
  std::size_t stretches = 5;               ///< else stretches of the sequence
  std::size_t readings_above_unknowns = 4; ///< readings needed beyond the number of unknowns
  double exact = 1e-12;                    ///< residuals below this share of the largest reading are rounding
  double detected = 1.2816;                ///< normal quantile of nine cases in ten, for detection limits
  std::size_t compared = 40;               ///< ranked candidates whose correlation with the best is computed, by cost
  double mostly_absorbed = 0.1; ///< identifiable share below which the ranking names what absorbs the signature

  // ---- Findings ----
  /// Growth of the hold-out's root mean square that vetoes a finding, and the standard deviations by which its
  /// predicted change must be larger than the readings show: a right finding is overstated so in one of twenty.
  double veto_growth = 1.05, overstated = 1.645;
  /// The same of what must seldom be rejected by chance: what the last of several rounds found, which is judged once
  /// more, and what all readings together show beyond this (2 ln L), which one false alarm in 150 exceeds.
  double overstated_surely = 3, outweighs = 10;
  /// Growth at which a drift is vetoed beyond its end, too: one that levels off there leaves at most about its range,
  /// of which a constant leaves half; curves that cancel only where they were fitted leave any multiple.
  double astray = 2;
  double insensitive = 1e-9;     ///< share of a signature in the hold-out blocks below which they cannot judge it
  std::size_t noise_draws = 199; ///< data sets of pure noise that "noise alone" is computed from
  /// A shape parameter is a size where its u is below this share of it, and has a distribution in the traced scenario
  /// below the second: a normal one must not reach beyond zero.
  double known_shape = 1, normal_shape = 0.2;
  /// Variance of a declared draw, or of a combination of them, of what was declared: below it readings say something of
  /// them, and the traced scenario holds what.
  double informed_variance = 0.9;
  /// Correlation of an estimate and a declared draw from which the traced scenario holds it: less changes the u of a
  /// prediction by 5 % at most.
  double told_correlation = 0.1;
  /// Times the upper end of an effect's typical sizes, and the lower end, beyond which a size is likely an alias's.
  double implausible_size = 5, negligible_size = 0.02;
  double implausible_shift = 10;     ///< times the declared standard uncertainty of a quantity that cause a remark
  double reported_correlation = 0.2; ///< serial correlation from which the trace mentions it
  /// Serial correlation from which the first sentence does: most white noise of twenty readings stays below it.
  double strong_correlation = 0.4;
  double told_scatter = 0.5; ///< share of the noise from which scatter that is no finding is told as well
  /// A split must separate the members by this much (2 ln L: three standard deviations), and by this factor more than
  /// the present data do.
  double split = 9, split_gain = 1.5;
  std::size_t split_readings = 24; ///< readings of the proposed measurement
  std::size_t most_jumping = 5;    ///< effects named where jumps may not have been crossed
  std::size_t most_curve_points = 24;
  /// Ratios of scatter to noise in the profile likelihood: from the lowest, over this factor, in equal steps of ln.
  double scatter_low = 0.05, scatter_span = 4000;
  int scatter_steps = 60;
  int most_scatter_sweeps = 4; ///< over components that are fitted together, one after the other
  std::size_t least_scatter_groups =
      3; ///< groups of a stated set-up step whose scatter is written, if not searched for
  /// Degrees of freedom with which scatter is written at least: a t distribution of fewer has no standard uncertainty.
  double least_scatter_freedom = 3;
};

inline constexpr Criteria criteria;

} // namespace gumshoe::tracing
