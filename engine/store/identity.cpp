#include "store/identity.h"

#include <filesystem>
#include <fstream>
#include <tuple>

#include "base/instruction_set.h"
#include "base/version.h"

namespace gumshoe::store {

namespace {

constexpr int format_version = 1;

constexpr std::pair<const char*, std::string Identity::*> texts[] = {{"version", &Identity::version},
                                                                     {"instruction_set", &Identity::instruction_set},
                                                                     {"model", &Identity::model},
                                                                     {"method", &Identity::method},
                                                                     {"evaluation", &Identity::evaluation},
                                                                     {"design", &Identity::design},
                                                                     {"adaptive", &Identity::adaptive},
                                                                     {"scenario_file", &Identity::scenario_file},
                                                                     {"scenario_text", &Identity::scenario_text},
                                                                     {"scenario_hash", &Identity::scenario_hash},
                                                                     {"design_hash", &Identity::design_hash}};

auto fields(const Identity& i) {
  return std::tie(i.adaptive, i.scenario_hash, i.scenario_text, i.model, i.method, i.evaluation, i.design, i.version,
                  i.instruction_set, i.seed, i.store_samples, i.design_hash);
}

} // namespace

bool same_numbers(const Identity& a, const Identity& b) {
  return fields(a) == fields(b) && (!a.adaptive.empty() || a.samples == b.samples);
}

Identity identity_of(const scenario::Scenario& s) {
  return {.scenario_hash = s.hash,
          .scenario_text = s.text,
          .scenario_file = s.file,
          .model = s.model,
          .method = scenario::name(s.method),
          .evaluation = s.evaluation,
          .design = scenario::name(s.run.design),
          .version = version,
          .instruction_set = name(best_instruction_set()),
          .adaptive = "",
          .seed = s.run.seed,
          .samples = s.run.samples,
          .store_samples = s.run.store_samples,
          .design_hash = ""};
}

void write_identity(hid_t file, const Identity& i) {
  hdf5::write_attribute(file, "program", std::string("gumshoe"));
  hdf5::write_attribute(file, "git_hash", std::string(git_hash));
  for (const auto& [name, member] : texts) hdf5::write_attribute(file, name, i.*member);
  hdf5::write_attribute(file, "format_version", format_version);
  hdf5::write_attribute(file, "seed", i.seed);
  hdf5::write_attribute(file, "samples", i.samples);
  hdf5::write_attribute(file, "store_samples", i.store_samples ? 1 : 0);
  hdf5::write_attribute(file, "complete", 0);
  const std::uint64_t none = 0;
  const hdf5::Handle marker =
      hdf5::create_dataset(file, "samples_done", H5T_STD_U64LE, {1}, "1", "samples written so far");
  hdf5::make_scale(marker, "samples_done");
  hdf5::require(H5Dwrite(marker, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &none), "write the marker");
}

Stored read_stored(hid_t file) {
  Stored s;
  Identity& i = s.identity;
  if (hdf5::read_text(file, "program") != "gumshoe") throw NoResult("another program wrote it");
  if (hdf5::read_integer(file, "format_version") != format_version) throw NoResult("it has another format version");
  for (const auto& [name, member] : texts)
    if (member != &Identity::design_hash || H5Aexists(file, name) > 0) i.*member = hdf5::read_text(file, name);
  i.seed = hdf5::read_integer(file, "seed");
  i.samples = hdf5::read_integer(file, "samples");
  i.store_samples = hdf5::read_integer(file, "store_samples") != 0;
  s.complete = hdf5::read_integer(file, "complete") != 0;
  s.made_by = hdf5::has(file, "choice") ? "choose" : hdf5::has(file, "trace") ? "trace" : "";
  const hdf5::Handle marker =
      hdf5::own(H5Dopen2(file, "samples_done", H5P_DEFAULT), H5Dclose, "read the progress marker");
  const hdf5::Handle space = hdf5::own(H5Dget_space(marker), H5Sclose, "read the progress marker");
  if (H5Sget_simple_extent_npoints(space) != 1) throw OutputError("cannot read the progress marker");
  hdf5::require(H5Dread(marker, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &s.samples_done),
                "read the progress marker");
  if (s.samples_done > i.samples) throw OutputError("the progress marker is damaged");
  return s;
}

hdf5::Handle open_file(const std::string& path, unsigned flags) {
  const hdf5::Handle access = hdf5::own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "open");
  H5Pset_sieve_buf_size(access, 0);               // blocks are large: no second copy
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG); // after an error nothing stays open
  if (flags & H5F_ACC_TRUNC)
    return hdf5::own(H5Fcreate(path.c_str(), flags, H5P_DEFAULT, access), H5Fclose, "create the file");
  return hdf5::own(H5Fopen(path.c_str(), flags, access), H5Fclose, "open the file");
}

bool was_ours(const std::string& path) {
  std::string head(std::size_t{1} << 20, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  const auto stands = [&](const char* text) { return head.find(text) != std::string::npos; };
  return stands("gumshoe") && stands("scenario_hash") && stands("format_version");
}

bool is_hdf5(const std::string& path) { return H5Fis_hdf5(path.c_str()) > 0; }

Stored read_identity(const std::string& path) {
  const Lock lock(hdf5::library());
  try {
    if (std::filesystem::is_directory(path)) throw OutputError("it is a directory");
    if (!std::filesystem::exists(path)) throw OutputError("the file does not exist");
    if (!is_hdf5(path)) throw OutputError("it is not an HDF5 file");
    return read_stored(open_file(path, H5F_ACC_RDONLY));
  } catch (const OutputError& error) {
    const Problem& p = error.problems().front();
    throw InputError("'" + path + "' is not a Gumshoe result", p.what + (p.why.empty() ? "" : ": " + p.why));
  }
}

} // namespace gumshoe::store
