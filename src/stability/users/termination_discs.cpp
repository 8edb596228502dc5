#include "stability/users/termination_discs.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/modal_forms.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;
constexpr double clear_of_modes = 2.5;    // aliases beyond this many times the highest mode are summed by the rule
constexpr double clear_of_corners = 4.0;  // beyond this many times the highest corner frequency its tail begins
constexpr std::size_t least_exact_aliases = 12;
constexpr double most_exact_aliases = 20000.0;
constexpr double lightly_damped = 0.5;      // a zero of Re Y: its distance from the axis over its frequency
constexpr double exact_enough = 1e-10;      // relative, of the sums
constexpr double beside_half_plane = 1e-9;  // relative
constexpr double most_of_product = 1e6;
constexpr double long_digits = 0x1p-11;  // rounding of a long double, of that of a double
constexpr double infinity = std::numeric_limits<double>::infinity();

/// |z| of a density, which is far from where squares overflow or vanish.
double size_of(std::complex<double> z) { return std::sqrt(std::norm(z)); }

/// The motion of one body past another. Their terms share denominators, and numerators that agree to many digits (a
/// rigid body moves as one) are subtracted with the digits that double leaves out.
ModalForm difference(ModalForm first, const ModalForm& second) {
  const auto same_poles = [](const ModalTerm& a, const ModalTerm& b) {
    return a.degree == b.degree && std::equal(a.denominator, a.denominator + a.degree, b.denominator);
  };
  for (const ModalTerm& term : second.terms) {
    auto found = std::find_if(first.terms.begin(), first.terms.end(),
                              [&](const ModalTerm& each) { return same_poles(each, term); });
    if (found == first.terms.end()) {
      first.terms.push_back(term);
      found = std::prev(first.terms.end());
      std::fill(std::begin(found->numerator), std::end(found->numerator), 0.0);
      std::fill(std::begin(found->numerator_rest), std::end(found->numerator_rest), 0.0);
    }
    for (std::size_t i = 0; i < term.degree; ++i) {
      found->numerator[i] =
          (found->numerator[i] - term.numerator[i]) + (found->numerator_rest[i] - term.numerator_rest[i]);
      found->numerator_rest[i] = 0.0;
    }
  }
  return first;
}

}  // namespace

TerminationDiscs::TerminationDiscs(const Device& device, const Progress& progress)
    : sensed_(device.loop().sensed),
      actuated_(device.loop().actuated),
      held_(device.loop().held),
      drive_(drive_path_of(device.parameters())),
      period_(device.loop().sampling_period),
      delay_(device.loop().delay),
      plant_(filtered_plant(device_without_user(device))) {
  if (!device.is_mechanical()) throw Error(ErrorCode::needs_bodies, {.code = ProblemCode::no_body_for_user});
  const Device free = device_without_user(device);
  ModalForms forms(free, ActuatorLag::left_out);
  std::vector<ModalForm> motions;  // of the points
  for (std::size_t i = 0; i < points_of(free); ++i) {
    tell(progress, 0.0);
    motions.push_back(forms.along({held_, i}));
  }
  const auto motion_along = [&](const Weights& length) {
    if (!free.has_bodies()) return forms.along({weights_of(free, held_), length});
    return length.size() == 1 ? motions[length[0].of] : difference(motions[length[0].of], motions[length[1].of]);
  };
  solved_ = SolvedMotions(free, weights_of(free, held_));
  for (const std::size_t point : {sensed_, actuated_}) {
    motions_.add(motions[point]);
    solved_.add(weights_of(free, point));
  }
  const std::vector<DeviceLength> lengths = lengths_of(free);
  for (const DeviceLength& each : lengths) {
    if (!(each.damping > 0.0)) continue;
    motions_.add(motion_along(each.weights));
    solved_.add(each.weights);
    dampings_.push_back(each.damping);
  }
  held_motion_ = motions[held_];
  sensed_motion_ = motions[sensed_];
  actuated_motion_ = motions[actuated_];
  through_ = forms.along({actuated_, sensed_});
  matrices_ = device_matrices<long double>(free);
  for (const std::size_t point : {actuated_, sensed_, held_}) ports_.push_back(weights_of(free, point));
  poles_ = held_motion_.terms;
  for (const ModalForm* each : {&through_, &sensed_motion_, &actuated_motion_}) {
    if (each->terms.size() > poles_.size()) poles_ = each->terms;
  }
  undamped_ = dampings_.empty();
  if (undamped_) return;
  zeros_ = DissipationZeros(free, pi / period_);
  undamped_ = zeros_.discs_diverge;
  if (undamped_) return;
  find_sharp_images();
  double highest_mode = 0.0;
  double highest_corner = std::max(drive_.lag > 0.0 ? 1.0 / drive_.lag : 0.0, drive_.tracking);
  for (const Mode& mode : held_form().modes) {
    highest_mode = std::max(highest_mode, mode.frequency);
    highest_corner = std::max(highest_corner, mode.frequency * (1.0 + 2.0 * mode.damping_ratio));
  }
  for (const DeviceLength& each : lengths) {
    const bool is_to_ground = free.has_bodies() && each.weights.size() == 1;
    if (each.damping > 0.0 && !is_to_ground) highest_corner = std::max(highest_corner, each.stiffness / each.damping);
  }
  double highest_zero = 0.0;
  for (const SharpZero& zero : zeros_.sharp) highest_mode = std::max(highest_mode, zero.frequency);
  for (const DissipationZeros::Zero& zero : zeros_.others) {
    if (zero.depth < lightly_damped * zero.position) highest_mode = std::max(highest_mode, zero.position);
    highest_zero = std::max(highest_zero, std::hypot(zero.position, zero.depth));
  }
  highest_corner = std::max(highest_corner, highest_mode);
  set_rules(highest_mode, highest_corner);
  // Beyond the highest zero of Re Y the discs fall otherwise than below.
  if (truncation_ > exact_enough && highest_zero > highest_corner) set_rules(highest_mode, highest_zero);
}

void TerminationDiscs::set_rules(double highest_mode, double highest_corner) {
  const double spacing = 2.0 * pi / period_;
  exact_aliases_ = least_exact_aliases + static_cast<std::size_t>(std::min(
                                             std::ceil(clear_of_modes * highest_mode / spacing), most_exact_aliases));
  // The next one is at least 1.5 times 2 pi/T from every mode.
  near_aliases_ = std::min(
      exact_aliases_, 2 + static_cast<std::size_t>(std::min(std::ceil(highest_mode / spacing), most_exact_aliases)));
  steady_alias_ = clear_of_corners * highest_corner / spacing;
  rule_ = alias_sum_quadrature(exact_aliases_, steady_alias_, spacing * delay_);
  const AliasSumQuadrature finer = alias_sum_quadrature(2 * exact_aliases_, 4.0 * steady_alias_, spacing * delay_);
  truncation_ = 0.0;
  for (const double share : {0.03, 0.5, 1.0}) {
    const Disc coarse = summed(rule_, share * pi / period_);
    const Disc fine = summed(finer, share * pi / period_);
    truncation_ =
        std::max(truncation_,
                 std::max(std::abs(coarse.centre - fine.centre), std::abs(coarse.radius - fine.radius)) / fine.radius);
  }
}

TerminationDiscs::Density TerminationDiscs::density(double frequency) const {
  std::array<std::complex<double>, 8> few;
  std::vector<std::complex<double>> many;
  std::complex<double>* values = few.data();
  if (motions_.size() > few.size()) {
    many.resize(motions_.size());
    values = many.data();
  }
  if (!motions_.responses(frequency, values)) solved_.responses(frequency, values);
  const std::complex<double> sensed = values[0];
  const std::complex<double> actuated = values[1];
  const std::complex<double>* lengths = values + 2;
  double largest = 0.0;
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    largest = std::max({largest, std::abs(values[i].real()), std::abs(values[i].imag())});
  }
  // Scaled by the largest, so that squares neither overflow nor vanish.
  const double unit = 1.0 / largest;
  double dissipation = 0.0;
  for (std::size_t i = 0; i < dampings_.size(); ++i) dissipation += dampings_[i] * std::norm(lengths[i] * unit);
  dissipation *= frequency * frequency;
  const std::complex<double> value = (sensed * unit) * (actuated * unit) / (2.0 * dissipation);
  return {drive_.is_ideal() ? value : value * drive_.response(frequency), dissipation * largest * largest};
}

TerminationDiscs::Disc TerminationDiscs::at(double frequency) const {
  if (undamped_) return {response(plant_, frequency), infinity, -infinity, 1.0};
  if (sharp_images_.empty()) return scaled_at({0.0, frequency});
  Disc disc = scaled_at({0.0, frequency});
  if (!(disc.one > 0.0)) disc = scaled_at({0.0, frequency * (1.0 - beside_half_plane)});
  return {disc.centre / disc.one, disc.radius / disc.one, disc.power / disc.one, 1.0};
}

TerminationDiscs::Disc TerminationDiscs::scaled_at(const Place& place) const {
  const double frequency = place.frequency();
  if (!sharp_images_.empty()) return with_others(place, other_aliases(frequency), frequency).disc;
  return frequency * period_ < clear_angle
             ? near_zero(frequency, scaled_density(place, 0.0, 1.0), other_aliases(frequency))
             : summed(rule_, frequency);
}

/// F (1 - e^{-jwT}) e^{-jwt_d}/T. Its phase keeps its digits towards w = 0, where it is all that counts.
std::complex<double> TerminationDiscs::shared_factor(double frequency) const {
  const double sine = std::sin(0.5 * frequency * period_);
  const double cosine = std::cos(0.5 * frequency * period_);
  return filter_response(plant_, frequency * period_) * (2.0 * sine / period_) * std::complex<double>(sine, cosine) *
         std::polar(1.0, -frequency * delay_);
}

TerminationDiscs::OtherAliases TerminationDiscs::other_aliases(double frequency) const {
  return sum_of_aliases(frequency, 1, rule_.nodes.size());
}

TerminationDiscs::OtherAliases TerminationDiscs::near_aliases(double frequency) const {
  return sum_of_aliases(frequency, 1, near_aliases_);
}

TerminationDiscs::OtherAliases TerminationDiscs::far_aliases(double frequency) const {
  return sum_of_aliases(frequency, near_aliases_, rule_.nodes.size());
}

/// Of the rule's nodes from `first` on; the node 0 is w itself.
TerminationDiscs::OtherAliases TerminationDiscs::sum_of_aliases(double frequency, std::size_t first,
                                                                std::size_t end) const {
  const double spacing = 2.0 * pi / period_;
  OtherAliases others;
  for (std::size_t i = first; i < end; ++i) {
    const AliasSumQuadrature::Node& node = rule_.nodes[i];
    for (const double side : {1.0, -1.0}) {
      if (is_sharp(node.number, side)) continue;
      const double at_alias = node.number * spacing + side * frequency;
      const std::complex<double> disc = disc_density(at_alias);
      const std::complex<double> s(0.0, at_alias);
      const std::complex<double> centre =
          node.turning * (response(through_, at_alias) / s * drive_.response(at_alias) - disc);
      others.centre += side > 0.0 ? centre : std::conj(centre);
      others.radius += node.still * size_of(disc);
    }
  }
  return others;
}

/// The response X = G_hh with the sensed position kept at 0 by a force at the actuated body; 0 where either is the held
/// body. In long double, for the digits of a small imaginary part.
///
///     [-w² M + jw C + K   -w_a] [x]   [w_h]
///     [      w_s^T          0 ] [f] = [ 0 ],    X = w_h^T x
std::complex<double> TerminationDiscs::kept_motion(double frequency) const {
  using Real = long double;
  using Number = std::complex<Real>;
  if (held_ == sensed_ || held_ == actuated_) return 0.0;
  const auto n = static_cast<Eigen::Index>(matrices_.mass.size());
  if (n == 2 && matrices_.coupling.empty()) {  // the other body stands still
    const std::size_t entry = held_ * 2 + held_;
    const Number kept =
        Real(1.0) / Number(matrices_.stiffness[entry] - Real(frequency) * Real(frequency) * matrices_.mass[held_],
                           Real(frequency) * matrices_.damping[entry]);
    return {static_cast<double>(kept.real()), static_cast<double>(kept.imag())};
  }
  Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic> bordered(n + 1, n + 1);
  bordered.setZero();
  Real size = 0.0L;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto entry = static_cast<std::size_t>(i * n + j);
      bordered(i, j) = {matrices_.stiffness[entry], Real(frequency) * matrices_.damping[entry]};
    }
    bordered(i, i) -= Real(frequency) * Real(frequency) * matrices_.mass[static_cast<std::size_t>(i)];
    if (!matrices_.coupling.empty()) {
      for (Eigen::Index j = 0; j < n; ++j) {
        bordered(i, j) -= Real(frequency) * Real(frequency) * matrices_.coupling[static_cast<std::size_t>(i * n + j)];
      }
    }
    for (Eigen::Index j = 0; j < n; ++j) {
      size = std::max({size, std::abs(bordered(i, j).real()), std::abs(bordered(i, j).imag())});
    }
  }
  // The border as large as the rest.
  for (const auto& [i, weight] : ports_[0]) bordered(static_cast<Eigen::Index>(i), n) = -size * Real(weight);
  for (const auto& [i, weight] : ports_[1]) bordered(n, static_cast<Eigen::Index>(i)) = size * Real(weight);
  Eigen::Matrix<Number, Eigen::Dynamic, 1> force = Eigen::Matrix<Number, Eigen::Dynamic, 1>::Zero(n + 1);
  for (const auto& [i, weight] : ports_[2]) force(static_cast<Eigen::Index>(i)) = Real(weight);
  const Eigen::Matrix<Number, Eigen::Dynamic, 1> motion = bordered.partialPivLu().solve(force);
  Number kept = 0.0L;
  for (const auto& [i, weight] : ports_[2]) kept += motion(static_cast<Eigen::Index>(i)) * Real(weight);
  return {static_cast<double>(kept.real()), static_cast<double>(kept.imag())};
}

/// With c_0 and r_0 of w itself, which grow as 1/w, and dc and dr of all other aliases, which fall as w:
///
///     |c|² - r² = (|c_0|² - r_0²) + 2 Re[c_0 conj dc] - 2 r_0 dr + |dc|² - dr²
///     c_0 = G_sa - D = jw G_sa (X - conj G_hh)/(2R),   |c_0|² - r_0² = |G_sa|²/R Re[jw X],   R = Re Y
///
/// In this form neither difference loses digits; real and imaginary part of each factor keep their own.
TerminationDiscs::Disc TerminationDiscs::near_zero(double frequency, const ScaledDensity& own,
                                                   const OtherAliases& others) const {
  const std::complex<double> factor = shared_factor(frequency);
  const std::complex<double> through = response(through_, frequency) * drive_.response(frequency);
  const std::complex<double> kept = kept_motion(frequency);
  const std::complex<double> held = std::conj(response(held_motion_, frequency));
  // Where the user hardly reaches the wall's loop, and at a frequency where it cannot, X and conj G_hh are nearly the
  // same, and G_sa - D loses less.
  const std::complex<double> free = through / std::complex<double>(0.0, frequency);
  const std::complex<double> difference = own.measure * free - own.value;
  const double lost = (own.measure * std::abs(free) + std::abs(own.value)) / std::abs(difference);
  const bool has_product = own.of_product < most_of_product;
  const bool is_product = has_product && std::abs(kept) + std::abs(held) < lost * std::abs(kept - held);
  const double by_conductance = own.of_product / own.conductance;
  const std::complex<double> own_centre =
      factor * (is_product ? through * (kept - held) * (0.5 * by_conductance) : difference);
  const double own_radius = std::abs(factor) * std::abs(own.value);
  // Over the measure, which |c_0|² - r_0² has once.
  const bool is_plain = own.measure == 1.0;
  const double both = std::norm(free) * own.measure + 2.0 * std::abs(free) * std::abs(own.value);
  double own_power =
      is_plain ? (std::abs(own_centre) - own_radius) * (std::abs(own_centre) + own_radius)
               : std::norm(factor) * (std::norm(free) * own.measure - 2.0 * (free * std::conj(own.value)).real());
  const double size_of_power = is_plain ? std::norm(own_centre) + own_radius * own_radius : std::norm(factor) * both;
  const double lost_in_power = size_of_power / std::abs(own_power);
  if (is_product || (has_product && long_digits * std::abs(kept) < lost_in_power * lost * std::abs(kept.imag()))) {
    own_power = std::norm(factor / frequency) * std::norm(through) * (-frequency * kept.imag()) * by_conductance;
  }
  return joined({own_centre, own_radius, own_power, own.measure}, own.measure, factor, others);
}

TerminationDiscs::Disc TerminationDiscs::clear_of_zero(double frequency, const ScaledDensity& own,
                                                       const OtherAliases& others) const {
  const std::complex<double> shared = shared_factor(frequency);
  const std::complex<double> s(0.0, frequency);
  const std::complex<double> free = response(through_, frequency) / s * drive_.response(frequency);
  if (sharp_images_.empty()) {
    const std::complex<double> centre = shared * (free - own.value + others.centre);
    const double radius = std::abs(shared) * (std::abs(own.value) + others.radius);
    return {centre, radius, (std::abs(centre) - radius) * (std::abs(centre) + radius), 1.0};
  }
  const double power = std::norm(shared) * (std::norm(free) * own.measure - 2.0 * (free * std::conj(own.value)).real());
  return joined({shared * (own.measure * free - own.value), std::abs(shared) * std::abs(own.value), power, own.measure},
                own.measure, shared, others);
}

TerminationDiscs::SplitDisc TerminationDiscs::with_others(const Place& place, const OtherAliases& others,
                                                          double unit) const {
  const double frequency = place.frequency();
  const ScaledDensity own = scaled_density(place, 0.0, 1.0);
  SplitDisc split;
  split.shared = std::abs(shared_factor(frequency));
  split.disc =
      frequency * period_ < clear_angle ? near_zero(frequency, own, others) : clear_of_zero(frequency, own, others);
  if (!sharp_images_.empty()) add_sharp_aliases(place, split.disc);
  // A term s² + d1 s + d0; an integrator's s is in the conductance's poles no more.
  split.factor = own.conductance;
  for (const ModalTerm& term : poles_) {
    if (term.mode < 0) continue;
    const std::complex<double> s(0.0, frequency);
    std::complex<double> value = 1.0;
    double size = 1.0;
    for (std::size_t i = term.degree; i-- > static_cast<std::size_t>(term.integrators);) {
      value = value * s + term.denominator[i];
      size = size * unit + std::abs(term.denominator[i]);
    }
    split.factor *= std::norm(value / size);
  }
  return split;
}

TerminationDiscs::Disc TerminationDiscs::summed(const AliasSumQuadrature& rule, double frequency) const {
  const double spacing = 2.0 * pi / period_;
  const std::complex<double> late = std::polar(1.0, -frequency * delay_);
  std::complex<double> shift = 0.0;
  double radius = 0.0;
  for (const AliasSumQuadrature::Node& node : rule.nodes) {
    const double offset = node.number * spacing;
    if (!is_sharp(node.number, 1.0)) {
      const std::complex<double> above = disc_density(offset + frequency);
      shift += node.turning * above * late;
      radius += node.still * size_of(above);
    }
    if (node.number == 0.0 || is_sharp(node.number, -1.0)) continue;
    const std::complex<double> below = disc_density(offset - frequency);
    shift += std::conj(node.turning * below) * late;
    radius += node.still * size_of(below);
  }
  // (1 - e^{-jwT}) / T
  const std::complex<double> hold =
      2.0 * std::sin(0.5 * frequency * period_) / period_ * std::polar(1.0, 0.5 * (pi - frequency * period_));
  const std::complex<double> filters = filter_response(plant_, frequency * period_);
  const std::complex<double> centre = response(plant_, frequency) - filters * hold * shift;
  const double size = std::abs(filters * hold) * radius;
  return {centre, size, (std::abs(centre) - size) * (std::abs(centre) + size), 1.0};
}

AliasSumQuadrature TerminationDiscs::rule_derivative() const {
  return alias_sum_quadrature_derivative(exact_aliases_, steady_alias_, 2.0 * pi / period_ * delay_);
}

TerminationDiscs::Alias TerminationDiscs::alias(double frequency, int k, double direction) const {
  const double at_alias = frequency + k * (2.0 * pi / period_);
  const double positive = std::abs(at_alias);
  const std::complex<double> density = disc_density(positive);
  const std::complex<double> filters = filter_response(plant_, frequency * period_);
  const double hold = 2.0 * std::sin(0.5 * frequency * period_) / period_;
  const std::complex<double> through =
      response(sensed_motion_, positive) * response(actuated_motion_, positive) * drive_.response(positive);
  // The term is -f q_s q_a/(Y + 1/Z), f = F (1 - e^{-jwT})/T e^{-jw_k t_d}; with Z = jX, towards the direction,
  //     q_s q_a/(Y + 1/Z) = g (1 - e^{j turn}),   1/(1 - e^{j turn}) = (1 + j cot(turn/2))/2,   q_s q_a/g = 2 Re Y.
  // At a negative frequency all of it is conjugate.
  const double factor_angle = std::arg(filters) + 0.5 * (pi - frequency * period_) - at_alias * delay_;
  const double turn = (at_alias < 0.0 ? factor_angle - direction : direction - factor_angle) - std::arg(density);
  const double conductance = std::abs(through) / (2.0 * std::abs(density));
  const double susceptance = positive * response(held_motion_, positive).real();
  return {positive, std::abs(filters) * hold * std::abs(density),
          1.0 / (susceptance - conductance / std::tan(0.5 * turn))};
}

}  // namespace zwidth::internal
