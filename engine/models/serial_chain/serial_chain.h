#pragma once
/// A target on a machine or a robot that the scenario describes, measured by an instrument: where the target is, and
/// what the instrument indicates.
#include <memory>
#include <vector>

#include "chain/drive.h"
#include "models/made_card.h"
#include "models/model.h"

namespace gumshoe::models::serial_chain {

/// What the instrument indicates: three coordinates in its frame, or the distance from its origin.
enum class Measured { position, distance };

/// From `first_of_axes` on, every error of every axis and what belongs to its drive.
enum Quantity {
  base_x, ///< place of the machine's frame in that of the instrument
  base_y,
  base_z,
  base_a, ///< orientation of the machine's frame in that of the instrument: Rx Ry Rz
  base_b,
  base_c,
  target_x, ///< in the frame of the last component
  target_y,
  target_z,
  gravity_x, ///< in the frame of the bed
  gravity_y,
  gravity_z,
  first_of_axes
};

/// Data of a model, to which Model::context points.
struct SerialChain {
  SerialChain(const chain::MachineDescription& description, Measured what)
      : machine(description), measured(what) {}
  chain::Machine machine;
  Measured measured;
  /// Where quantity first_of_axes + j belongs: axis, and ErrorKind, or error_kinds + DriveValue.
  struct Place {
    std::size_t axis;
    int kind;
  };
  std::vector<Place> place_of;
  std::unique_ptr<MadeCard> card;
  Model model{};
  std::size_t indications() const { return measured == Measured::position ? 3 : 1; }
  std::size_t measurands() const { return 3 + indications(); }
  std::size_t payload() const { return machine.axes().size(); } ///< its condition follows the commands
};

/// Errors that the description states are the quantities' defaults. Throws InputError if the description is wrong.
MadeModel make(const chain::MachineDescription& description, Measured measured);

/// The chain at one reading. Axes move when told to, so that those that stay as they are need not move again.
template <class T> class Moving {
public:
  explicit Moving(const SerialChain& p)
      : q(first_of_axes, T(0.0)), commands(p.machine.axes().size(), T(0.0)),
        errors(commands.size() * chain::error_kinds, T(0.0)), drives(commands.size() * chain::drive_values, T(0.0)),
        p_(p), free_(commands.size()), moved_(commands.size()), before_(commands.size() + 1),
        deflections_(commands.size(), T(0.0)) {}

  std::vector<T> q;              ///< the first quantities, up to first_of_axes
  std::vector<T> commands;       ///< m or rad
  std::vector<T> errors, drives; ///< of every axis, error_kinds and drive_values
  T payload = T(0.0);            ///< kg

  void set(std::size_t quantity, const T& value) {
    if (quantity < first_of_axes) {
      q[quantity] = value;
      return;
    }
    const auto& [axis, kind] = p_.place_of[quantity - first_of_axes];
    const auto k = static_cast<std::size_t>(kind);
    if (kind < chain::error_kinds)
      errors[axis * chain::error_kinds + k] = value;
    else
      drives[axis * chain::drive_values + (k - chain::error_kinds)] = value;
  }

  /// Moves axis i to its command, without load.
  void move(std::size_t i) { free_[i] = moved(i, T(0.0)); }

  /// Place of the target in the frame of the component that carries the workpiece; of the bed, if there is none.
  /// @param loaded whether gravity deflects axes; false only where no axis is compliant
  Vector3<T> target(bool loaded) {
    const Vector3<T> at{q[target_x], q[target_y], q[target_z]};
    const std::size_t n = commands.size(), sides = p_.machine.on_workpiece_side();
    moved_ = free_;
    if (loaded) {
      deflect(0, sides, T(0.0), {});
      deflect(sides, n, payload, at);
      for (std::size_t i = 0; i < n; ++i) moved_[i] = moved(i, deflections_[i]);
    }
    return inverse(along(0, sides)) * (along(sides, n) * at);
  }

  /// The same in the frame of the instrument.
  Vector3<T> in_instrument(const Vector3<T>& target) const {
    return base() * target + Vector3<T>{q[base_x], q[base_y], q[base_z]};
  }
  /// A point of the instrument's frame in that of the machine.
  Vector3<T> from_instrument(const Vector3<T>& point) const {
    return transposed(base()) * (point - Vector3<T>{q[base_x], q[base_y], q[base_z]});
  }

  const std::vector<T>& deflected() const { return deflections_; }
  const std::vector<Pose<T>>& poses() const { return moved_; }

private:
  Matrix3<T> base() const { return rotation(q[base_a], q[base_b], q[base_c]); }

  Pose<T> moved(std::size_t i, const T& further) const {
    const chain::Axis& axis = p_.machine.axes()[i];
    const T command = chain::followed(axis, commands[i], drives.data() + i * chain::drive_values);
    return chain::motion(axis, T(command + axis.sense * further), errors.data() + i * chain::error_kinds);
  }
  void deflect(std::size_t from, std::size_t to, const T& mass, const Vector3<T>& at) {
    chain::deflections(p_.machine.axes().subspan(from, to - from), moved_.data() + from,
                       errors.data() + from * chain::error_kinds, drives.data() + from * chain::drive_values,
                       {q[gravity_x], q[gravity_y], q[gravity_z]}, mass, at, before_.data(),
                       deflections_.data() + from);
  }
  Pose<T> along(std::size_t from, std::size_t to) const {
    Pose<T> pose;
    for (std::size_t i = from; i < to; ++i) pose = pose * moved_[i];
    return pose;
  }

  const SerialChain& p_;
  std::vector<Pose<T>> free_, moved_, before_;
  std::vector<T> deflections_;
};

/// What the instrument indicates of a target in its frame: three values, or one.
template <class T> void indicate(const SerialChain& p, const Vector3<T>& seen, T* out) {
  if (p.measured == Measured::distance)
    out[0] = length(seen);
  else
    out[0] = seen.x, out[1] = seen.y, out[2] = seen.z;
}

/// The measurands: the target by the chain, and by how much the reading deviates from it, in the machine's frame; of a
/// distance, along the line of sight.
template <class T>
void measure(const SerialChain& p, const Moving<T>& chain, const Vector3<T>& target, const T* read, T* out) {
  out[0] = target.x, out[1] = target.y, out[2] = target.z;
  if (p.measured == Measured::distance) {
    out[3] = read[0] - length(chain.in_instrument(target));
    return;
  }
  const Vector3<T> off = chain.from_instrument({read[0], read[1], read[2]}) - target;
  out[3] = off.x, out[4] = off.y, out[5] = off.z;
}

} // namespace gumshoe::models::serial_chain
