#include "analysis/volume.h"

namespace gumshoe::analysis {

using enum In;

// clang-format off: a field is a line or two
namespace {

constexpr Shown in_json{.json = same}, in_csv{.csv = same}, in_both{.json = same, .csv = same};
constexpr Unit metre{"m"};

using M = VolumeMap;
constexpr Field<M> map[] = {
    {"statement", of<&M::statement>, one, "the largest error in words", in_json},
    {"samples", of<&M::samples>, one, "draws of the input quantities", in_json},
    {"failed", of<&M::failed>, one, "draws without a value at some point", in_json},
    {"largest", of<&M::largest>, one, "point of the largest mean length of the error, by position", in_json},
    {"largest_u", of<&M::largest_u>, one, "point of the largest u of the length, by position", in_json},
    {"linear_u", of<&M::linear_u>, metre, "u of the error along its mean at `largest`, by the law of propagation",
     in_json}};

using A = VolumeAxis;
constexpr Field<A> axes[] = {{"name", of<&A::name>, one, "axis; the last one goes fastest over the points", in_both},
                             {"units", nullptr, units, "", {"unit", "unit"}},
                             {"from", of<&A::from>, difference, "first command", in_both},
                             {"to", of<&A::to>, difference, "last command", in_both},
                             {"points", of<&A::points>, one, "number of commands, evenly spaced", in_both}};

using P = VolumePoint;
constexpr Field<P> points[] = {
    {"x", of<&P::x>, metre, "place of the tool's point without errors, from the workpiece, X", in_both},
    {"y", of<&P::y>, metre, "the same, Y", in_both},
    {"z", of<&P::z>, metre, "the same, Z", in_both},
    {"error_x", of<&P::error_x>, metre, "mean error of that place, X", in_both},
    {"error_y", of<&P::error_y>, metre, "the same, Y", in_both},
    {"error_z", of<&P::error_z>, metre, "the same, Z", in_both},
    {"u_x", of<&P::u_x>, metre, "standard uncertainty of the error, X", in_both},
    {"u_y", of<&P::u_y>, metre, "the same, Y", in_both},
    {"u_z", of<&P::u_z>, metre, "the same, Z", in_both},
    {"length", of<&P::length>, metre, "mean length of the error", in_both},
    {"u_length", of<&P::u_length>, metre, "standard uncertainty of the length", in_both}};

using S = VolumeShare;
constexpr Field<S> shares[] = {
    {"name", of<&S::name>, one, "input quantity of the machine", in_both},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"value", of<&S::value>, difference, "estimate", in_both},
    {"standard_uncertainty", of<&S::standard_uncertainty>, difference, "its standard uncertainty", in_both},
    {"sensitivity", of<&S::sensitivity>, Unit::noted("m per SI unit of the row"),
     "of the error along its mean, at the point of the largest error"},
    {"error", of<&S::error>, metre, "part of the error along its mean there; they add up, to first order", in_both},
    {"share", of<&S::share>, one, "share of the variance there, with its correlations; they add up to 1", in_both}};

} // namespace

const Fields<VolumeMap> volume_fields{"volume", "", map};
const Fields<VolumeAxis> volume_axis_fields{"volume/axes", "axis", axes, "axes"};
const Fields<VolumePoint> volume_point_fields{"volume/points", "point", points, "points"};
const Fields<VolumeShare> volume_share_fields{"volume/causes", "cause", shares, "causes"};

} // namespace gumshoe::analysis
