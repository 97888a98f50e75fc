#pragma once
#include "chain/scanning.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct FormRow {
  static constexpr QuantityCard um(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .meaning = meaning, .role = Role::pair,
            .typical = {1e-6, 5e-6}};
  }
};

/// Form that turns with the part.
struct PartForm {
  static constexpr QuantityCard quantities[] = {
      FormRow::um("cosine_2", "of cosine 2 phi"), FormRow::um("sine_2", "of sine 2 phi"),
      FormRow::um("cosine_3", "of cosine 3 phi"), FormRow::um("sine_3", "of sine 3 phi"),
      FormRow::um("cosine_4", "of cosine 4 phi"), FormRow::um("sine_4", "of sine 4 phi")};
  static constexpr EffectCard card{
      .name = "part_form",
      .title = "Form of the part",
      .stage = Stage::surface,
      .meaning = "The surface deviates from its nominal form by the second to fourth harmonic of the part's own azimuth, phi = "
                 "theta - part_angle, alike at all radii.",
      .adds = "form += cosine_2 cos 2 phi + sine_2 sin 2 phi + ...",
      .confused_with = "clamping_lobes and c_axial_motion, exactly, unless the part is turned on its seat",
      .source = "engineering knowledge; Ibaraki et al. 2018, Table 2, for the size",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::Scanning<T>& s = *event.scanning;
    const T phi = s.azimuth - s.part_angle;
    for (int k = 2; k <= 4; ++k) {
      const T angle = k * 1.0 * phi;
      s.form = s.form + (q[2 * k - 4] * num::cos(angle) + q[2 * k - 3] * num::sin(angle));
    }
  }
};

/// Form that stays with the jaws.
struct ClampingLobes {
  static constexpr QuantityCard quantities[] = {
      FormRow::um("cosine", "of cosine jaws theta"), FormRow::um("sine", "of sine jaws theta"),
      {.name = "jaws", .unit = "1", .si_unit = "1", .default_value = 3, .limits = {1, 12}, .meaning = "lobes in one turn",
       .role = Role::shape, .typical = {2, 6}}};
  static constexpr EffectCard card{
      .name = "clamping_lobes",
      .title = "Lobes from clamping",
      .stage = Stage::surface,
      .meaning = "The jaws of the chuck, which stay on the table, press lobes into the part: cosine cos(jaws theta) + sine "
                 "sin(jaws theta).",
      .adds = "form += cosine cos(jaws theta) + sine sin(jaws theta)",
      .confused_with = "part_form, exactly, unless the part is turned on its seat; c_axial_motion if there are two lobes",
      .source = "engineering knowledge; Ibaraki et al. 2018, section 4.2, suspects 6 to 8 um",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::Scanning<T>& s = *event.scanning;
    const T angle = q[2] * s.azimuth;
    s.form = s.form + (q[0] * num::cos(angle) + q[1] * num::sin(angle));
  }
};

} // namespace gumshoe::effects
