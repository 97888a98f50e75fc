#include "store/history_file.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/version.h"
#include "store/identity.h"
#include "store/record.h"
#include "store/table.h"

namespace gumshoe::store {

using tracing::Campaign;
using tracing::index;
using tracing::Score;

namespace {

constexpr const char* kind = "evidence over campaigns";
constexpr double most_variants = 1e6;

/// Throws OutputError if the file is not as it was written: HDF5 is not safe on a damaged one.
void require_sound(const std::string& path) {
  if (read_record(path).identity.command != history_command)
    throw InputError(path + ": it is no history", "gumshoe trace --append did not write it", "give another name");
}

/// One row per size of every score, and the entries of their information, row by row.
void write_campaign(hid_t group, const Campaign& c) {
  hdf5::write_attribute(group, "id", c.id);
  hdf5::write_attribute(group, "title", c.title);
  hdf5::write_attribute(group, "model", c.model);
  hdf5::write_attribute(group, "model_title", c.model_title);
  hdf5::write_attribute(group, "model_equations", c.model_equations);
  hdf5::write_attribute(group, "date", c.date);
  hdf5::write_attribute(group, "readings", c.readings);
  hdf5::write_attribute(group, "squares", c.squares);
  hdf5::write_attribute(group, "degrees_of_freedom", c.freedom);
  std::vector<std::string> candidate, size, unit, si_unit;
  std::vector<int> variant;
  std::vector<double> score, information;
  for (const Score& s : c.scores) {
    for (std::size_t i = 0; i < s.sizes.size(); ++i) {
      candidate.push_back(s.candidate), variant.push_back(s.variant), size.push_back(s.sizes[i].name);
      unit.push_back(s.sizes[i].unit), si_unit.push_back(s.sizes[i].si_unit), score.push_back(s.score[index(i)]);
    }
    information.insert(information.end(), s.information.data(), s.information.data() + s.information.size());
  }
  Table rows(group, "size", score.size()), pairs(group, "pair", information.size());
  rows.texts("candidate", candidate, "effect");
  rows.numbers("variant", variant, "1", "position of the shape parameter that is held, from 0");
  rows.texts("quantity", size, "its size, as a scenario names it");
  rows.texts("unit", unit, "unit in which the size is shown");
  rows.texts("si_unit", si_unit, "SI unit of the size");
  const hdf5::Units per{"1 / si_unit", true}, squared{"1 / si_unit^2", true};
  rows.numbers("score", score, per, "g'Wr of the residuals r and the signature g of a unit of the size");
  pairs.numbers("information", information, squared, "g'Wg of the sizes of each effect, matrix after matrix");
  Table readings(group, "reading", c.rows.size());
  readings.numbers("reading_digest", c.rows, "1", "digest of what was read and set, in the order given");
}

Campaign read_campaign(hid_t group) {
  Campaign c{hdf5::read_text(group, "id"),
             hdf5::read_text(group, "title"),
             hdf5::read_text(group, "date"),
             static_cast<int>(hdf5::read_integer(group, "readings")),
             hdf5::read_number(group, "squares"),
             hdf5::read_number(group, "degrees_of_freedom"),
             {}};
  if (H5Aexists(group, "model") > 0) {
    c.model = hdf5::read_text(group, "model");
    c.model_title = hdf5::read_text(group, "model_title");
  }
  if (H5Aexists(group, "model_equations") > 0) c.model_equations = hdf5::read_text(group, "model_equations");
  if (hdf5::has(group, "reading_digest")) c.rows = hdf5::read_numbers(group, "reading_digest");
  if (!hdf5::has(group, "score")) return c; // nothing could be looked for
  const auto candidate = hdf5::read_texts(group, "candidate"), size = hdf5::read_texts(group, "quantity"),
             unit = hdf5::read_texts(group, "unit"), si_unit = hdf5::read_texts(group, "si_unit");
  const auto variant = hdf5::read_numbers(group, "variant"), score = hdf5::read_numbers(group, "score"),
             information = hdf5::read_numbers(group, "information");
  for (const std::size_t rows : {candidate.size(), size.size(), unit.size(), si_unit.size(), variant.size()})
    if (rows != score.size()) throw OutputError("the columns of a campaign differ in length");
  for (const double v : variant)
    if (!(v >= 0 && v <= most_variants)) throw OutputError("a variant of a candidate has no number");
  for (std::size_t first = 0, at = 0; first < score.size();) {
    std::size_t end = first;
    while (end < score.size() && candidate[end] == candidate[first] && variant[end] == variant[first]) ++end;
    const auto n = index(end - first);
    if (at + std::size_t(n * n) > information.size()) throw OutputError("a matrix of information is cut short");
    Score s{candidate[first],
            static_cast<int>(variant[first]),
            {},
            Eigen::Map<const tracing::Vector>(&score[first], n),
            Eigen::Map<const tracing::Matrix>(&information[at], n, n)};
    for (std::size_t i = first; i < end; ++i) s.sizes.push_back({size[i], unit[i], si_unit[i]});
    c.scores.push_back(std::move(s));
    at += std::size_t(n * n), first = end;
  }
  return c;
}

void write_evidence(hid_t file, const tracing::EvidenceOverTime& e) {
  const hdf5::Handle group = hdf5::create_group(file, "evidence");
  hdf5::write_attribute(group, "overall_log10", e.log_overall / std::numbers::ln10);
  std::vector<std::string> names;
  std::vector<double> logs;
  for (const auto& one : e.effects)
    names.push_back(one.candidate), logs.push_back(one.log_evidence / std::numbers::ln10);
  Table table(group, "effect", names.size(), names);
  table.numbers("evidence_log10", logs, "1",
                "decadic logarithm of the evidence for the effect, the search allowed for");
}

} // namespace

std::vector<Campaign> read_history(const std::string& path) {
  std::vector<Campaign> out;
  if (!std::filesystem::exists(path)) return out;
  const Lock lock(hdf5::library());
  try {
    require_sound(path);
    const hdf5::Handle file = open_file(path, H5F_ACC_RDONLY);
    const hdf5::Handle campaigns = hdf5::open_group(file, "campaigns");
    for (std::uint64_t k = 0; k < hdf5::read_integer(file, "campaigns"); ++k)
      out.push_back(read_campaign(hdf5::open_group(campaigns, fmt::format("{:03d}", k))));
  } catch (const OutputError& error) {
    throw InputError(path + ": it cannot be read as a history", error.problems().front().what);
  }
  return out;
}

void write_history(Draft& draft, const Claim& claim, const std::vector<Campaign>& campaigns,
                   const tracing::EvidenceOverTime& evidence) {
  const Lock lock(hdf5::library());
  survive_size_limit();
  naming(claim.path(), [&] {
    const std::string name = draft.add(claim);
    hdf5::Handle file = open_file(name, H5F_ACC_TRUNC);
    hdf5::write_attribute(file, "program", std::string("gumshoe"));
    hdf5::write_attribute(file, "version", std::string(version));
    hdf5::write_attribute(file, "kind", std::string(kind));
    hdf5::write_attribute(file, "campaigns", static_cast<std::uint64_t>(campaigns.size()));
    write_numbered(file, "campaigns", campaigns, write_campaign);
    write_evidence(file, evidence);
    close_file(file);
    Record record;
    record.identity.command = history_command;
    seal(name, record);
  });
}

} // namespace gumshoe::store
