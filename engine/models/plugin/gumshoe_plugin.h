/* Gumshoe plugin interface, version 1. Plain C: copy this file next to your model and include it.
 *
 * A plugin is a shared library that exports one function, gumshoe_plugin(), which returns the description of one
 * model. A scenario names it:
 *
 *     [model]
 *     name = "plugin"
 *     library = "libmine.so"      (relative to the scenario's folder)
 *
 * All numbers pass in the units that the description states: a quantity declared in "mm" arrives in millimetres.
 * Everything pointed to by the description stays valid as long as the library is loaded; it is never unloaded.
 */
#ifndef GUMSHOE_PLUGIN_H
#define GUMSHOE_PLUGIN_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define GUMSHOE_PLUGIN_ABI 1

/* A quantity, condition, indication or measurand. */
typedef struct gumshoe_variable {
  const char* name;     /* letters, digits and _, not beginning with a digit: "rod_radius" */
  const char* unit;     /* "mm", "deg", "mm/min", "1" ...; null means "1" */
  const char* meaning;  /* may be null */
  double default_value; /* quantities and conditions: where the scenario says nothing */
  double low, high;     /* quantities: values that are possible, ends included; low == high (both 0): no limits */
} gumshoe_variable;

/* Values of one variable: sample i is data[i * stride]. Stride 0: one value for all samples. */
typedef struct gumshoe_column {
  const double* data;
  size_t stride;
} gumshoe_column;

/* A batch of points. Arrays of columns are in the order of the description. */
typedef struct gumshoe_batch {
  size_t samples;
  const gumshoe_column* quantities;
  const gumshoe_column* conditions;
  const gumshoe_column* indications; /* evaluate only; null in simulate */
  double* const* measurands;         /* evaluate: the results. simulate: the true values. [measurand][sample] */
  double* const* simulated;          /* simulate only: [indication][sample]; null in evaluate */
  unsigned char* failed;             /* [sample], 0 on entry: set to 1 where a sample has no value (kept and counted) */
  char* error;                       /* why the call failed, if it returns other than 0: zero-terminated text */
  size_t error_size;                 /* room in `error`, in bytes */
} gumshoe_batch;

typedef struct gumshoe_model {
  int abi;             /* GUMSHOE_PLUGIN_ABI; must be the first member in every version */
  int threads;         /* 1: the functions may be called from several threads at once; 0: calls come one at a time */
  const char* name;    /* as a variable's name */
  const char* title;   /* one line; may be null */
  const char* summary; /* may be null */
  const char* source;  /* paper, standard, report; may be null */
  const gumshoe_variable* quantities;
  size_t quantity_count;
  const gumshoe_variable* conditions; /* commanded, exact */
  size_t condition_count;
  const gumshoe_variable* indications; /* what is read; needed by the scenario if there are any */
  size_t indication_count;
  const gumshoe_variable* measurands; /* at least one */
  size_t measurand_count;

  /* The measurement model: measurands from quantities, conditions and indications, point by point: a sample's result
   * must not depend on the others in its batch. Returns 0. Any other value stops the run with the text in `error`;
   * for a sample that merely has no value set failed[i] instead. */
  int (*evaluate)(const gumshoe_batch* batch);

  /* The machine as it truly is, for virtual experiments: indications, and the true values of the measurands, from
   * quantities and conditions. Null if the model only evaluates. */
  int (*simulate)(const gumshoe_batch* batch);
} gumshoe_model;

#if defined(_WIN32)
#define GUMSHOE_EXPORT __declspec(dllexport)
#else
#define GUMSHOE_EXPORT __attribute__((visibility("default")))
#endif

/* The one function a plugin exports. */
GUMSHOE_EXPORT const gumshoe_model* gumshoe_plugin(void);

#ifdef __cplusplus
}
#endif
#endif
