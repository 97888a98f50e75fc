#include "store/whole_file.h"

#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "store/identity.h"
#include "store/place.h"

namespace gumshoe::store {

namespace {

template <class Action> void naming(const std::string& path, Action action) {
  try {
    action();
  } catch (const OutputError& error) {
    const Problem& p = error.problems().front();
    if (p.what.find(path) != std::string::npos) throw;
    throw OutputError("'" + path + "': " + p.what, p.why, p.remedy);
  }
}

} // namespace

void require_writable(const std::string& path) {
  const Lock lock(hdf5::library());
  naming(path, [&] {
    const std::string target = destination(path);
    std::error_code none;
    if (!std::filesystem::exists(target) || std::filesystem::file_size(target, none) == 0) return;
    try {
      if (!is_hdf5(target)) throw OutputError("no HDF5 file");
      read_stored(open_file(target, H5F_ACC_RDONLY));
    } catch (const OutputError& error) {
      throw OutputError("not overwritten", "it is no result of ours: " + error.problems().front().what,
                        "choose another name");
    }
  });
}

void write_whole(const std::string& path, const Identity& identity, const std::string& title,
                 double coverage_probability, const std::function<void(hid_t file)>& contents) {
  const Lock lock(hdf5::library());
  survive_size_limit();
  naming(path, [&] {
    const std::string target = destination(path), temporary = temporary_name(target);
    try {
      const hdf5::Handle file = open_file(temporary, H5F_ACC_TRUNC);
      write_identity(file, identity);
      hdf5::write_attribute(file, "title", title);
      hdf5::write_attribute(file, "coverage_probability", coverage_probability);
      const std::uint64_t none = 0; // samples are not kept
      const hdf5::Handle marker =
          hdf5::create_dataset(file, "samples_done", H5T_STD_U64LE, {1}, "1", "samples written so far");
      hdf5::make_scale(marker, "samples_done");
      hdf5::require(H5Dwrite(marker, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &none), "write the marker");
      contents(file);
      hdf5::write_attribute(file, "complete", 1);
      hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write the file");
    } catch (...) {
      std::remove(temporary.c_str());
      throw;
    }
    if (std::rename(temporary.c_str(), target.c_str()) != 0) {
      std::remove(temporary.c_str());
      throw OutputError("cannot take its place");
    }
  });
}

} // namespace gumshoe::store
