#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "identification/campaign/bench.hpp"
#include "identification/campaign/simulator.hpp"

/// The kinds of record of the identification campaign.
namespace zwidth::test::campaign {

/// What a record holds of its device's limit.
enum class Evidence {
  of_limit,  ///< what it hangs on
  open,      ///< not all of that, and a doubt is right
  none,      ///< nothing of what is wrong: no record shows it, and such records count apart
};

/// What a kind of record adds to a clean one.
struct Kind {
  const char* name;    ///< says what it adds
  std::size_t bodies;  ///< 0: one or two
  bool as_docs;        ///< made as docs/identification.md says, of a device that zwidth models
  Evidence evidence;
  void (*device)(Case&, Draw&);  ///< changes the device, before its limit, band and force are settled
  void (*record)(Case&, Draw&);  ///< changes what moves beside it, after
};

namespace detail {

inline void nothing(Case&, Draw&) {}

inline void multisine(Case& c, Draw&) { c.experiment.signal = Signal::multisine; }
inline void random_phase(Case& c, Draw&) { c.experiment.signal = Signal::random_phase; }
inline void chirp(Case& c, Draw&) { c.experiment.signal = Signal::logarithmic_chirp; }
inline void noise_force(Case& c, Draw&) { c.experiment.signal = Signal::noise; }
inline void square(Case& c, Draw&) { c.experiment.signal = Signal::square; }
inline void two_amplitudes(Case& c, Draw&) { c.experiment.shares = {1.0, 0.4}; }
inline void handle_sensed(Case& c, Draw&) { c.plant.sensed = 1; }
inline void delay(Case& c, Draw& draw) { c.plant.drive.delay = draw.uniform(0.5, 3.0) * c.experiment.period; }
inline void lag(Case& c, Draw& draw) { c.plant.drive.lag = draw.uniform(0.3, 2.0) * c.experiment.period; }
inline void delay_and_lag(Case& c, Draw& draw) {
  delay(c, draw);
  lag(c, draw);
}
inline void file(Case& c, Draw&) {
  c.known = true;
  c.off = 0.15;
}
inline void stated_delay(Case& c, Draw& draw) {
  delay(c, draw);
  file(c, draw);
}
inline void wrong_delay(Case& c, Draw& draw) {
  delay(c, draw);
  file(c, draw);
  c.stated_delay = c.plant.drive.delay + draw.one_of(std::array{-0.5, 0.5, 1.0}) * c.experiment.period;
}
inline void ground_spring(Case& c, Draw& draw) {
  double mass = 0.0;
  for (const auto& body : c.plant.masses) mass += body.mass;
  c.plant.masses.back().stiffness = mass * std::pow(turn * draw.logarithmic(0.7, 4.0), 2);
}
inline void known_spring(Case& c, Draw& draw) {
  ground_spring(c, draw);
  file(c, draw);
}
inline void locked_handle(Case& c, Draw& draw) {
  c.plant.masses[1].fixed = true;
  c.known = true;
  c.off = 0.4;
  c.free = {"link.stiffness", "link.damping"};
  c.locked = {"body1"};
  const double resonance = std::sqrt(c.plant.joints[0].stiffness / c.plant.masses[0].mass) / turn;
  c.experiment.signal = Signal::linear_chirp;
  c.experiment.lowest_hz = 0.3 * resonance;
  c.experiment.highest_hz = std::min(2.5 * resonance, 0.4 / c.experiment.period);
  c.stroke = c.experiment.resolution * draw.uniform(20.0, 60.0);
  c.counts_at_limit = 0.0;
}
inline void fine_encoder(Case& c, Draw&) {
  c.experiment.resolution *= 0.2;
  c.experiment.disturbance = 0.0005;
}

/// A body of this share of the last one's mass, beyond it; the structure names none.
inline void further_body(Case& c, Draw& draw, double share, double hz) {
  const auto last = c.plant.masses.size() - 1;
  simulated::Mass body;
  body.mass = share * c.plant.masses[last].mass;
  const double reduced = body.mass / (1.0 + share);
  c.mode_hz = hz;
  c.plant.joints.push_back({.first = last,
                            .second = last + 1,
                            .stiffness = reduced * std::pow(turn * hz, 2),
                            .damping = 2.0 * draw.logarithmic(0.005, 0.03) * turn * hz * reduced});
  c.plant.masses.push_back(body);
}
inline void mode_above_band(Case& c, Draw& draw) {
  further_body(c, draw, draw.uniform(0.03, 0.3), draw.uniform(0.1, 0.3) / c.experiment.period);
  c.mode_over_band = draw.uniform(1.3, 3.0);
}
inline void mode_in_band(Case& c, Draw& draw) {
  further_body(c, draw, draw.uniform(0.02, 0.2), draw.logarithmic(15.0, 60.0));
  c.mode_over_band = draw.uniform(0.3, 0.8);
}
inline void missing_body(Case& c, Draw& draw) {
  further_body(c, draw, draw.uniform(0.4, 1.5), draw.logarithmic(10.0, 60.0));
  c.mode_over_band = draw.uniform(0.3, 0.7);
}
inline void hidden_mode(Case& c, Draw& draw) {
  further_body(c, draw, draw.uniform(0.05, 0.3), draw.uniform(0.05, 0.25) / c.experiment.period);
  c.limit_over_band = draw.uniform(1.3, 2.5);
}
inline void above_band(Case& c, Draw& draw) { c.limit_over_band = draw.uniform(1.3, 2.5); }
inline void above_band_given(Case& c, Draw& draw) {
  above_band(c, draw);
  c.known = true;
  for (std::size_t i = 0; i < c.plant.masses.size(); ++i)
    c.free.push_back("body.body" + std::to_string(i) + ".damping");
}
inline void coil(Case& c, Draw& draw) {
  double damping = 0.0;
  for (const auto& body : c.plant.masses) damping += body.damping;
  c.plant.drive.lag = draw.uniform(0.2, 1.5) * c.experiment.period;
  c.plant.drive.back_emf = draw.logarithmic(0.5, 5.0) * damping;
}
inline void viscoelastic(Case& c, Draw& draw) {
  simulated::Joint& joint = c.plant.joints[0];
  joint.relaxing_stiffness = draw.uniform(0.1, 0.5) * joint.stiffness;
  joint.relaxing_damping = joint.relaxing_stiffness / (turn * draw.logarithmic(2.0, 30.0));
}
inline void damping_falls(Case& c, Draw&) {
  c.experiment.duration = 10.0;
  c.experiment.periods = 5;
  c.plant.damping_fall = 0.04;
}
inline void short_record(Case& c, Draw&) {
  c.experiment.duration = 2.0;
  c.experiment.periods = 2;
  c.experiment.lowest_hz = 1.0;
}
inline void high_start(Case& c, Draw&) { c.experiment.lowest_hz = 5.0; }
inline void coarse_encoder(Case& c, Draw&) { c.counts_at_limit = 2.0; }

// What moves beside it: of the force F, the stroke and the speed at the lowest frequency.

/// Coulomb friction of this share of the force, on one body or half on each.
inline void rub(Case& c, Draw& draw, double share) {
  const std::size_t where = draw.below(c.named + (c.named > 1 ? 1 : 0));
  for (std::size_t i = 0; i < c.named; ++i) {
    if (where != i && where != c.named) continue;
    c.plant.masses[i].friction.coulomb =
        share * c.experiment.force / (where == c.named ? static_cast<double>(c.named) : 1.0);
  }
}
inline void friction_1_to_5(Case& c, Draw& draw) { rub(c, draw, draw.logarithmic(0.01, 0.05)); }
inline void friction_10(Case& c, Draw& draw) { rub(c, draw, 0.1); }
inline void drag(Case& c, Draw& draw) {
  simulated::Mass& body = c.plant.masses[draw.below(c.named)];
  body.friction.quadratic = draw.logarithmic(0.2, 1.5) * c.damping / c.speed;
}
inline void friction_and_drag(Case& c, Draw& draw) {
  friction_1_to_5(c, draw);
  drag(c, draw);
}
inline void dahl(Case& c, Draw& draw) {
  friction_1_to_5(c, draw);
  const double bend = c.stroke * draw.logarithmic(0.001, 0.02);
  for (auto& body : c.plant.masses) body.friction.bristles = body.friction.coulomb / bend;
}
inline void stribeck(Case& c, Draw& draw) {
  friction_1_to_5(c, draw);
  const double more = draw.uniform(1.2, 2.0);
  for (auto& body : c.plant.masses) {
    body.friction.stiction = more * body.friction.coulomb;
    body.friction.stribeck_speed = c.speed * draw.logarithmic(0.02, 0.3);
  }
}
inline void asymmetric(Case& c, Draw& draw) {
  friction_1_to_5(c, draw);
  for (auto& body : c.plant.masses) body.friction.asymmetry = draw.uniform(0.2, 0.6);
}
inline void by_position(Case& c, Draw& draw) {
  friction_1_to_5(c, draw);
  for (auto& body : c.plant.masses) {
    body.friction.ripple = draw.uniform(0.2, 0.6);
    body.friction.ripple_period = c.stroke * draw.logarithmic(0.1, 1.0);
  }
}
inline void link_friction(Case& c, Draw& draw) {
  simulated::Joint& joint = c.plant.joints[0];
  joint.friction = draw.logarithmic(0.005, 0.03) * c.experiment.force;
  joint.bristles = draw.uniform(0.05, 0.3) * joint.stiffness;
}
/// A clutch, a grease, a dashpot: no spring, and a damper whose motion is over within some sampling periods.
inline void damper_link(Case& c, Draw& draw) {
  const double first = c.plant.masses[0].mass;
  const double second = c.plant.masses[1].mass;
  c.plant.joints[0].stiffness = 0.0;
  c.plant.joints[0].damping = first * second / (first + second) / (draw.uniform(1.0, 5.0) * c.experiment.period);
}
inline void damper_friction(Case& c, Draw& draw) {
  simulated::Joint& joint = c.plant.joints[0];
  const double carried = c.experiment.force * c.plant.masses[1].mass / c.mass;
  const double stretch = carried / joint.damping / (turn * c.limiting_hz);
  joint.friction = draw.logarithmic(0.01, 0.1) * carried;
  joint.bristles = joint.friction / (draw.logarithmic(0.003, 0.03) * stretch);
}
inline void backlash(Case& c, Draw& draw) {
  c.plant.joints[0].gap = draw.logarithmic(0.02, 0.3) * c.experiment.force / c.plant.joints[0].stiffness;
}
inline void saturation(Case& c, Draw& draw) { c.plant.drive.saturation = draw.uniform(0.6, 0.9) * c.experiment.force; }
inline void dead_band(Case& c, Draw& draw) {
  c.plant.drive.dead_band = draw.logarithmic(0.01, 0.05) * c.experiment.force;
}
inline void cogging(Case& c, Draw& draw) {
  c.plant.drive.cogging = draw.logarithmic(0.01, 0.05) * c.experiment.force;
  c.plant.drive.cogging_period = c.stroke * draw.logarithmic(0.1, 1.0);
  c.plant.drive.cogging_phase = draw.uniform(0.0, turn);
}
inline void constant(Case& c, Draw& draw) {
  c.plant.drive.constant = draw.one_of(std::array{-1.0, 1.0}) * draw.logarithmic(0.003, 0.02) * c.experiment.force;
}
inline void stiffening(Case& c, Draw& draw) {
  const double spring = c.mass * std::pow(turn * draw.uniform(0.5, 1.5), 2);
  c.plant.masses[c.named - 1].cubic = spring / (0.75 * c.stroke * c.stroke);
}
inline void feedback(Case& c, Draw& draw) {
  c.experiment.feedback =
      std::min(draw.uniform(0.1, 0.3) * c.stiffness, c.mass * std::pow(turn * draw.uniform(0.5, 2.0), 2));
}
inline void feedback_and_friction(Case& c, Draw& draw) {
  feedback(c, draw);
  friction_1_to_5(c, draw);
}
inline void row_jitter(Case& c, Draw& draw) { c.experiment.row_jitter = draw.logarithmic(0.03, 0.3); }
inline void stamp_jitter(Case& c, Draw& draw) { c.experiment.stamp_jitter = draw.logarithmic(0.03, 0.3); }
inline void lost_rows(Case& c, Draw& draw) { c.experiment.lost = draw.logarithmic(0.001, 0.05); }
inline void clock_drift(Case& c, Draw& draw) { c.experiment.clock = draw.logarithmic(3e-5, 3e-4); }
inline void strong_noise(Case& c, Draw& draw) {
  c.experiment.disturbance = draw.uniform(0.03, 0.1);
  c.experiment.noise = draw.uniform(1.0, 3.0);
}
inline void slow_disturbance(Case& c, Draw& draw) {
  c.experiment.disturbance = draw.logarithmic(0.01, 0.05);
  c.experiment.disturbance_pole = std::exp(-turn * draw.uniform(0.5, 5.0) * c.experiment.period);
}
inline void hum(Case& c, Draw& draw) { c.experiment.hum = draw.logarithmic(0.003, 0.03); }
inline void weak_force(Case& c, Draw& draw) { c.experiment.force *= draw.logarithmic(0.03, 0.15); }
inline void hand(Case& c, Draw& draw) {
  simulated::Mass& held = c.plant.masses[c.named - 1];
  const double mass = draw.uniform(0.2, 0.6) * c.mass;
  const double mode = turn * draw.uniform(1.5, 4.0);
  held.mass += mass;
  held.stiffness += (c.mass + mass) * mode * mode;
  held.damping += 2.0 * draw.uniform(0.2, 0.6) * mode * (c.mass + mass);
}
inline void wrong_gain(Case& c, Draw& draw) { c.experiment.gain = draw.one_of(std::array{0.75, 0.85, 1.2, 1.35}); }
inline void late_rows(Case& c, Draw&) { c.experiment.late_rows = 1; }

}  // namespace detail

/// Name, bodies, made as the docs say, in reach, what it changes before and after the experiment is settled.
[[nodiscard]] inline std::span<const Kind> kinds() {
  using namespace detail;
  static constexpr std::array all{
      Kind{"rigid_multisine", 1, true, Evidence::of_limit, multisine, nothing},
      Kind{"rigid_random_phase", 1, true, Evidence::of_limit, random_phase, nothing},
      Kind{"rigid_chirp", 1, true, Evidence::of_limit, chirp, nothing},
      Kind{"rigid_noise", 1, true, Evidence::of_limit, noise_force, nothing},
      Kind{"two_body_multisine", 2, true, Evidence::of_limit, multisine, nothing},
      Kind{"two_body_random_phase", 2, true, Evidence::of_limit, random_phase, nothing},
      Kind{"two_body_chirp", 2, true, Evidence::of_limit, chirp, nothing},
      Kind{"two_body_noise", 2, true, Evidence::of_limit, noise_force, nothing},
      Kind{"handle_sensed", 2, true, Evidence::of_limit, handle_sensed, nothing},
      Kind{"three_body", 3, true, Evidence::of_limit, nothing, nothing},
      Kind{"two_amplitudes", 0, true, Evidence::of_limit, two_amplitudes, nothing},
      Kind{"delay_unstated", 0, true, Evidence::of_limit, delay, nothing},
      Kind{"delay_stated", 0, true, Evidence::of_limit, stated_delay, nothing},
      Kind{"lag", 0, true, Evidence::of_limit, lag, nothing},
      Kind{"delay_and_lag", 0, true, Evidence::of_limit, delay_and_lag, nothing},
      Kind{"spring_named", 0, true, Evidence::of_limit, known_spring, nothing},
      Kind{"locked_handle", 2, true, Evidence::of_limit, locked_handle, nothing},
      Kind{"fine_encoder", 0, true, Evidence::of_limit, fine_encoder, nothing},
      Kind{"friction_1_to_5_twice", 0, true, Evidence::of_limit, two_amplitudes, friction_1_to_5},
      Kind{"friction_1_to_5_once", 0, false, Evidence::of_limit, nothing, friction_1_to_5},
      Kind{"friction_10_twice", 0, false, Evidence::of_limit, two_amplitudes, friction_10},
      Kind{"friction_10_once", 0, false, Evidence::of_limit, nothing, friction_10},
      Kind{"drag_once", 0, false, Evidence::of_limit, nothing, drag},
      Kind{"drag_twice", 0, false, Evidence::of_limit, two_amplitudes, drag},
      Kind{"friction_and_drag_chirp", 0, false, Evidence::of_limit, chirp, friction_and_drag},
      Kind{"friction_and_drag_twice", 0, false, Evidence::of_limit, two_amplitudes, friction_and_drag},
      Kind{"damping_falls", 0, false, Evidence::of_limit, damping_falls, nothing},
      Kind{"spring_unnamed", 0, false, Evidence::of_limit, ground_spring, nothing},
      Kind{"mode_above_band", 0, false, Evidence::of_limit, mode_above_band, nothing},
      Kind{"mode_in_band", 0, false, Evidence::of_limit, mode_in_band, nothing},
      Kind{"missing_body", 0, false, Evidence::of_limit, missing_body, nothing},
      Kind{"saturation", 0, false, Evidence::of_limit, nothing, saturation},
      Kind{"dead_band", 0, false, Evidence::of_limit, nothing, dead_band},
      Kind{"cogging", 0, false, Evidence::of_limit, nothing, cogging},
      Kind{"constant_force", 0, false, Evidence::of_limit, nothing, constant},
      Kind{"dahl", 0, false, Evidence::of_limit, two_amplitudes, dahl},
      Kind{"stribeck", 0, false, Evidence::of_limit, two_amplitudes, stribeck},
      Kind{"asymmetric_friction", 0, false, Evidence::of_limit, two_amplitudes, asymmetric},
      Kind{"friction_by_position", 0, false, Evidence::of_limit, two_amplitudes, by_position},
      Kind{"link_friction", 2, false, Evidence::of_limit, nothing, link_friction},
      Kind{"damper_that_rubs", 2, false, Evidence::of_limit, damper_link, damper_friction},
      Kind{"backlash", 2, false, Evidence::of_limit, nothing, backlash},
      Kind{"stiffening_spring", 0, false, Evidence::of_limit, nothing, stiffening},
      Kind{"feedback", 0, false, Evidence::of_limit, nothing, feedback},
      Kind{"feedback_and_friction", 1, false, Evidence::of_limit, nothing, feedback_and_friction},
      Kind{"row_jitter", 0, false, Evidence::of_limit, nothing, row_jitter},
      Kind{"stamp_jitter", 0, false, Evidence::of_limit, nothing, stamp_jitter},
      Kind{"lost_rows", 0, false, Evidence::of_limit, nothing, lost_rows},
      Kind{"clock_drift", 0, false, Evidence::of_limit, nothing, clock_drift},
      Kind{"coil_back_emf", 0, false, Evidence::of_limit, coil, nothing},
      Kind{"viscoelastic_link", 2, false, Evidence::of_limit, viscoelastic, nothing},
      Kind{"strong_noise", 0, false, Evidence::of_limit, nothing, strong_noise},
      Kind{"slow_disturbance", 0, false, Evidence::of_limit, nothing, slow_disturbance},
      Kind{"hum", 0, false, Evidence::of_limit, nothing, hum},
      Kind{"weak_force", 0, false, Evidence::of_limit, nothing, weak_force},
      Kind{"coarse_encoder", 0, false, Evidence::of_limit, coarse_encoder, nothing},
      Kind{"short_record", 0, false, Evidence::of_limit, short_record, nothing},
      Kind{"band_begins_high", 0, false, Evidence::of_limit, high_start, nothing},
      Kind{"square_wave", 0, false, Evidence::of_limit, square, nothing},
      Kind{"wrong_delay_stated", 0, false, Evidence::of_limit, wrong_delay, nothing},
      Kind{"limit_above_band_given", 0, false, Evidence::of_limit, above_band_given, nothing},
      Kind{"limit_above_band", 0, false, Evidence::open, above_band, nothing},
      Kind{"hidden_mode_limits", 0, false, Evidence::open, hidden_mode, nothing},
      Kind{"hand", 0, false, Evidence::none, nothing, hand},
      Kind{"wrong_gain", 0, false, Evidence::none, nothing, wrong_gain},
      Kind{"late_rows", 0, false, Evidence::none, nothing, late_rows},
  };
  return all;
}

/// Nothing for a name that is none.
[[nodiscard]] inline const Kind* find_kind(std::string_view name) {
  const auto all = kinds();
  const auto found = std::ranges::find_if(all, [&](const Kind& kind) { return name == kind.name; });
  return found == all.end() ? nullptr : &*found;
}

/// The device of this kind and seed, and how it is recorded.
[[nodiscard]] inline Case drawn_case(const Kind& kind, std::uint64_t seed) {
  std::uint64_t letters = 0;
  for (const char* letter = kind.name; *letter != '\0'; ++letter)
    letters = 31 * letters + static_cast<unsigned char>(*letter);
  for (std::uint64_t attempt = 0;; ++attempt) {
    Draw draw(letters + 1000003 * seed + 7919 * attempt);
    Case made;
    made.kind = kind.name;
    made.seed = seed;
    detail::draw_plant(made, draw, kind.bodies > 0 ? kind.bodies : 1 + draw.below(2));
    kind.device(made, draw);
    if (!detail::settle(made, draw)) continue;
    made.structure = detail::structure_of(made, draw);
    kind.record(made, draw);
    return made;
  }
}

}  // namespace zwidth::test::campaign
