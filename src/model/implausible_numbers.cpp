#include "model/implausible_numbers.hpp"

#include <fmt/format.h>

#include <utility>

namespace zwidth::internal {
namespace {

/// "is it in milliseconds? It must be in seconds: 0.002", by the largest unit that brings the time below a longest one.
std::string likely_time(double time, double longest) {
  struct Unit {
    double seconds;
    const char* name;
  };
  Unit likely{1e-9, "nanoseconds"};
  for (const Unit& each : {Unit{1e-3, "milliseconds"}, Unit{1e-6, "microseconds"}}) {
    if (time * each.seconds > longest) continue;
    likely = each;
    break;
  }
  return fmt::format("is it in {}? It must be in seconds: {:.4g}", likely.name, time * likely.seconds);
}

}  // namespace

std::optional<Remark> implausible_period(double period, const std::string& whose) {
  constexpr double longest = 0.1;
  constexpr double shortest = 1e-6;
  if (period >= shortest && period <= longest) return std::nullopt;
  constexpr double usual = 0.03;  // 0.2 to 30 are milliseconds given as seconds, more are microseconds
  return Remark{
      Remark::Severity::warning, fmt::format("{} is {:.4g} s", whose, period),
      "every delay, damping and critical stiffness depends on it",
      period > longest ? likely_time(period, usual) : "is the time in the unit that was stated? It must be in seconds"};
}

std::optional<Remark> implausible_lateness(const Device& device, double period) {
  const double late = device.loop().delay + device.parameters().actuator.time_constant;
  if (late <= many_periods * period) return std::nullopt;
  return Remark{Remark::Severity::warning,
                fmt::format("delay and lag come to {:.4g} s, {:.3g} sampling periods", late, late / period),
                "few drives are as slow as that", likely_time(late, many_periods * period)};
}

std::vector<Remark> implausible_masses(const Device& device, double heaviest) {
  std::vector<Remark> remarks;
  const bool is_rotary = device.parameters().motion == Motion::rotary;
  for (const Body& body : device.bodies()) {
    if (body.mass <= heaviest) continue;
    remarks.push_back({Remark::Severity::warning,
                       fmt::format("{} has {} of {:.4g} {}", body.name, is_rotary ? "an inertia" : "a mass", body.mass,
                                   is_rotary ? "kg m^2" : "kg"),
                       "few haptic devices are as heavy as that",
                       fmt::format("is it in {}? It must be in {}: {:.4g}", is_rotary ? "g m^2" : "g",
                                   is_rotary ? "kg m^2" : "kg", 1e-3 * body.mass)});
  }
  return remarks;
}

std::vector<Remark> implausible_numbers(const Device& device) {
  std::vector<Remark> remarks;
  const double period = device.loop().sampling_period;
  if (auto remark = implausible_period(period, "the sampling period")) remarks.push_back(*std::move(remark));
  if (auto remark = implausible_lateness(device, period)) remarks.push_back(*std::move(remark));
  const double heaviest = device.parameters().motion == Motion::rotary ? 10.0 : 1000.0;
  for (Remark& remark : implausible_masses(device, heaviest)) remarks.push_back(std::move(remark));
  return remarks;
}

}  // namespace zwidth::internal
