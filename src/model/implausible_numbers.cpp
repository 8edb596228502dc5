#include "model/implausible_numbers.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

namespace zwidth::internal {
namespace {

struct Unit {
  double seconds;
  const char* name;
};

/// The largest unit that brings the time below a longest one.
Unit likely_unit(double time, double longest) {
  for (const Unit& each : {Unit{1e-3, "milliseconds"}, Unit{1e-6, "microseconds"}}) {
    if (time * each.seconds <= longest) return each;
  }
  return {1e-9, "nanoseconds"};
}

/// What stands in the mechanism's file and does not hold.
void add_replaced_numbers(const MechanismFile& mechanism, std::vector<Remark>& remarks) {
  for (const auto& [key, value] : mechanism.numbers) {
    const auto of_file = mechanism.file_numbers.find(key);
    if (of_file == mechanism.file_numbers.end() || of_file->second.value == value) continue;
    remarks.push_back(note({.code = FindingCode::mechanism_number_replaced,
                            .evidence = {{"value", value}, {"of_file", of_file->second.value}},
                            .key = fmt::format("mechanism.{}", key)}));
  }
}

}  // namespace

std::optional<Remark> implausible_period(double period, const std::string& whose) {
  constexpr double longest = 0.1;
  constexpr double shortest = 1e-6;
  if (period >= shortest && period <= longest) return std::nullopt;
  std::vector<Subject> subjects;
  if (!whose.empty()) subjects.push_back({"whose", whose});
  constexpr double usual = 0.03;  // 0.2 to 30 are milliseconds given as seconds, more are microseconds
  if (period < shortest) {
    return warning({.code = FindingCode::period_too_short,
                    .evidence = {{"period", period}, {"threshold", shortest}},
                    .subjects = std::move(subjects),
                    .key = "loop.sampling_period"});
  }
  const Unit unit = likely_unit(period, usual);
  subjects.push_back({"likely_unit", unit.name});
  return warning({.code = FindingCode::period_too_long,
                  .evidence = {{"period", period}, {"threshold", longest}, {"likely", period * unit.seconds}},
                  .subjects = std::move(subjects),
                  .key = "loop.sampling_period"});
}

std::optional<Remark> implausible_actuation_delay(const Device& device, double period) {
  const double late = device.loop().delay + device.parameters().actuator.time_constant;
  if (late <= many_periods * period) return std::nullopt;
  const Unit unit = likely_unit(late, many_periods * period);
  return warning({.code = FindingCode::late_beyond_drives,
                  .evidence = {{"late", late},
                               {"periods", late / period},
                               {"threshold", many_periods},
                               {"likely", late * unit.seconds}},
                  .subjects = {{"likely_unit", unit.name}},
                  .key = "loop.delay"});
}

std::vector<Remark> implausible_masses(const Device& device, double heaviest) {
  std::vector<Remark> remarks;
  const bool is_rotary = device.parameters().motion == Motion::rotary;
  for (const Body& body : device.bodies()) {
    if (body.mass <= heaviest) continue;
    const std::string_view what = is_rotary ? "inertia" : "mass";
    remarks.push_back(warning({.code = is_rotary ? FindingCode::inertia_too_large : FindingCode::mass_too_large,
                               .evidence = {{what, body.mass}, {"threshold", heaviest}, {"likely", 1e-3 * body.mass}},
                               .subjects = {{"body", body.name}}}));
  }
  return remarks;
}

std::vector<Remark> implausible_numbers(const Device& device) {
  std::vector<Remark> remarks;
  const double period = device.loop().sampling_period;
  if (auto remark = implausible_period(period, "")) remarks.push_back(*std::move(remark));
  if (auto remark = implausible_actuation_delay(device, period)) remarks.push_back(*std::move(remark));
  const double heaviest = device.parameters().motion == Motion::rotary ? 10.0 : 1000.0;
  for (Remark& remark : implausible_masses(device, heaviest)) remarks.push_back(std::move(remark));
  if (device.parameters().mechanism) add_replaced_numbers(device.parameters().mechanism->mechanism, remarks);
  return remarks;
}

}  // namespace zwidth::internal
