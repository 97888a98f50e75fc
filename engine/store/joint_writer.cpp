#include "store/results_writer.h"
#include "store/table.h"

namespace gumshoe::store {
using namespace analysis;

namespace {

void write_region(hid_t group, const JointRegion& region) {
  hdf5::write_attribute(group, "coverage_probability", region.coverage_probability);
  hdf5::write_attribute(group, "k_p", region.k_p);
  hdf5::write_attribute(group, "k_p_se", region.k_p_se);
  hdf5::write_attribute(group, "k_q", region.k_q);
  hdf5::write_attribute(group, "k_q_se", region.k_q_se);
  hdf5::write_attribute(group, "remark", region.remark);
  const auto si = column(region.outputs, &propagation::Output::si_unit);
  const std::string units = common_units(si);
  const std::string squared = units == "1" || units == "see units" ? units : "(" + units + ")2";
  // netCDF readers want the two axes of a matrix to be two dimensions.
  Table rows(group, "output", region.outputs.size());
  const Table columns(group, "other_output", region.outputs.size());
  rows.texts("name", column(region.outputs, &propagation::Output::name), "output");
  rows.units(si, column(region.outputs, &propagation::Output::unit));
  rows.numbers("estimate", region.estimate, units, "estimate: mean of the valid samples");
  rows.matrix("covariance", columns, region.covariance, squared, "covariance of the outputs, from the samples");
  rows.matrix("correlation", columns, region.correlation, "1",
              "correlation coefficients, NaN where a variance is zero");
  if (!region.gum_covariance.empty())
    rows.matrix("gum_covariance", columns, region.gum_covariance, squared,
                "covariance by the law of propagation, JCGM 102 6.2");
}

void write_circular(hid_t file, const std::vector<CircularSummary>& rows) {
  if (rows.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, "circular");
  Table table(group, "output", rows.size());
  const auto si = column(rows, [](const CircularSummary& c) { return c.output.si_unit; });
  const std::string units = common_units(si);
  table.texts("name", column(rows, [](const CircularSummary& c) { return c.output.name; }), "output, an angle");
  table.units(si, column(rows, [](const CircularSummary& c) { return c.output.unit; }));
  table.numbers("mean_direction", column(rows, &CircularSummary::mean_direction), units,
                "mean direction on the circle, NaN if there is none");
  table.numbers("resultant_length", column(rows, &CircularSummary::resultant_length), "1",
                "mean resultant length R: 1 all in one direction, 0 none preferred");
  table.numbers("standard_deviation", column(rows, &CircularSummary::standard_deviation), units,
                "circular standard deviation sqrt(-2 ln R)");
  table.numbers("low", column(rows, &CircularSummary::low), units,
                "shortest arc of the coverage probability, beginning");
  table.numbers("high", column(rows, &CircularSummary::high), units, "shortest arc, end; not below low, may pass pi");
  table.texts("remark", column(rows, &CircularSummary::remark), "when the linear statistics mislead");
}

void write_conformity(hid_t file, const std::vector<ConformityResult>& rows) {
  if (rows.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, "conformity");
  Table table(group, "test", rows.size());
  const auto si = column(rows, [](const ConformityResult& c) { return c.output.si_unit; });
  const std::string units = common_units(si), none = ", NaN if there is none", undone = ", NaN without a process",
                    excluded = ", NaN where the decision excludes it";
  const auto lengths = [&](const char* name, double ConformityResult::*member, const std::string& what) {
    table.numbers(name, column(rows, member), units, what);
  };
  const auto shares = [&](const char* name, double ConformityResult::*member, const std::string& what) {
    table.numbers(name, column(rows, member), "1", what);
  };
  using C = ConformityResult;
  table.texts("name", column(rows, [](const C& c) { return c.output.name; }), "output");
  table.units(si, column(rows, [](const C& c) { return c.output.unit; }));
  lengths("lower", &C::lower, "lower tolerance limit" + none);
  lengths("upper", &C::upper, "upper tolerance limit" + none);
  lengths("acceptance_lower", &C::acceptance_lower, "lower acceptance limit" + none);
  lengths("acceptance_upper", &C::acceptance_upper, "upper acceptance limit" + none);
  lengths("guard_band", &C::guard_band,
          "guard band: how far an acceptance limit lies inside its tolerance limit, negative outside");
  lengths("estimate", &C::estimate, "estimate");
  shares("conformance_probability", &C::conformance_probability, "conformance probability p_c, JCGM 106 clause 7");
  shares("conformance_probability_se", &C::conformance_probability_se, "Monte Carlo standard error of p_c");
  table.numbers("accepted", column(rows, [](const C& c) { return c.accepted ? 1 : 0; }), "1",
                "1 if the estimate lies within the acceptance limits");
  shares("specific_consumer_risk", &C::specific_consumer_risk, "accepted, but does not conform: 1 - p_c" + excluded);
  shares("specific_producer_risk", &C::specific_producer_risk, "rejected, but conforms: p_c" + excluded);
  lengths("process_mean", &C::process_mean, "mean of what is known before measuring" + undone);
  lengths("process_u", &C::process_u, "standard deviation of what is known before measuring" + undone);
  shares("process_conformance", &C::process_conformance, "share of the process that conforms" + undone);
  shares("posterior_conformance", &C::posterior_conformance,
         "conformance probability from process and measurement together, JCGM 106 clause 7, NaN if not known");
  shares("posterior_conformance_se", &C::posterior_conformance_se, "Monte Carlo standard error of it");
  shares("global_consumer_risk", &C::global_consumer_risk, "share accepted that does not conform" + undone);
  shares("global_consumer_risk_se", &C::global_consumer_risk_se, "Monte Carlo standard error of it");
  shares("global_producer_risk", &C::global_producer_risk, "share rejected that conforms" + undone);
  shares("global_producer_risk_se", &C::global_producer_risk_se, "Monte Carlo standard error of it");
  table.texts("statement", column(rows, &C::statement), "the decision in words");
}

} // namespace

void write_joint(hid_t file, const Results& r) {
  write_numbered(file, "joint", r.joint, write_region);
  write_circular(file, r.circular);
  write_conformity(file, r.conformity);
}

} // namespace gumshoe::store
