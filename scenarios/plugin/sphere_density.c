/* An example of a plugin: the density of a sphere from its mass and diameter, weighed in air. Copy and change it. */

#include "gumshoe_plugin.h"

static const double pi = 3.14159265358979323846;

static const gumshoe_variable quantities[] = {
    /* name, unit, meaning, default, low, high */
    {"diameter", "mm", "at 20 degC", 25.0, 0.001, 1000.0},
    {"mass", "g", "conventional mass, as the balance shows it", 65.0, 0.0, 1e6},
    {"air_density", "kg/m3", "at the balance", 1.2, 0.0, 2.0},
};
enum { diameter, mass, air_density };

static const gumshoe_variable measurands[] = {
    {"density", "kg/m3", "of the sphere's material", 0, 0, 0},
    {"volume", "cm3", "of the sphere", 0, 0, 0},
};
enum { density, volume };

static double at(const gumshoe_column* column, size_t i) { return column->data[i * column->stride]; }

static int evaluate(const gumshoe_batch* b) {
  for (size_t i = 0; i < b->samples; ++i) {
    const double d = at(&b->quantities[diameter], i) / 1000;       /* m */
    const double m = at(&b->quantities[mass], i) / 1000;           /* kg */
    const double air = at(&b->quantities[air_density], i);         /* kg/m3 */
    const double v = pi / 6 * d * d * d;                           /* m3 */
    if (!(v > 0)) b->failed[i] = 1;                                /* this sample has no value; the others go on */
    b->measurands[volume][i] = v * 1e6;                            /* cm3 */
    b->measurands[density][i] = m * (1 - air / 8000.0) / v + air;  /* kg/m3; weights of 8000 kg/m3 */
  }
  return 0;
  /* To stop the whole run instead: snprintf(b->error, b->error_size, "no table for ..."); return 1; */
}

static const gumshoe_model model = {
    .abi = GUMSHOE_PLUGIN_ABI,
    .threads = 1,
    .name = "sphere_density",
    .title = "Density of a sphere from its mass and diameter",
    .source = "an example",
    .quantities = quantities,
    .quantity_count = sizeof quantities / sizeof *quantities,
    .measurands = measurands,
    .measurand_count = sizeof measurands / sizeof *measurands,
    .evaluate = evaluate,
};

const gumshoe_model* gumshoe_plugin(void) { return &model; }
