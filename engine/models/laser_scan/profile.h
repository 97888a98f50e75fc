#pragma once
/// Profiles judged as a whole: the joint evaluation of a scan.
#include <array>
#include <string>
#include <vector>

#include "models/block.h"
#include "models/laser_scan/spot.h"

namespace gumshoe::models::laser_scan {

/// The points of one profile, and the rows that fit a plane to their form deviations by least squares: fit . deviations =
/// (mean at the centre, slope along x, slope along y). They follow from conditions alone.
struct Points {
  std::vector<std::size_t> readings;
  std::vector<std::array<double, 2>> place; ///< x, y about the part's centre, m
  std::vector<std::array<double, 3>> fit;   ///< empty where the points do not determine a plane
};
/// By number of the profile, from 0, up to the largest that has points.
std::vector<Points> points_of(const std::vector<Rows::Conditions<double>>& conditions);

inline double first_of(double x) { return x; }
inline double first_of(const Lanes& x) { return x.get(0); }
/// Conditions of all readings. In a joint evaluation they are the same in all samples.
template <class T> std::vector<Rows::Conditions<double>> conditions_of(const Together<Rows, T>& all) {
  std::vector<Rows::Conditions<double>> out;
  for (const auto& at : all.at) out.push_back(converted<double>(at.c, [](const T& x) { return first_of(x); }));
  return out;
}

/// Rows of profile_cards, for each profile.
template <class T> struct ProfileRows { T peak_to_valley, mean, roundness, tilt_a, tilt_b; };

struct Profile {
  template <class T> using Measurands = std::array<ProfileRows<T>, most_profiles>;
  template <class T> struct Memory {
    explicit Memory(const Together<Rows, double>& all) : profiles(points_of(conditions_of(all))), deviations(all.size()) {}
    std::vector<Points> profiles;
    std::vector<T> deviations;
    KnownSetUp<T> known;
  };

  template <class T> struct Range {
    T low, high;
    bool any = false;
    void add(const T& x) {
      low = any ? num::select(x < low, x, low) : x;
      high = any ? num::select(x > high, x, high) : x;
      any = true;
    }
    T width() const { return high - low; }
  };

  template <class T> static ProfileRows<T> judged(const Points& points, const std::vector<T>& deviations) {
    Range<T> all, flat;
    T sum(0.0), fit[3] = {T(0.0), T(0.0), T(0.0)};
    for (std::size_t i = 0; i < points.readings.size(); ++i) {
      const T& d = deviations[points.readings[i]];
      all.add(d);
      sum = sum + d;
      for (std::size_t j = 0; j < 3 && !points.fit.empty(); ++j) fit[j] = fit[j] + T(points.fit[i][j]) * d;
    }
    for (std::size_t i = 0; i < points.readings.size(); ++i) {
      const auto& [x, y] = points.place[i];
      flat.add(deviations[points.readings[i]] - fit[0] - T(x) * fit[1] - T(y) * fit[2]);
    }
    return {all.width(), sum * T(1.0 / static_cast<double>(points.readings.size())), flat.width(), fit[2], -fit[1]};
  }
  template <class T>
  static Measurands<T> judged(const std::vector<Points>& profiles, const std::vector<T>& deviations) {
    Measurands<T> out{};
    for (std::size_t k = 0; k < profiles.size(); ++k)
      if (!profiles[k].readings.empty()) out[k] = judged(profiles[k], deviations);
    return out;
  }

  template <class T> static Measurands<T> evaluate(const Together<Rows, T>& all, Memory<T>& memory, Outcome<T>& outcome) {
    for (std::size_t r = 0; r < all.size(); ++r)
      memory.deviations[r] = form_deviation(all.at[r], spot(all.at[r], memory.known.of(all.at[r]), outcome), all.read[r].displacement);
    return judged(memory.profiles, memory.deviations);
  }
  /// The same figures, from the true form deviations.
  template <class T>
  static Measurands<T> truth(const Together<Rows, T>& all, const std::vector<Simulated<Rows, T>>& shown, Outcome<T>&) {
    std::vector<T> deviations;
    for (const auto& s : shown) deviations.push_back(s.measurands.form_deviation);
    return judged(points_of(conditions_of(all)), deviations);
  }

  /// Message if a profile has no points, or too few for a plane; empty otherwise.
  static std::string check(const Together<Rows, double>& all);
  static std::size_t in_use(const Quantities<double>& q) {
    return static_cast<std::size_t>(q.profiles) * sizeof(ProfileRows<double>) / sizeof(double);
  }
};

} // namespace gumshoe::models::laser_scan
