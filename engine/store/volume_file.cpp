#include "store/volume_file.h"

#include "store/field_writer.h"
#include "store/results_writer.h"
#include "store/whole_file.h"

namespace gumshoe::store {

void write_volume(Draft& draft, const Claim& claim, const scenario::Scenario& s, const analysis::VolumeMap& map) {
  Identity identity = identity_of(s);
  identity.command = "volume";
  identity.seed = map.seed;
  identity.samples = map.samples;
  write_whole(draft, claim, identity, s, [&](hid_t file) {
    write_attributes(hdf5::create_group(file, "volume"), analysis::volume_fields, map);
    write_table(file, analysis::volume_axis_fields, map.axes);
    write_table(file, analysis::volume_point_fields, map.points);
    write_table(file, analysis::volume_share_fields, map.shares);
    write_list(file, "notes", map.notes, "decisions and warnings a reader must see");
  });
}

} // namespace gumshoe::store
