#include "models/sphere_probing/sphere_probing.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "base/error.h"
#include "base/kernel_choice.h"
#include "models/cards.h"
#include "models/intermediates.h"
#include "models/machine_rows.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::models::Kernels, sphere_probing)

namespace gumshoe::models::probing {

namespace {

using si::deg, si::mm;
constexpr char letters[] = "XYZ";
constexpr auto out_of_domain = code(Status::out_of_domain);

const SphereProbing& of(const void* context) { return *static_cast<const SphereProbing*>(context); }

/// Along each direction the slide with the plain letter, else the first one; SIZE_MAX if there is none.
std::array<std::size_t, 3> slides_of(std::span<const chain::Axis> axes) {
  std::array<std::size_t, 3> out{SIZE_MAX, SIZE_MAX, SIZE_MAX};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto d = static_cast<std::size_t>(axes[i].direction);
    if (!axes[i].rotary && !axes[i].link && (out[d] == SIZE_MAX || axes[i].name == std::string(1, letters[d])))
      out[d] = i;
  }
  return out;
}

template <class T> void store(const Vector3<T>& v, T* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

template <class T> bool spans(const Contact<T>& c) { return std::fabs(num::value(span_of(c.slides))) >= least_span; }

template <class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  const T* read = call.indications;
  store(deviation(contact(of(call.context), call.quantities, call.conditions, {read[0], read[1], read[2]})),
        call.measurands);
  return {};
}

template <class T> PointOutcome simulate_point(const PointCall<T>& call) {
  const auto c = contact<T>(of(call.context), call.quantities, call.conditions, {});
  store(closing(c), call.simulated);
  return {spans(c) ? std::uint8_t{0} : out_of_domain};
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  const SphereProbing& p = of(call.context);
  const double *q = call.quantities, *read = call.indications;
  const auto e = errors(p, q);
  std::vector<Intermediate> out;
  for (std::size_t i = 0; i < e.size() / chain::error_kinds; ++i) {
    const chain::Axis& axis = p.machine.axes()[i];
    const double* own = e.data() + i * chain::error_kinds;
    const auto line = chain::actual_line(axis, own);
    add(out, "direction of " + axis.name, line.direction, "1", 1);
    if (axis.rotary) add(out, "a point on the axis " + axis.name, line.point);
  }
  const auto c = contact<double>(p, q, call.conditions, {read[0], read[1], read[2]});
  add(out, "tip from the bed", c.tip);
  add(out, "sphere from the bed", c.sphere);
  for (std::size_t s = 0; s < 3; ++s)
    add(out, "tip against sphere by " + p.machine.axes()[p.slides[s]].name,
        s == 0   ? c.slides.x
        : s == 1 ? c.slides.y
                 : c.slides.z,
        "1", 1);
  out.push_back({"volume spanned by the slides", "1", span_of(c.slides)});
  add(out, "command at the sphere", closing(contact<double>(p, q, call.conditions, {})));
  const auto d = deviation(c);
  out.insert(out.end(),
             {{"deviation_x", "mm", d.x / mm}, {"deviation_y", "mm", d.y / mm}, {"deviation_z", "mm", d.z / mm}});
  return out;
}

std::string check(const PointCall<double>& call) {
  const SphereProbing& p = of(call.context);
  for (std::size_t i = 0; i < p.card->card().conditions.size(); ++i)
    if (!std::isfinite(call.conditions[i])) return "a condition is not finite";
  if (spans(contact<double>(p, call.quantities, call.conditions, {}))) return {};
  std::string at;
  for (const VariableCard& c : p.card->card().conditions)
    at += fmt::format("{}{} = {:.6g} {}", at.empty() ? " at " : ", ", c.name,
                      call.conditions[&c - p.card->card().conditions.data()] / (c.unit == "deg" ? deg : mm), c.unit);
  const auto name = [&](std::size_t s) { return p.machine.axes()[p.slides[s]].name; };
  return fmt::format("the slides {}, {}, {} move in one plane{}; the sphere is out of reach", name(0), name(1), name(2),
                     at);
}

bool solve_reads(std::size_t) { return true; }

const Kernels* kernels() { return GUMSHOE_BEST_KERNELS(sphere_probing); }

CardTexts texts_of(const SphereProbing& p, const chain::MachineDescription& d) {
  CardTexts t;
  t.name = "sphere_probing";
  t.title = "Probing a sphere on a described machine";
  t.summary = fmt::format("The slides of {} bring the tip to a sphere on the workpiece side at commanded angles; their "
                          "commands are recorded.",
                          d.name.empty() ? "a machine" : "the machine " + d.name);
  t.source = "exact kinematic chain, errors by ISO 230-1 and ISO 230-7";
  const auto triple = [&](auto& out, const std::string& name, const std::string& what) {
    for (const char c : {'x', 'y', 'z'})
      out.push_back({name + c, "mm", "m", fmt::format("{}, {}", what, static_cast<char>(c - 'x' + 'X')), 0, any});
  };
  triple(t.quantities, "probe_", "position of the tip's centre from the spindle's reference point at zero");
  triple(t.quantities, "sphere_", "position of the sphere's centre in the workpiece's frame");
  triple(t.quantities, "contact_",
         "position of the tip's centre from the sphere's centre at the reading, in the frame of the bed");
  for (const std::size_t at : p.error_of) {
    const chain::Axis& axis = p.machine.axes()[at / chain::error_kinds];
    t.quantities.push_back(error_row(axis, static_cast<int>(at % chain::error_kinds), p.machine.errors()[at]));
  }
  for (std::size_t i = 0; i < p.slide_of.size(); ++i) {
    const chain::Axis& axis = p.machine.axes()[i];
    if (p.slide_of[i] < 0) t.conditions.push_back(command_row(axis));
  }
  for (const std::size_t s : p.slides)
    t.indications.push_back({p.machine.axes()[s].name, "mm", "m", "command at which the tip is at the sphere", 0});
  triple(t.measurands, "deviation_",
         "deviation of the tip from its nominal position by the recorded commands, in the workpiece's frame");
  t.axes = cards_of_axes(p.machine);
  t.equations = {{"deviation = T * probe - W * sphere - contact",
                  "T, W: poses of the spindle and of the workpiece side at the recorded commands, by the axes of the "
                  "machine and their errors"}};
  return t;
}

} // namespace

std::string unreachable(const chain::MachineDescription& description) {
  const chain::Machine machine(description);
  const auto slides = slides_of(machine.axes());
  for (std::size_t d = 0; d < 3; ++d)
    if (slides[d] == SIZE_MAX) return fmt::format("the machine has no slide along {}", letters[d]);
  return {};
}

MadeModel make(const chain::MachineDescription& description) {
  if (const std::string why = unreachable(description); !why.empty()) throw InputError("machine: " + why);
  auto p = std::make_shared<SphereProbing>(description);
  const auto axes = p->machine.axes();
  p->slides = slides_of(axes);
  p->slide_of.assign(axes.size(), -1);
  p->condition_of.assign(axes.size(), SIZE_MAX);
  for (std::size_t s = 0; s < 3; ++s) p->slide_of[p->slides[s]] = static_cast<int>(s);
  std::size_t conditions = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (p->slide_of[i] < 0) p->condition_of[i] = conditions++;
    for (int k = 0; k < chain::error_kinds; ++k)
      if (has_error(axes[i], k)) p->error_of.push_back(chain::ErrorPlace{i, k}.index());
  }
  p->card = std::make_unique<MadeCard>(texts_of(*p, description));
  p->model.card = &p->card->card();
  p->model.kernels = &kernels;
  p->model.evaluate_gradient = &evaluate_point<Gradient>;
  p->model.evaluate_curvature = &evaluate_point<Curvature>;
  p->model.simulate_gradient = &simulate_point<Gradient>;
  p->model.explain = &explain;
  p->model.check = &check;
  p->model.solve_reads = &solve_reads;
  p->model.context = p.get();
  return {p, &p->model};
}

} // namespace gumshoe::models::probing
