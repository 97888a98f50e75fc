#pragma once
/// How far the tool's point is from where the commands say, over a working volume: mean, u, and what causes them.
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/fields.h"
#include "propagation/experiment.h"
#include "scenario/volume_options.h"

namespace gumshoe::analysis {

/// The error is the tool's point by the machine as it is, minus that by the same machine without errors, at the same
/// commands and with the same tool, in the frame of the component that carries the workpiece; m.
struct VolumePoint {
  double x = 0, y = 0, z = 0;                   ///< the point without errors
  double error_x = 0, error_y = 0, error_z = 0; ///< mean
  double u_x = 0, u_y = 0, u_z = 0;
  double length = 0, u_length = 0; ///< mean and standard deviation of the error's length
};

/// An axis of the grid.
struct VolumeAxis {
  std::string name, unit, si_unit;
  double from = 0, to = 0;
  std::uint64_t points = 0;
};

/// What an input quantity does at the point of the largest error, along the mean error there.
struct VolumeShare {
  std::string name, unit, si_unit;
  double value = 0, standard_uncertainty = 0; ///< of the quantity, in SI
  double sensitivity = 0;                     ///< m per SI unit
  double error = 0;                           ///< part of the error, m; all add up to it, to first order
  double share = 0;                           ///< of the variance, with its correlations: all add up to 1
};

struct VolumeMap {
  std::vector<VolumeAxis> axes;
  std::vector<VolumePoint> points; ///< the last axis goes fastest
  std::vector<VolumeShare> shares; ///< the largest errors first
  std::uint64_t samples = 0, seed = 0;
  std::uint64_t failed = 0;    ///< samples without a value somewhere
  std::uint64_t largest = 0;   ///< point of the largest mean length
  std::uint64_t largest_u = 0; ///< point of the largest u of the length
  double linear_u = 0;         ///< u of the error along its mean at `largest`, by the law of propagation
  std::string statement;
  std::vector<std::string> notes;
};

/// The samples are those of the experiment: the first `scenario::Volume::samples` of its run. Quantities are those of
/// the first reading, whose draws per reading stand for one occasion.
/// @param threads 0: all processors; the bits do not depend on it
/// Throws InputError: quantities of the machine with values by label, too many points and samples.
VolumeMap volume(const propagation::Experiment& experiment, const scenario::Volume& over, int threads);

extern const Fields<VolumeMap> volume_fields; ///< attributes
extern const Fields<VolumeAxis> volume_axis_fields;
extern const Fields<VolumePoint> volume_point_fields;
extern const Fields<VolumeShare> volume_share_fields;

} // namespace gumshoe::analysis
