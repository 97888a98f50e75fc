#pragma once
/// Probing a sphere on a machine that the scenario describes: which commands of its slides bring the tip to the sphere
/// at commanded angles, and how far off it stood by recorded ones.
#include <array>
#include <memory>

#include "models/made_card.h"
#include "models/model.h"
#include "models/sphere_probing/contact.h"

namespace gumshoe::models::probing {

/// Points first; from `first_error` on every error of every axis.
enum Quantity { probe_x, probe_y, probe_z, sphere_x, sphere_y, sphere_z, contact_x, contact_y, contact_z, first_error };
enum Measurand { deviation_x, deviation_y, deviation_z, measurands };

/// Data of a model, to which Model::context points.
struct SphereProbing {
  explicit SphereProbing(const chain::MachineDescription& description) : machine(description) {}
  chain::Machine machine;
  std::array<std::size_t, 3> slides{};   ///< axes whose commands are the indications X, Y, Z
  std::vector<int> slide_of;             ///< slide of each axis, or -1
  std::vector<std::size_t> condition_of; ///< condition of each axis that is not a slide
  std::vector<std::size_t> error_of;     ///< place in the row of errors of each quantity from first_error on
  std::unique_ptr<MadeCard> card;
  Model model{};
};

/// Reason why a valid description lacks one of the three slides ("the machine has no slide along Y"), or empty.
std::string unreachable(const chain::MachineDescription& description);

/// Errors that the description states are the quantities' defaults. Throws InputError if the description is wrong or a
/// direction has no slide.
MadeModel make(const chain::MachineDescription& description);

/// The points of a row of quantities, SI.
template <class T> Points<T> points(const T* q) {
  return {{q[probe_x], q[probe_y], q[probe_z]},
          {q[sphere_x], q[sphere_y], q[sphere_z]},
          {q[contact_x], q[contact_y], q[contact_z]}};
}

/// Errors of all axes in the chain's order; those that an axis cannot have are 0.
template <class T> std::vector<T> errors(const SphereProbing& p, const T* q) {
  std::vector<T> e(p.slide_of.size() * chain::error_kinds, T(0.0));
  for (std::size_t j = 0; j < p.error_of.size(); ++j) e[p.error_of[j]] = q[first_error + j];
  return e;
}

/// @param recorded commands of the three slides
template <class T>
Contact<T> contact(const SphereProbing& p, const T* q, const double* conditions, const Vector3<T>& recorded) {
  const auto axes = p.machine.axes();
  const std::vector<T> e = errors(p, q);
  const T slides[] = {recorded.x, recorded.y, recorded.z};
  std::vector<Moved<T>> at;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const int s = p.slide_of[i];
    at.push_back(moved(axes[i], s >= 0, s >= 0 ? slides[s] : T(conditions[p.condition_of[i]]),
                       e.data() + i * chain::error_kinds));
  }
  return contact(at.data(), p.slide_of, p.machine.on_workpiece_side(), points(q));
}

} // namespace gumshoe::models::probing
