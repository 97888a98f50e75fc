#include "models/tool_length/trigger/insert_chord.h"

namespace gumshoe::models::tool_length {

DiscShare::DiscShare(double beam_radius, double fraction) : radius(beam_radius) {
  // J(sin a) = a + sin a cos a = half a disc less the share
  const double wanted = 0.5 * pi * (1 - 2 * fraction);
  double a = 0.5 * wanted, sine = 0, cosine = 1;
  if (wanted != 0) {
    a = a * (1 + a * a * (1.0 / 3 + a * a * (4.0 / 15)));
    for (int i = 0; i < 60; ++i) {
      const auto sc = sine_cosine_lane(Lanes(a));
      sine = sc.sine.get(0), cosine = sc.cosine.get(0);
      double step = -(a + sine * cosine - wanted) / (2 * cosine * cosine);
      step = std::fmin(std::fmax(step, -0.2), 0.2); // near share 0 and 1 the slope vanishes
      if (std::fabs(step) < 1e-9) {                 // its square is below rounding
        sine += step * cosine, cosine -= step * sine;
        break;
      }
      a += step;
    }
  }
  depth = sine;
  half_chord = cosine;
  // 2 sqrt(1 - (depth + x)^2) in powers of x, integrated
  std::array<double, 9> root{};
  root[0] = cosine;
  for (std::size_t i = 1; i < root.size(); ++i) {
    double sum = i == 1 ? -2 * sine : i == 2 ? -1.0 : 0.0;
    for (std::size_t j = 1; j < i; ++j) sum -= root[j] * root[i - j];
    root[i] = sum / (2 * cosine);
  }
  for (std::size_t i = 0; i < root.size(); ++i) series[i] = 2 * root[i] / static_cast<double>(i + 1);
}

RakeBody::RakeBody(const InsertBody<double>& b)
    : centre(b.rake), normal{b.a.z * b.b.y - b.a.y * b.b.z, b.a.x * b.b.z - b.a.z * b.b.x,
                             b.a.y * b.b.x - b.a.x * b.b.y},
      radius(b.rake_radius), yaw(b.yaw), sin_pitch(b.sin_pitch), cos_pitch(b.cos_pitch), side(b.side), rise(b.rise) {}

} // namespace gumshoe::models::tool_length
