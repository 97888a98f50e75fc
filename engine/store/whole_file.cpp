#include "store/whole_file.h"

#include <filesystem>

#include "base/error.h"
#include "store/identity.h"
#include "store/place.h"

namespace gumshoe::store {

void require_writable(const std::string& path) {
  const Lock lock(hdf5::library());
  naming(path, [&] {
    const std::string target = destination(path);
    std::error_code none;
    if (!std::filesystem::exists(target) || std::filesystem::file_size(target, none) == 0) return;
    try {
      if (!is_hdf5(target)) throw OutputError("it is not an HDF5 file");
      read_stored(open_file(target, H5F_ACC_RDONLY));
    } catch (const OutputError& error) {
      throw OutputError("not overwritten", "it is not a Gumshoe result: " + error.problems().front().what,
                        "choose another name");
    }
  });
}

void write_whole(const std::string& path, const scenario::Scenario& s, std::uint64_t seed, std::uint64_t samples,
                 const std::function<void(hid_t file)>& contents) {
  Identity identity = identity_of(s);
  identity.design = scenario::name(scenario::Design::monte_carlo);
  identity.seed = seed;
  identity.samples = samples;
  identity.store_samples = false;
  const Lock lock(hdf5::library());
  survive_size_limit();
  naming(path, [&] {
    replace_file(destination(path), [&](const std::string& temporary) {
      const hdf5::Handle file = open_file(temporary, H5F_ACC_TRUNC);
      write_identity(file, identity);
      hdf5::write_attribute(file, "title", s.title);
      hdf5::write_attribute(file, "coverage_probability", s.analysis.coverage_probability);
      contents(file);
      hdf5::write_attribute(file, "complete", 1);
      hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write the file");
    });
  });
}

} // namespace gumshoe::store
