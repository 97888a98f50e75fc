#include "models/single_socket/procedures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gumshoe::models::single_socket {

namespace {

/// Beyond it a nanometre of the bar becomes more than a tenth of a millimetre.
constexpr double hopeless = 1e5, poor = 3;

/// Amplification of the directions of a step's stations.
double amplification(const Readings<double>& all, const Step<double>& step) {
  std::vector<Station<double>> stations;
  for (const std::size_t r : step.readings) stations.push_back(station(all.at[r]));
  return position_of(stations, std::vector<double>(stations.size()), true).amplification;
}
std::string of_step(double step) { return step == 0 ? "" : fmt::format(" of step {:g}", step); }

bool same(const Vector3<double>& a, const Vector3<double>& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

} // namespace

std::string problem_of(const Readings<double>& all, double number) {
  const Step<double> step(all, number);
  if (step.readings.size() < 3)
    return fmt::format("{} stations{}, but a position error has three components: at least three are necessary",
                       step.readings.size(), of_step(number));
  if (!(amplification(all, step) < hopeless))
    return fmt::format("the bar's directions at the stations{} lie in one plane: nothing determines the position error "
                       "square to it",
                       of_step(number));
  return "";
}

std::vector<std::string> remarks_on(const Readings<double>& all, double number) {
  const double a = amplification(all, Step<double>(all, number));
  if (a < poor) return {};
  return {fmt::format("the bar's directions at the stations{} are unfavourable: position errors are {:.1f} times as "
                      "uncertain as length changes, with three directions square to each other just as uncertain",
                      of_step(number), a)};
}

std::string Translated::check(const Readings<double>& all) {
  for (const auto& at : all.at)
    if (at.c.step != all.at[0].c.step)
      return "the readings are of both steps, but 'position' evaluates one (use the evaluation of your machine, such "
             "as "
             "rrttt)";
  return problem_of(all, 0);
}

std::string problem_of_both(const Readings<double>& all) {
  for (const double step : {1.0, 2.0})
    if (std::string problem = problem_of(all, step); !problem.empty()) return problem;
  const At<double>* first = nullptr;
  for (const auto& at : all.at) {
    if (at.c.step != 2) continue;
    if (!first) first = &at;
    const auto a = body(*first), b = body(at);
    if (!same(a.turned, b.turned) || !same(a.seated.point, b.seated.point) ||
        a.seated.commanded.alpha != b.seated.commanded.alpha || a.seated.commanded.beta != b.seated.commanded.beta ||
        a.seated.commanded.gamma != b.seated.commanded.gamma)
      return "the stations of step 2 differ in angles, pivot or point (they belong to one rotation)";
  }
  return "";
}

} // namespace gumshoe::models::single_socket
