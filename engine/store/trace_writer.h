#pragma once
/// Writes a trace as the groups `data`, `residuals` and `trace` of README.md. Private to this folder.
#include "base/card.h"
#include "store/hdf5.h"
#include "tracing/trace.h"

namespace gumshoe::store {

/// The readings: what was read, its labels, conditions and columns.
void write_data(hid_t file, const scenario::Scenario& scenario, const ModelCard& card);
/// One row per reading and indication: before, after, and what the noise may be.
void write_residuals(hid_t file, const scenario::Scenario& scenario, const ModelCard& card,
                     const tracing::Trace& trace);
/// Verdict, findings, candidates, detection limits, root mean squares, noise.
void write_trace_group(hid_t file, const tracing::Trace& trace);

} // namespace gumshoe::store
