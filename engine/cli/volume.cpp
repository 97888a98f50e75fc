/// `gumshoe volume`: how far is the tool from where the commands say, over the working volume?
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/fields_json.h"
#include "analysis/rounding.h"
#include "base/json_text.h"
#include "cli/command.h"
#include "cli/progress_line.h"
#include "scenario/volume.h"
#include "store/origin.h"
#include "store/volume_file.h"

namespace gumshoe::cli {

namespace {

struct VolumeOptions {
  std::string file, out, format = "text";
  std::optional<std::string> samples, seed;
  int threads = 0;
  bool force = false;
};

template <class Row> nlohmann::ordered_json list(const analysis::Fields<Row>& fields, const std::vector<Row>& rows) {
  auto out = nlohmann::ordered_json::array();
  for (const Row& row : rows) out.push_back(analysis::json(fields, row));
  return out;
}

void print_json(const analysis::VolumeMap& map, const std::string& file) {
  nlohmann::ordered_json out = analysis::json(analysis::volume_fields, map);
  out["axes"] = list(analysis::volume_axis_fields, map.axes);
  out["points"] = list(analysis::volume_point_fields, map.points);
  out["causes"] = list(analysis::volume_share_fields, map.shares);
  out["notes"] = map.notes;
  out["file"] = file;
  std::cout << json_text(out) << '\n';
}

void print_text(const analysis::VolumeMap& map, const std::string& file) {
  constexpr std::size_t listed = 12;
  const auto text = [](double x) { return analysis::with_suitable_unit(x, "mm", "m"); };
  std::cout << map.statement << '\n';
  const analysis::VolumePoint &worst = map.points[map.largest], &least_known = map.points[map.largest_u];
  std::cout << fmt::format("there: X {}, Y {}, Z {}; u by the law of propagation {}\n", text(worst.error_x),
                           text(worst.error_y), text(worst.error_z), text(map.linear_u));
  std::cout << fmt::format("largest u of the length: {}\n", text(least_known.u_length));
  std::cout << fmt::format("{:<24}{:>14}{:>12}\n", "there caused by", "error", "variance");
  for (std::size_t i = 0; i < std::min(listed, map.shares.size()); ++i)
    std::cout << fmt::format("{:<24}{:>14}{:>10.0f} %\n", map.shares[i].name, text(map.shares[i].error),
                             100 * map.shares[i].share);
  if (map.shares.size() > listed) std::cout << fmt::format("{} more in the result file\n", map.shares.size() - listed);
  if (map.failed > 0) std::cout << fmt::format("{} samples have no value at some point\n", map.failed);
  for (const std::string& note : map.notes) std::cout << "note: " << note << '\n';
  std::cout << fmt::format("{} points, {} samples, seed {}: {}\n", map.points.size(), map.samples, map.seed, file);
}

ExitCode volume(const VolumeOptions& o) {
  scenario::Scenario s = scenario::read(o.file, catalogue());
  scenario::Volume over = scenario::volume_of(s);
  if (o.samples) over.samples = whole_number(*o.samples, "--samples", 100, "1e4");
  if (o.seed) s.run.seed = whole_number(*o.seed, "--seed", 0, "1");
  const std::string out = !o.out.empty() ? o.out : default_output(o.file, ".volume.h5");
  const store::Claim claim = store::claim_result(out, store::origin_of(s, "volume", o.force)); // before the work
  if (!claim.remark.empty()) std::cerr << claim.remark << '\n';
  const propagation::Experiment experiment(s);
  const analysis::VolumeMap map = analysis::volume(experiment, over, o.threads);
  store::Draft draft;
  store::write_volume(draft, claim, s, map);
  draft.publish();
  if (o.format == "json")
    print_json(map, out);
  else
    print_text(map, out);
  return ExitCode::done;
}

} // namespace

void add_volume(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "volume", "maps the error of the tool's place and its uncertainty over a working volume ([volume])");
  const auto o = std::make_shared<VolumeOptions>();
  command->add_option("scenario", o->file, "scenario file (TOML) with [machine] and [volume]")->required();
  command->add_option("--samples", o->samples, "instead of the scenario's, e.g. 1e4");
  command->add_option("--seed", o->seed, "instead of the scenario's");
  command->add_option("-o,--out", o->out, "result file (default: results/NAME.volume.h5)");
  add_threads(*command, o->threads);
  command->add_option("--format", o->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  add_force(*command, o->force);
  add_external(*command);
  command->callback([=, &action] { action = [=] { return volume(*o); }; });
}

} // namespace gumshoe::cli
