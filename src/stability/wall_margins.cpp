#include "zwidth/stability/wall_margins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "sampling/bilinear_plant.hpp"
#include "stability/gain_crossings.hpp"
#include "stability/plant_fraction.hpp"
#include "stability/root_isolation.hpp"
#include "stability/spectral_radius.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

// |C_num S|² - |(delta + c) D|², zero where |C P| = 1; C = K + B (c/T) delta / (delta + c). Without a spring the
// damper's delta cancels one of the plant's integrators: both sides are divided by |delta|² then.
class UnitGain {
 public:
  UnitGain(const SampledPlant& plant, double stiffness, double rate, double c)
      : plant_(plant), stiffness_(stiffness), rate_(rate), c_(c) {
    if (stiffness > 0.0) return;
    for (const SampledTerm& term : plant.terms) integrators_ += term.integrators;
  }

  [[nodiscard]] double value(double angle) const { return evaluate(circle_point(angle)); }
  template <typename Scalar>
  [[nodiscard]] BoundedJet<Scalar> model(double begin, double end) const {
    return evaluate(circle_interval<Scalar>(begin, end));
  }

 private:
  template <typename Real>
  Real evaluate(const CirclePoint<Real>& point) const {
    const Real& x = point.chord_squared;
    OnCircle<Real> kept{Real(1.0), Real(0.0)};  // delta^(integrators - 1)
    for (int i = 1; i < integrators_; ++i) kept = multiply(kept, {-0.5 * x, Real(1.0)}, point);
    const bool cancel = integrators_ > 0;
    const PlantFraction<Real> plant = plant_fraction(plant_, point, cancel ? &kept : nullptr);
    const Real filter = (1.0 - c_) * x + c_ * c_;  // |delta + c|²
    // |(K + B c/T) delta + K c|² = (K + r)² x + (K c)² - (K + r) K c x
    const double lead = stiffness_ + rate_;
    const double constant = stiffness_ * c_;
    const Real wall = cancel ? Real(rate_ * rate_) : (lead * (lead - constant)) * x + constant * constant;
    return wall * squared_magnitude(plant.numerator, point) - filter * squared_magnitude(plant.denominator, point);
  }

  const SampledPlant& plant_;
  double stiffness_;
  double rate_;  // B c / T
  double c_;
  int integrators_ = 0;  // of the plant, where one cancels
};

void check(const Wall& wall) {
  for (const double value : {wall.stiffness.value_or(-1.0), wall.damping, wall.velocity_filter_hz}) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw Error(ErrorCode::invalid_argument,
                  "the wall has " + std::to_string(value) + "; stiffness, damping and filter must be finite and >= 0");
    }
  }
}

// Gain margins: the crossings of the locus of one factor on the whole wall, on both sides of 1.
void find_gain_margins(const GainCrossings& crossings, double factor_at_wall, LoopMargins& margins) {
  for (const GainCrossing& crossing : crossings.crossings) {
    const double factor = crossing.gain / factor_at_wall;
    if (factor > 1.0) margins.gain_margin = std::min(margins.gain_margin.value_or(factor), factor);
    if (factor < 1.0) margins.lower_gain_margin = std::max(margins.lower_gain_margin.value_or(factor), factor);
  }
}

// Smallest phase and delay that take any gain crossover to -1. `to_frequency` maps the angle to rad/s.
template <typename ToFrequency>
void find_phase_margins(const SampledPlant& plant, double stiffness, double rate, double c, ToFrequency to_frequency,
                        LoopMargins& margins) {
  if (stiffness == 0.0 && rate == 0.0) return;
  for (const CircleRoot& root : roots_on_circle(UnitGain(plant, stiffness, rate, c), 1)) {
    const double half = std::sin(root.angle / 2.0);
    const std::complex<double> delta(-2.0 * half * half, std::sin(root.angle));
    const std::complex<double> loop =
        (stiffness + rate * delta / (delta + c)) * response(plant, root.angle / plant.period);
    const double margin = std::arg(-loop);  // angle of L plus pi
    const double frequency = to_frequency(root.angle);
    margins.gain_crossovers.push_back({frequency, margin});
    if (!margins.stable) continue;
    const double delay = (margin >= 0.0 ? margin : margin + 2.0 * pi) / frequency;
    margins.phase_margin = std::min(margins.phase_margin.value_or(pi), std::abs(margin));
    margins.delay_margin = std::min(margins.delay_margin.value_or(delay), delay);
  }
}

// Without a spring: the pole at z = 1 of a free device stays, and without a damper those of undamped modes.
bool keeps_pole_on_circle(const SampledPlant& plant, const Wall& wall) {
  return std::any_of(plant.terms.begin(), plant.terms.end(), [&wall](const SampledTerm& term) {
    return term.integrators > 0 || (term.undamped_pairs > 0 && wall.damping == 0.0);
  });
}

template <typename ToFrequency>
LoopMargins margins_of(const SampledPlant& plant, const Wall& wall, ToFrequency to_frequency) {
  const double stiffness = *wall.stiffness;
  const VirtualDamper damper{wall.damping, wall.velocity_filter_hz};
  const double c =
      wall.velocity_filter_hz > 0.0 ? -std::expm1(-2.0 * pi * wall.velocity_filter_hz * plant.period) : 1.0;
  const double rate = wall.damping * c / plant.period;
  LoopMargins margins;
  if (stiffness == 0.0) {  // a free device keeps its pole at z = 1: not asymptotically stable
    const GainCrossings by_damping = gain_crossings(plant, GainLocus(plant, GainLocus::Gain::damping, 0.0, damper));
    margins.stable = !keeps_pole_on_circle(plant, wall) && unstable_poles(by_damping, wall.damping) == 0;
    if (margins.stable && wall.damping > 0.0) find_gain_margins(by_damping, wall.damping, margins);
  } else {
    const GainCrossings by_stiffness = stiffness_crossings(plant, damper);
    const bool on_crossing = std::any_of(by_stiffness.crossings.begin(), by_stiffness.crossings.end(),
                                         [&](const GainCrossing& crossing) { return crossing.gain == stiffness; });
    margins.stable = !on_crossing && unstable_poles(by_stiffness, stiffness) == 0;
    if (margins.stable && wall.damping == 0.0) {
      find_gain_margins(by_stiffness, stiffness, margins);
    } else if (margins.stable) {
      find_gain_margins(gain_crossings(plant, GainLocus(plant, GainLocus::Gain::wall, stiffness, damper)), 1.0,
                        margins);
    }
  }
  find_phase_margins(plant, stiffness, rate, c, to_frequency, margins);
  return margins;
}

// No damping anywhere: L(jw) is real at every frequency, closed-loop poles lie symmetric to the imaginary axis, and no
// gain makes the loop asymptotically stable.
bool is_lossless(const ModalForm& form) {
  return std::all_of(form.terms.begin(), form.terms.end(), [](const ModalTerm& term) {
    const double rounding = 1e-14 * std::sqrt(std::abs(term.denominator[0]));
    return term.degree == 2 && std::abs(term.denominator[1]) <= rounding &&
           std::abs(term.numerator[1]) * std::sqrt(std::abs(term.denominator[0])) <=
               1e-14 * std::abs(term.numerator[0]);
  });
}

}  // namespace

LoopMargins loop_margins(const SampledPlant& plant, const Wall& wall) {
  check(wall);
  return margins_of(plant, wall, [&plant](double angle) { return angle / plant.period; });
}

LoopMargins continuous_margins(const TransferFunction& loop) {
  DeviceParameters parameters;
  parameters.name = "loop";
  parameters.transfer_function = loop;
  parameters.loop.sampling_period = 1.0;  // not used: the bilinear map takes the place of sampling
  const ModalForm form = modal_form(Device(std::move(parameters)));
  if (is_lossless(form)) return {};
  const SampledPlant plant = bilinear_plant(form);
  const double rate = 2.0 / plant.period;
  return margins_of(plant, {1.0, 0.0, 0.0}, [rate](double angle) { return rate * std::tan(angle / 2.0); });
}

WallMargins wall_margins(const Device& device) {
  constexpr std::size_t most_samples_for_eigenvalues = 100;
  const Wall& wall = device.parameters().wall;
  const SampledPlant plant = filtered_plant(device);
  WallMargins margins{loop_margins(plant, wall), *wall.stiffness, wall.damping, 0.0};
  if (plant.delay_samples > most_samples_for_eigenvalues) {
    margins.spectral_radius = spectral_radius_by_winding(plant, wall);
  } else {
    const Sampling sampling{device.loop().sampling_period, device.loop().delay};
    margins.spectral_radius = 1.0 + stability_excess(sample(state_space(device), sampling), wall);
  }
  return margins;
}

}  // namespace zwidth
