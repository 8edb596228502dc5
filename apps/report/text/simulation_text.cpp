#include "report/text/simulation_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/remark_line.hpp"
#include "report/text/text_table.hpp"
#include "report/text/wall_filter_text.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t width = 100;
constexpr std::size_t indent = 22;

std::string line(std::string_view label, std::string_view text) {
  return wrap(text, width, indent).replace(0, label.size() + 2, fmt::format("  {}", label));
}

std::string wall_text(const SimulatedLoop& loop) {
  const ControllerOptions& wall = loop.options.loop.controller;
  const Units units = units_of(loop.analysed.device.parameters().motion);
  std::string text = quantity(wall.stiffness, units.stiffness);
  if (wall.damping > 0.0) text += fmt::format(" and {}", quantity(wall.damping, units.damping));
  if (wall.damping > 0.0 && wall.velocity_filter_hz > 0.0) {
    text += fmt::format(" (velocity low-pass at {})", quantity(wall.velocity_filter_hz, "Hz"));
  }
  if (const auto filters = wall_filters_text(loop.analysed.device.parameters().wall)) text += ", through " + *filters;
  return text + fmt::format(", from {} on, {}", quantity(wall.position, units.length),
                            wall.contact == ControllerOptions::Contact::unilateral
                                ? "pushing only"
                                : "pulling back from the other side too");
}

std::string start_text(const SimulatedLoop& loop) {
  const Units units = units_of(loop.analysed.device.parameters().motion);
  const HybridLoopOptions& options = loop.options.loop;
  if (options.initial_position.empty()) return "at rest at 0";
  std::string text;
  for (std::size_t i = 0; i < options.initial_position.size(); ++i) {
    const double velocity = options.initial_velocity.empty() ? 0.0 : options.initial_velocity[i];
    text +=
        fmt::format("{}{} at {}, {}", i == 0 ? "" : "; ", loop.analysed.device.bodies()[i].name,
                    quantity(options.initial_position[i], units.length),
                    velocity == 0.0 ? "at rest" : "moving at " + quantity(velocity, std::string(units.length) + "/s"));
  }
  return text;
}

std::string user_text(const SimulatedLoop& loop) {
  const UserForce& force = loop.options.loop.user_force;
  const std::string unit(units_of(loop.analysed.device.parameters().motion).force);
  const std::string from = fmt::format(", from {} on", quantity(force.start, "s"));
  switch (force.kind) {
    case UserForce::Kind::none:
      break;
    case UserForce::Kind::step:
      return "a constant " + quantity(force.amplitude, unit) + from;
    case UserForce::Kind::ramp:
      return "rising by " + quantity(force.amplitude, unit + "/s") + from;
    case UserForce::Kind::sine:
      return fmt::format("a sine of {} at {}{}", quantity(force.amplitude, unit),
                         quantity(hertz(force.frequency), "Hz"), from);
    case UserForce::Kind::recorded:
      return fmt::format("recorded, {} samples every {}{}", force.samples.size(), quantity(force.period, "s"), from);
  }
  return "none";
}

std::string faults_text(const Faults& faults) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (faults.lost_sample_probability > 0.0)
    add(fmt::format("{:.3g} % of samples lost", 100.0 * faults.lost_sample_probability));
  if (faults.sampling_jitter > 0.0) add(fmt::format("samples up to {} late", quantity(faults.sampling_jitter, "s")));
  if (faults.overrun_probability > 0.0) {
    add(fmt::format("{:.3g} % of forces {} late", 100.0 * faults.overrun_probability,
                    quantity(faults.overrun_delay, "s")));
  }
  return text.empty() ? text : text + fmt::format(" (seed {})", faults.seed);
}

std::string energy_text(const SimulatedLoop& loop) {
  const Simulation& result = loop.result;
  // 0 is what rounding makes of it.
  return fmt::format("{} at the end, {} at most; above 0 the sampled wall was active: it gave more than it took",
                     quantity(*result.generated_energy, "J"), quantity(result.peak_generated_energy, "J"));
}

}  // namespace

std::string simulation_text(const SimulatedLoop& loop) {
  const Simulation& result = loop.result;
  const Device& device = loop.analysed.device;
  const Units units = units_of(device.parameters().motion);
  const double period = device.loop().sampling_period;
  const bool has_wall = result.generated_energy.has_value();
  std::string text = shortened(display_name(device), width) + "\n";
  text +=
      line("simulated", fmt::format("{}, {} samples at {}", quantity(static_cast<double>(result.samples) * period, "s"),
                                    result.samples, quantity(1.0 / period, "Hz")));
  if (has_wall) text += line("wall", wall_text(loop));
  text += line("start", start_text(loop));
  if (loop.options.loop.user_force.kind != UserForce::Kind::none) text += line("user's force", user_text(loop));
  if (const std::string faults = faults_text(loop.options.loop.faults); !faults.empty()) text += line("faults", faults);
  text += "\n" + wrap(verdict_sentence(loop) + ".", width, 0) + "\n";
  if (result.settling_time) {
    text += line("settled after",
                 fmt::format("{} (to 2 % of its largest excursion)", quantity(*result.settling_time, "s")));
  }
  text += line("ends at", quantity(result.final_position, units.length));
  if (has_wall) {
    text += line("peak penetration",
                 result.peak_penetration > 0.0 ? quantity(result.peak_penetration, units.length) : "none");
    text += line("generated energy", energy_text(loop));
  }
  if (result.friction_events > 0) text += line("stick-slip", fmt::format("{} instants", result.friction_events));
  text += line("linear answer", linear_answer(loop));
  for (const Remark& remark : loop.remarks) {
    text += line("note", remark_line(remark));
  }
  return text;
}

}  // namespace zwidth::report
