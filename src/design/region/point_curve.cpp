#include "design/region/point_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <utility>

#include "eigenvalues.hpp"
#include "infinity.hpp"

namespace zwidth::internal {
namespace {

constexpr double per_decade = 24.0;  // angles of the first grid
constexpr int even_angles_of_curve = 200;
constexpr double of_chord = 0.05;  // a point between two strays less
constexpr double of_wall = 1e-7;   // or of K + B/T
constexpr int most_angle_halvings = 24;
constexpr std::size_t most_curve_samples = 40000;
constexpr double far_beyond = 1e4;  // of the unit
constexpr double least_drift = 1e-9;
constexpr double at_rest = 1e-8;           // rad
constexpr double real_to_rounding = 1e-7;  // relative

}  // namespace

PointCurve::PointCurve(const SampledTip& plant, double velocity_filter_hz)
    : response_(plant),
      velocity_({1.0, velocity_filter_hz}, plant.period),
      period_(plant.period),
      unit_(stiffness_loop(plant, {}).unit) {}

bool PointCurve::is_seen() const { return response_.at(1.0).norm() > 0.0; }

std::vector<WallPoint> PointCurve::walls(double angle) const {
  const std::complex<double> velocity = velocity_.at(backward_difference(angle));
  std::vector<WallPoint> walls;
  for (const std::complex<double>& eigenvalue : complex_eigenvalues(response_.at(angle))) {
    const std::complex<double> gain = -1.0 / eigenvalue;
    const double damping = gain.imag() / velocity.imag();
    const double stiffness = gain.real() - damping * velocity.real();
    const bool is_finite = std::isfinite(damping) && std::isfinite(stiffness);
    walls.push_back(is_finite ? WallPoint{stiffness, damping} : WallPoint{infinity, infinity});
  }
  return walls;
}

WallPoint PointCurve::wall_near(double angle, const WallPoint& guess, const WallPoint& one) const {
  const std::vector<WallPoint> all = walls(angle);
  return *std::ranges::min_element(all, {}, [&](const WallPoint& each) {
    return std::hypot((each.stiffness - guess.stiffness) / one.stiffness, (each.damping - guess.damping) / one.damping);
  });
}

double PointCurve::apart(const WallPoint& a, const WallPoint& b) const {
  return std::hypot(a.stiffness - b.stiffness, (a.damping - b.damping) / period_);
}

// In the order of those before, each the nearest that is left.
void PointCurve::arrange(std::vector<WallPoint>& walls, const std::vector<WallPoint>& before) const {
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto from = walls.begin() + static_cast<std::ptrdiff_t>(i);
    std::iter_swap(from, std::min_element(from, walls.end(), [&](const WallPoint& a, const WallPoint& b) {
                     return apart(a, before[i]) < apart(b, before[i]);
                   }));
  }
}

// Of all curves that may bound walls there.
bool PointCurve::is_nearly_straight(const Sample& first, const Sample& middle, const Sample& last) const {
  for (std::size_t i = 0; i < middle.walls.size(); ++i) {
    const WallPoint& a = first.walls[i];
    const WallPoint& b = middle.walls[i];
    const WallPoint& c = last.walls[i];
    const auto all = [&](auto&& is_out) { return is_out(a) && is_out(b) && is_out(c); };
    const bool is_out =
        all([](const WallPoint& each) { return each.stiffness < 0.0; }) ||
        all([](const WallPoint& each) { return each.damping < 0.0; }) ||
        all([&](const WallPoint& each) { return !(std::abs(each.stiffness) < far_beyond * unit_); }) ||
        all([&](const WallPoint& each) { return !(std::abs(each.damping) < far_beyond * unit_ * period_); });
    if (is_out) continue;
    const WallPoint mean{0.5 * (a.stiffness + c.stiffness), 0.5 * (a.damping + c.damping)};
    if (!(apart(b, mean) <= of_chord * apart(a, c) + of_wall * apart(b, {}))) return false;
  }
  return true;
}

// Adds samples from the last one on.
void PointCurve::refine(std::vector<Sample>& samples, Sample last, int depth) const {
  const Sample& first = samples.back();
  Sample middle = sample(0.5 * (first.angle + last.angle));
  arrange(middle.walls, first.walls);
  arrange(last.walls, middle.walls);
  if (depth == most_angle_halvings || samples.size() > most_curve_samples || is_nearly_straight(first, middle, last)) {
    samples.push_back(std::move(middle));
    arrange(last.walls, samples.back().walls);
    samples.push_back(std::move(last));
    return;
  }
  refine(samples, std::move(middle), depth + 1);
  refine(samples, std::move(last), depth + 1);
}

std::vector<PointCurve::Curve> PointCurve::curves(const std::vector<double>& angles) const {
  const double most = std::numbers::pi - beside_nyquist;
  std::vector<double> places = angles_around(response_.poles());
  places.insert(places.end(), angles.begin(), angles.end());
  const double factor = std::pow(10.0, 1.0 / per_decade);
  for (double angle = least_angle; angle < 1.0; angle *= factor) places.push_back(angle);
  for (int i = 1; i < even_angles_of_curve; ++i) places.push_back(std::numbers::pi * i / even_angles_of_curve);
  for (double left = beside_nyquist; left < 0.1; left *= 2.0) places.push_back(std::numbers::pi - left);
  std::erase_if(places, [most](double each) { return !(each >= least_angle && each <= most); });
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<Sample> samples{sample(places.front())};
  for (std::size_t i = 1; i < places.size(); ++i) refine(samples, sample(places[i]), 0);
  std::vector<Curve> curves(samples.front().walls.size());
  for (const Sample& each : samples) {
    for (std::size_t i = 0; i < curves.size(); ++i) curves[i].push_back({each.angle, each.walls[i]});
  }
  return curves;
}

// -1/l of the eigenvalues that are real there, where > 0.
std::vector<double> PointCurve::real_gains(double angle) const {
  std::vector<double> gains;
  for (const std::complex<double>& eigenvalue : complex_eigenvalues(response_.at(angle))) {
    const std::complex<double> gain = -1.0 / eigenvalue;
    if (std::isfinite(gain.real()) && gain.real() > 0.0 && std::abs(gain.imag()) <= real_to_rounding * gain.real()) {
      gains.push_back(gain.real());
    }
  }
  return gains;
}

std::vector<double> PointCurve::nyquist_stiffnesses() const { return real_gains(std::numbers::pi); }

// At z = 1 itself the response of what nothing holds is infinite.
std::vector<double> PointCurve::drift_stiffnesses() const {
  std::vector<double> gains = real_gains(at_rest);
  std::erase_if(gains, [this](double each) { return !(each > least_drift * unit_); });
  return gains;
}

double PointCurve::velocity_at_nyquist() const { return velocity_.at(2.0).real(); }

}  // namespace zwidth::internal
