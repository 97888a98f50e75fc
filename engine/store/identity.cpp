#include "store/identity.h"

#include <filesystem>
#include <fstream>
#include <tuple>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/inputs.h"
#include "base/instruction_set.h"
#include "base/memory.h"
#include "base/version.h"
#include "store/origin.h"
#include "store/sample_datasets.h"
#include "store/sample_file.h"

namespace gumshoe::store {

namespace {

auto fields(const Identity& i) {
  return std::tie(i.adaptive, i.scenario_hash, i.scenario_text, i.model, i.method, i.evaluation, i.design, i.version,
                  i.instruction_set, i.seed, i.store_samples, i.design_hash, i.shard, i.options, i.study_values);
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
          .design_hash = "",
          .command = "run",
          .scenario_place = place_of(s.file),
          .external = s.external,
          .shard = "",
          .options = "",
          .study_values = 0};
}

Record write_identity(hid_t file, const Identity& i, bool complete) {
  hdf5::write_attribute(file, "program", std::string("gumshoe"));
  hdf5::write_attribute(file, "git_hash", std::string(git_hash));
  for (const auto& [name, member] : identity_texts) hdf5::write_attribute(file, name, i.*member);
  for (const auto& [name, member] : shard_texts)
    if (!(i.*member).empty()) hdf5::write_attribute(file, name, i.*member);
  hdf5::write_attribute(file, "format_version", format_version);
  hdf5::write_attribute(file, "seed", i.seed);
  hdf5::write_attribute(file, "samples", i.samples);
  hdf5::write_attribute(file, "store_samples", i.store_samples ? 1 : 0);
  hdf5::write_attribute(file, "complete", complete ? 1 : 0);
  create_marker(file, "samples_done", "samples written so far");
  return {i, complete, {{"samples_done", place_of_dataset(file, "samples_done")}}, {}};
}

hdf5::Handle open_file(const std::string& path, unsigned flags) {
  require_memory(std::size_t{4} << 20); // the cache of a file has 1 MB
  const hdf5::Handle access = hdf5::own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "open");
  H5Pset_sieve_buf_size(access, 0);                                    // blocks are large: no second copy
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);                      // after an error nothing stays open
  if (flags & H5F_ACC_TRUNC) H5Pset_file_locking(access, false, true); // a draft is locked already
  if (flags & H5F_ACC_TRUNC)
    return hdf5::own(H5Fcreate(path.c_str(), flags, H5P_DEFAULT, access), H5Fclose, "create the file");
  return hdf5::own(H5Fopen(path.c_str(), flags, access), H5Fclose, "open the file");
}

void close_file(hdf5::Handle& file) {
  hdf5::require(H5Fflush(file, H5F_SCOPE_GLOBAL), "write the file");
  if (!file.close()) throw OutputError("cannot write the file", hdf5::last_error());
}

bool was_ours(const std::string& path, const std::string& place) {
  std::string head(std::size_t{1} << 20, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  const auto stands = [&](const std::string& text) { return head.find(text) != std::string::npos; };
  return stands("gumshoe") && stands("scenario_hash") && stands("format_version") && stands(place);
}

Stored read_identity(const std::string& path) {
  try {
    if (std::filesystem::is_directory(path)) throw NoResult("it is a directory");
    if (!std::filesystem::exists(path)) throw NoResult("the file does not exist");
    Record record = read_record(path);
    if (record.identity.command == history_command) throw NoResult("it is a history of gumshoe trace --append");
    Stored stored{std::move(record.identity), 0, 0, record.complete};
    const auto read_marker = [&](const char* name, std::uint64_t& done) {
      const auto marker = record.places.find(name);
      if (marker == record.places.end()) throw OutputError("it has no progress marker");
      RawFile(path, O_RDONLY).read(&done, sizeof done, marker->second.offset);
    };
    read_marker("samples_done", stored.samples_done);
    if (stored.identity.study_values > 0) read_marker("studies/values_done", stored.study_values_done);
    const std::uint64_t done = stored.samples_done, samples = stored.identity.samples;
    const bool none = record.rows.empty() && done == 0; // a result without samples
    if (done > samples || stored.study_values_done > stored.identity.study_values ||
        (stored.complete && done < samples && !none))
      throw OutputError("the progress marker is damaged");
    return stored;
  } catch (const NoResult& error) {
    throw NotAResult("'" + path + "' is not a Gumshoe result", error.problems().front().what);
  } catch (const OutputError& error) {
    const Problem& p = error.problems().front();
    throw InputError("'" + path + "' is not a Gumshoe result that can be read",
                     p.what + (p.why.empty() ? "" : ": " + p.why), "run the scenario again");
  }
}

Stored open_result(const std::string& path) {
  inputs::note(path);
  return read_identity(path);
}

void require_sound_samples(const std::string& path) {
  try {
    const Record record = read_record(path);
    const auto require_sound = [](SampleFile file, const char* what) {
      const std::uint64_t marked = file.marked();
      if (const std::uint64_t sound = file.sound(); sound < marked)
        throw OutputError(fmt::format("its {} are damaged from number {} on", what, sound));
    };
    if (!record.rows.empty()) require_sound(SampleFile(RawFile(path, O_RDONLY), record), "samples");
    if (record.identity.study_values > 0)
      require_sound(SampleFile::of_studies(RawFile(path, O_RDONLY), record), "values of studies");
  } catch (const OutputError& error) {
    const Problem& p = error.problems().front();
    throw InputError("'" + path + "' is damaged", p.what + (p.why.empty() ? "" : ": " + p.why),
                     "run the scenario again");
  }
}

} // namespace gumshoe::store
