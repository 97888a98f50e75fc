#pragma once
/// Readings to estimate from: rods against one beam, and points on a line.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "calibration/estimate.h"
#include "unit/known_case.h"

namespace estimate_case {

using namespace gumshoe;
using known_case::Case;

inline const calibration::Parameter& parameter(const calibration::Estimate& e, const std::string& name) {
  for (const auto& p : e.parameters)
    if (p.unknown.name == name) return p;
  throw InputError("no parameter " + name);
}

/// Rods of different radius and bottom: heights of a beam pitched by `pitch` degrees whose axis lies at `z` mm.
struct RodCase {
  double radius, fillet, elevation, azimuth;
};
inline constexpr RodCase rods[] = {{5, 0.03, 90, 0}, {5, 0.5, 89, 60}, {3, 0, 90, 0}, {8, 1, 88.5, 200}, {2, 2, 90, 0}};

inline std::string rod_scenario(const std::string& estimated, const std::vector<std::string>& readings,
                                const std::string& noise) {
  std::string text = "schema = 1\n[model]\nname = \"rod_gauging\"\n" + estimated;
  const auto by = [&](const char* name, const char* unit, auto member) {
    text += fmt::format("[quantities.{}.by.rod]\n", name);
    for (std::size_t i = 0; i < std::size(rods); ++i)
      text += fmt::format("r{} = \"{} {}\"\n", i, rods[i].*member, unit);
  };
  by("rod_radius", "mm", &RodCase::radius);
  by("fillet_radius", "mm", &RodCase::fillet);
  by("bottom_elevation", "deg", &RodCase::elevation);
  by("bottom_azimuth", "deg", &RodCase::azimuth);
  text += "[indications.spindle_z]\n" + noise + "rows = [\n";
  for (std::size_t i = 0; i < readings.size(); ++i)
    text += fmt::format("  {{ rod = \"r{}\", values = [\"{} mm\"] }},\n", i, readings[i]);
  return text + "]\n";
}

/// Indications of the rods for given quantities, as the model has them.
inline std::vector<std::string> simulated(double z_mm, double pitch_deg) {
  const std::vector<std::string> nothing(std::size(rods), "0");
  const Case c(
      rod_scenario("[quantities.laser_z]\nestimated = true\n[quantities.beam_pitch]\nestimated = true\n", nothing, ""));
  const auto unknowns = calibration::unknowns_of(c.experiment);
  const calibration::Simulation simulation(c.experiment, unknowns, 1);
  std::vector<double> x, out(simulation.rows());
  for (const auto& u : unknowns) x.push_back(u.name == "laser_z" ? z_mm * 1e-3 : pitch_deg * scenario_fixture::degree);
  REQUIRE(simulation(x.data(), out.data(), nullptr));
  std::vector<std::string> text;
  for (const double v : out) text.push_back(fmt::format("{:.17g}", v * 1e3));
  return text;
}

inline std::string line(const std::vector<double>& x, const std::vector<double>& y, const std::string& more,
                        const std::string& noise = "") {
  std::string text = "schema = 1\n[model]\nname = \"expression\"\n[model.indications]\ny = \"a + b * x\"\n"
                     "[model.measurands]\ny_2 = \"a + 2 * b\"\n[conditions]\nx = 0\n" +
                     more + "[indications.y]\n" + noise + "rows = [\n";
  for (std::size_t i = 0; i < x.size(); ++i)
    text += fmt::format("  {{ x = {:.17g}, values = [{:.17g}] }},\n", x[i], y[i]);
  return text + "]\n";
}
inline const std::string free_line =
    "[quantities.a]\nestimated = true\nvalue = 0.5\n[quantities.b]\nestimated = true\nvalue = 0.5\n";

} // namespace estimate_case
