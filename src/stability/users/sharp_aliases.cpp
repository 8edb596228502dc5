// The aliases of termination discs in which a zero of Re Y lies on the axis of frequencies or nearly so.

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <tuple>

#include "stability/users/termination_discs.hpp"

namespace zwidth::internal {
namespace {

constexpr double beside_range = 0.05;  // of Nyquist: images so near to 0..pi/T count as well

}  // namespace

/// A zero at w0 is seen by the alias in which it lies, and beside 0 and pi/T by its neighbours.
void TerminationDiscs::find_sharp_images() {
  const double nyquist = std::numbers::pi / period_;
  for (std::size_t i = 0; i < zeros_.sharp.size(); ++i) {
    const double w0 = zeros_.sharp[i].frequency;
    const double nearest = std::round(w0 / (2.0 * nyquist));
    for (const double number : {nearest - 1.0, nearest, nearest + 1.0}) {
      for (const double side : {1.0, -1.0}) {
        if (number < 0.0 || (number == 0.0 && side < 0.0)) continue;
        const double image = side * std::fma(-2.0 * number, nyquist, w0);
        if (image > -beside_range * nyquist && image < (1.0 + beside_range) * nyquist) {
          sharp_images_.push_back({number, side, image, i});
        }
      }
    }
  }
  std::sort(sharp_images_.begin(), sharp_images_.end(), [](const SharpImage& a, const SharpImage& b) {
    return std::tie(a.number, a.side, a.image) < std::tie(b.number, b.side, b.image);
  });
}

bool TerminationDiscs::is_sharp(double number, double side) const {
  return std::any_of(sharp_images_.begin(), sharp_images_.end(),
                     [&](const SharpImage& each) { return each.number == number && each.side == side; });
}

double TerminationDiscs::mirrored_measures(double frequency) const {
  double measures = 1.0;
  for (const SharpImage& each : sharp_images_) {
    const SharpZero& zero = zeros_.sharp[each.zero];
    const bool is_in_sum = std::any_of(sharp_images_.begin(), sharp_images_.end(), [&](const SharpImage& other) {
      return other.number == each.number && other.side == -each.side && other.zero == each.zero;
    });
    if (!is_in_sum) measures *= zero.measure((frequency + each.image) / zero.frequency);
  }
  return measures;
}

TerminationDiscs::ScaledDensity TerminationDiscs::scaled_density(const Place& place, double number, double side) const {
  const double at_alias = number * (2.0 * std::numbers::pi / period_) + side * place.frequency();
  const SharpImage* nearest = nullptr;
  const auto distance = [&](const SharpImage& image) {
    return side * ((place.base - image.image) + place.offset) / zeros_.sharp[image.zero].frequency;
  };
  for (const SharpImage& each : sharp_images_) {
    if (each.number != number || each.side != side) continue;
    if (nearest == nullptr || std::abs(distance(each)) < std::abs(distance(*nearest))) nearest = &each;
  }
  ScaledDensity scaled;
  bool is_local = false;
  if (nearest != nullptr) {
    const SharpZero& zero = zeros_.sharp[nearest->zero];
    const SharpZero::Density local = zero.density(distance(*nearest));
    is_local = local.keeps_digits;
    if (is_local) scaled = {local.value, local.conductance, 1.0, 1.0};
  }
  if (!is_local) {
    const Density direct = density(at_alias);
    scaled = {direct.value, direct.conductance, 1.0, 1.0};
  }
  if (nearest == nullptr) return scaled;
  for (const SharpImage& each : sharp_images_) {
    if (each.number != number || each.side != side) continue;
    const SharpZero& zero = zeros_.sharp[each.zero];
    const double e = distance(each);
    const double measure = zero.measure(e);
    const double of_conductance = zero.of_conductance(e);
    scaled.measure *= measure;
    scaled.of_product *= measure / of_conductance;
    if (is_local && &each == nearest) continue;
    scaled.value *= measure;
    scaled.conductance /= of_conductance;
  }
  return scaled;
}

TerminationDiscs::Disc TerminationDiscs::joined(const Disc& own, double measure, std::complex<double> shared,
                                                const OtherAliases& others) const {
  const std::complex<double> centre = shared * others.centre;
  const double radius = std::abs(shared) * others.radius;
  return {own.centre + measure * centre, own.radius + measure * radius,
          own.power + 2.0 * (own.centre * std::conj(centre)).real() - 2.0 * own.radius * radius +
              measure * (std::norm(centre) - radius * radius),
          measure};
}

/// Sums of discs, each over its own measure.
void TerminationDiscs::add_sharp_aliases(const Place& place, Disc& disc) const {
  const double spacing = 2.0 * std::numbers::pi / period_;
  const std::complex<double> shared = shared_factor(place.frequency());
  for (std::size_t i = 0; i < sharp_images_.size(); ++i) {
    const auto& [number, side, image, zero] = sharp_images_[i];
    if (number == 0.0) continue;
    if (i > 0 && sharp_images_[i - 1].number == number && sharp_images_[i - 1].side == side) continue;
    const double at_alias = number * spacing + side * place.frequency();
    const ScaledDensity density = scaled_density(place, number, side);
    const std::complex<double> s(0.0, at_alias);
    const std::complex<double> free = response(through_, at_alias) / s * drive_.response(at_alias);
    const std::complex<double> turn = std::polar(1.0, -number * spacing * delay_);
    const std::complex<double> term = turn * (density.measure * free - density.value);
    const std::complex<double> centre = shared * (side > 0.0 ? term : std::conj(term));
    const double radius = std::abs(shared) * std::abs(density.value);
    const double power =
        std::norm(shared) * (std::norm(free) * density.measure - 2.0 * (free * std::conj(density.value)).real());
    disc = {density.measure * disc.centre + disc.one * centre, density.measure * disc.radius + disc.one * radius,
            density.measure * disc.power + disc.one * power +
                2.0 * ((disc.centre * std::conj(centre)).real() - disc.radius * radius),
            disc.one * density.measure};
  }
}

}  // namespace zwidth::internal
