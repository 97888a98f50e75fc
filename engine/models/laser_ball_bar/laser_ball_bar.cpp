#include "models/laser_ball_bar/laser_ball_bar.h"

namespace gumshoe::models::laser_ball_bar {

std::vector<Intermediate> LaserBallBar::explain(const At<double>& at, const Rows::Indications<double>& read) {
  const auto base = sockets(at.q);
  const auto now = moment(at);
  const auto l = Bars<double>(at.q, base, now).actual({read.length_1, read.length_2, read.length_3});
  const auto ball = trilaterate(base, l);
  const auto in_mm = [](const char* what, double value) { return Intermediate{what, "mm", value / si::mm}; };
  return {in_mm("socket 3, x in the frame of the bars", base.x3),
          in_mm("socket 3, y in the frame of the bars", base.y3),
          in_mm("length of bar 1, corrected", l.to_1),
          in_mm("length of bar 2, corrected", l.to_2),
          in_mm("length of bar 3, corrected", l.to_3),
          in_mm("tool's ball, x in the frame of the bars", ball.x),
          in_mm("tool's ball, y in the frame of the bars", ball.y),
          in_mm("tool's ball, z in the frame of the bars", ball.z),
          in_mm("predicted position of the slide X", now.slides.x),
          in_mm("predicted position of the slide Y", now.slides.y),
          in_mm("predicted position of the slide Z", now.slides.z)};
}

} // namespace gumshoe::models::laser_ball_bar
