/// `gumshoe estimate`: fits the quantities marked `estimated` and writes them into a new scenario.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/fields_json.h"
#include "analysis/rounding.h"
#include "base/json_text.h"
#include "base/units.h"
#include "calibration/estimated_scenario.h"
#include "cli/command.h"
#include "store/origin.h"

namespace gumshoe::cli {

namespace {

struct EstimateOptions {
  std::string file, scenario_out, format = "text";
  int threads = 0;
  bool force = false;
};

using analysis::Json;
using analysis::number;
using calibration::Estimate;

double shown(double si, const calibration::Unknown& u, units::Kind kind) {
  return units::from_si(si, u.unit, u.si_unit, kind);
}

Json rows_json(const propagation::Experiment& e, const Estimate& r) {
  Json rows = Json::array();
  for (const auto& row : r.rows) {
    const auto& card = e.model().card->indications[row.indication];
    const std::string unit(card.unit), si(card.si_unit);
    Json one{{"reading", row.reading + 1},
             {"name", e.reading_names()[row.reading]},
             {"indication", card.name},
             {"unit", unit},
             {"measured", number(units::from_si(row.measured, unit, si))},
             {"simulated", number(units::from_si(row.simulated, unit, si))},
             {"residual", number(units::from_si(row.residual, unit, si, units::Kind::difference))},
             {"normalised", number(row.normalised)}};
    if (r.loss != least_squares::Loss::squared) one["weight"] = row.weight;
    rows.push_back(std::move(one));
  }
  return rows;
}

/// The unit of s where no noise is declared: the indications'; its factor from SI.
std::pair<std::string, double> unit_of_s(const propagation::Experiment& e, const Estimate& r) {
  if (r.noise_declared) return {"1", 1};
  const auto& card = e.model().card->indications[0];
  return {std::string(card.unit),
          units::from_si(1, std::string(card.unit), std::string(card.si_unit), units::Kind::difference)};
}

void print_json(const propagation::Experiment& e, const Estimate& r, const std::string& written) {
  const std::size_t p = r.parameters.size();
  Json parameters, names = Json::array(), correlation = Json::array(), covariance = Json::array();
  for (std::size_t i = 0; i < p; ++i) {
    const auto& one = r.parameters[i];
    parameters[one.unknown.name] = {
        {"value", number(shown(one.value, one.unknown, units::Kind::point))},
        {"standard_uncertainty", number(shown(one.standard_uncertainty, one.unknown, units::Kind::difference))},
        {"unit", one.unknown.unit},
        {"start", number(shown(one.unknown.start, one.unknown, units::Kind::point))},
        {"prior_u", one.unknown.prior_u > 0 ? number(shown(one.unknown.prior_u, one.unknown, units::Kind::difference))
                                            : Json(nullptr)},
        {"at_limit", one.at_limit}};
    names.push_back(one.unknown.name);
    Json c = Json::array(), v = Json::array();
    for (std::size_t j = 0; j < p; ++j) {
      c.push_back(number(r.correlation[i * p + j]));
      const double inner = shown(r.covariance[i * p + j], one.unknown, units::Kind::difference);
      v.push_back(number(shown(inner, r.parameters[j].unknown, units::Kind::difference)));
    }
    correlation.push_back(std::move(c));
    covariance.push_back(std::move(v));
  }
  const auto [unit, factor] = unit_of_s(e, r);
  Json out{{"scenario", e.scenario().file},
           {"hash", e.scenario().hash},
           {"parameters", parameters},
           {"names", names},
           {"correlation", correlation},
           {"covariance", covariance},
           {"s", number(r.s * factor)},
           {"s_unit", unit},
           {"degrees_of_freedom", number(r.degrees_of_freedom)},
           {"residual_sum_of_squares", number(r.residual_sum_of_squares * factor * factor)},
           {"noise_declared", r.noise_declared},
           {"chi_squared", number(r.chi_squared)},
           {"chi_squared_probability", number(r.chi_squared_probability)},
           {"rank", r.rank},
           {"condition", number(r.condition)},
           {"indistinguishable", r.indistinguishable},
           {"determined", r.determined},
           {"loss", least_squares::name(r.loss)},
           {"converged", r.solver.converged},
           {"solver",
            {{"reason", r.solver.reason},
             {"solver", r.solver.solver},
             {"iterations", r.solver.iterations},
             {"evaluations", r.solver.evaluations},
             {"cost_before", number(r.solver.cost_before)},
             {"cost_after", number(r.solver.cost_after)},
             {"gradient_norm", number(r.solver.gradient_norm)},
             {"relative_offset", number(r.solver.relative_offset)},
             {"step", number(r.solver.step)}}},
           {"rows", rows_json(e, r)},
           {"notes", r.notes},
           {"scenario_out", written.empty() ? Json(nullptr) : Json(written)}};
  std::cout << json_text(out) << '\n';
}

void print_text(const propagation::Experiment& e, const Estimate& r, const std::string& written) {
  if (!e.scenario().title.empty()) std::cout << printable(e.scenario().title) << '\n';
  std::size_t width = 9;
  for (const auto& p : r.parameters) width = std::max(width, p.unknown.name.size());
  std::cout << fmt::format("{:<{}}  {:>18}  {:>14}  unit\n", "estimated", width, "value", "u");
  for (const auto& p : r.parameters) {
    const double value = shown(p.value, p.unknown, units::Kind::point),
                 u = shown(p.standard_uncertainty, p.unknown, units::Kind::difference);
    std::string v, w;
    if (std::isfinite(u) && u > 0 && (std::fabs(u) < 1e-6 || std::fabs(value) >= 1e9)) {
      const int digits =
          std::max(1, static_cast<int>(std::floor(std::log10(std::fabs(value))) - std::floor(std::log10(u)) + 1));
      v = fmt::format("{:.{}e}", value, std::min(digits, 16));
      w = fmt::format("{:.1e}", u);
    } else if (std::isfinite(u) && u > 0) {
      const int decimals = analysis::decimals_for(u);
      v = analysis::fixed(value, decimals);
      w = analysis::fixed(u, decimals);
    } else {
      v = fmt::format("{:.10g}", value);
      w = u == 0 ? "0" : std::isinf(u) ? "not determined" : "unknown";
    }
    std::cout << fmt::format("{:<{}}  {:>18}  {:>14}  {}\n", p.unknown.name, width, v, w, p.unknown.unit);
  }
  const std::size_t p = r.parameters.size();
  if (p > 1 && p <= 12) {
    std::cout << "correlation\n";
    for (std::size_t i = 0; i < p; ++i) {
      std::cout << fmt::format("{:<{}}", r.parameters[i].unknown.name, width);
      for (std::size_t j = 0; j <= i; ++j)
        std::cout << (std::isfinite(r.correlation[i * p + j]) ? fmt::format("  {:7.4f}", r.correlation[i * p + j])
                                                              : "        -");
      std::cout << '\n';
    }
  }
  const auto [unit, factor] = unit_of_s(e, r);
  if (!(r.degrees_of_freedom > 0))
    std::cout << "no degrees of freedom: no reading is left to check the fit, or to tell the noise\n";
  else if (r.noise_declared)
    std::cout << fmt::format("chi-squared {:.4g}, {} degrees of freedom, probability of more {:.3g}\n", r.chi_squared,
                             r.degrees_of_freedom, r.chi_squared_probability);
  else
    std::cout << fmt::format("s = {:.4g}{}, {:.4g} degrees of freedom\n", r.s * factor, units::suffix(unit),
                             r.degrees_of_freedom);
  std::cout << fmt::format("rank {} of {}, condition number {:.3g}\n", r.rank, p, r.condition);
  for (const auto& d : r.indistinguishable) std::cout << "undetermined by these data: " << d << '\n';
  if (r.loss != least_squares::Loss::squared) {
    std::cout << fmt::format("loss {}, width {:.4g}\n", least_squares::name(r.loss), r.loss_width);
    for (const auto& row : r.rows) {
      if (row.weight >= 1 - 1e-3 || (r.loss != least_squares::Loss::huber && row.weight > 0.75)) continue;
      const auto& card = e.model().card->indications[row.indication];
      std::cout << fmt::format("down-weighted: {}, {}: weight {:.3f}, {:.3g} standard deviations\n",
                               e.reading_text(row.reading), card.name, row.weight, row.normalised);
    }
  }
  for (const auto& note : r.notes) std::cout << "note: " << note << '\n';
  std::cout << fmt::format("{}: {}; {} iterations, cost {:.6g} to {:.6g}\n",
                           r.solver.converged ? "converged" : "not converged", r.solver.reason, r.solver.iterations,
                           r.solver.cost_before, r.solver.cost_after);
  if (!written.empty()) std::cout << "written: " << written << '\n';
}

ExitCode estimate(const EstimateOptions& o) {
  const scenario::Scenario s = scenario::read(o.file, catalogue());
  const propagation::Experiment experiment(s);
  const std::string out = !o.scenario_out.empty() ? o.scenario_out : default_output(o.file, ".estimated.toml");
  const store::Origin origin = store::origin_of(s, "estimate", o.force);
  const store::Claim claim = store::claim_text(out, origin);
  const Estimate result = calibration::estimate(experiment, {o.threads});
  std::string written;
  bool refused = false;
  if (result.solver.converged) {
    std::string text;
    try {
      text = calibration::estimated_scenario(experiment, result, std::filesystem::path(out).parent_path().string());
    } catch (const InputError& why) { // the result stands; only its scenario cannot be written
      std::cerr << "no scenario is written: " << why.what() << '\n';
      refused = true;
    }
    if (!text.empty()) {
      store::Draft draft;
      draft.add(claim, store::signed_scenario(text, origin));
      draft.publish();
      written = out;
    }
  }
  if (o.format == "json")
    print_json(experiment, result, written);
  else
    print_text(experiment, result, written);
  if (refused) return ExitCode::bad_input; // lest one goes on with the scenario of an earlier fit
  if (result.solver.converged) return ExitCode::done;
  std::cerr << "error: the fit did not converge (" << result.solver.reason
            << "). Use other start values; where readings jump with what is estimated, "
               "as a mill's do from tooth to tooth, gumshoe trace seeks it.\n";
  return ExitCode::too_many_failures;
}

} // namespace

void add_estimate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("estimate", "fits the quantities marked estimated to the readings");
  const auto o = std::make_shared<EstimateOptions>();
  command->add_option("scenario", o->file, "scenario file (TOML)")->required();
  command->add_option("--scenario-out", o->scenario_out,
                      "scenario file for the estimates (default: results/SCENARIO.estimated.toml)");
  add_force(*command, o->force);
  add_external(*command);
  add_threads(*command, o->threads);
  command->add_option("--format", o->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  command->callback([=, &action] { action = [=] { return estimate(*o); }; });
}

} // namespace gumshoe::cli
