/// The kernels of every model give the same bits on every instruction set.
#include <catch2/catch.hpp>

#include "contracts/examples.h"
#include "kernel_variants.h"

#define GUMSHOE_MODEL(folder, type) GUMSHOE_VARIANTS(gumshoe::models::Kernels, folder)
#include "models/catalogue.def"
#undef GUMSHOE_MODEL
GUMSHOE_VARIANTS(gumshoe::models::Kernels, expression)
GUMSHOE_VARIANTS(gumshoe::models::Kernels, serial_chain)
GUMSHOE_VARIANTS(gumshoe::models::Kernels, sphere_probing)

using namespace gumshoe;
using namespace gumshoe::contracts;

namespace {

using Variants = std::vector<tests::Variant<models::Kernels>>;

/// Empty for a model without kernels of its own (a plugin, a command).
Variants variants(std::string_view model) {
#define GUMSHOE_MODEL(folder, type)                                                                                    \
  if (model == #folder) return folder##_variants();
#include "models/catalogue.def"
  GUMSHOE_MODEL(expression, )
  GUMSHOE_MODEL(serial_chain, )
  GUMSHOE_MODEL(sphere_probing, )
#undef GUMSHOE_MODEL
  return {};
}

/// What the copied model's `kernels` returns.
const models::Kernels* chosen = nullptr;

} // namespace

TEST_CASE("the kernels of every model give the same bits on every instruction set", "[contracts][models]") {
  std::size_t compared = 0;
  for (const Example& e : examples()) {
    const Variants all = variants(e.name);
    if (all.empty()) continue;
    const Subject best(e.model(), effects_on(e.model()));
    Draw draw(1402);
    std::vector<Point> points;
    for (std::size_t n = 0; n < 64 && points.size() < 21; ++n)
      if (const auto there = best.read(best.random(best.at_null(e.readings[n % e.readings.size()]), draw, true)))
        points.push_back(*there);
    REQUIRE(points.size() > 8);
    models::Model model = e.model();
    model.kernels = [] { return chosen; };
    const Subject variant(model, effects_on(model));
    const auto evaluated = best.evaluate(points);
    const auto simulated = best.simulates() ? best.simulate(points) : std::vector<Outcome>{};
    for (const auto& [set, kernels] : all) {
      INFO(e.name << " on " << name(set));
      chosen = kernels;
      CHECK(variant.evaluate(points) == evaluated);
      if (best.simulates()) CHECK(variant.simulate(points) == simulated);
      ++compared;
    }
  }
  CHECK(compared >= 11); // one set at least of every model
}
