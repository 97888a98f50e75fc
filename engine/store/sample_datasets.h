#pragma once
/// The group `outputs` of a result file: the samples of every output. Private to this folder; callers hold
/// hdf5::library().
#include <cstdint>
#include <string>
#include <vector>

#include "propagation/run.h"
#include "store/hdf5.h"
#include "store/record.h"

namespace gumshoe::store {

/// Makes the group and the digests, with room for `samples`, and records where they lie. `reading_labels`: at least as
/// many as the outputs know; throws std::logic_error if there are fewer. `of_errors`: of a virtual experiment.
void create_samples(hid_t file, const std::vector<propagation::Output>& outputs, std::uint64_t samples,
                    const std::vector<std::string>& reading_labels, bool of_errors, Record& record);

/// Makes a progress marker, 0.
void create_marker(hid_t parent, const std::string& name, const std::string& meaning);

/// Makes the group `studies` of a shard: room for so many values, their digests and their progress marker.
void create_study_values(hid_t file, std::uint64_t values, Record& record);

/// Where the values of a contiguous dataset lie.
Span place_of_dataset(hid_t file, const std::string& path);

} // namespace gumshoe::store
