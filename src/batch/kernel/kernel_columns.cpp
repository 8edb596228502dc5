#include "batch/kernel/kernel_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "sampling/sampling_instants.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

// What find_problem() of a device takes whatever the number is for; it says what is wrong with others.
constexpr double smallest = 1e-30;
constexpr double largest = 1e30;
bool is_plain(double value) { return value == 0.0 || (value >= smallest && value <= largest); }

// Devices of one group differ in numbers alone.
struct GroupOf {
  bool fractional, lag, damper, filter;
  std::size_t delay_samples;

  static constexpr std::size_t count = (most_kernel_delay + 1) * 16;
  explicit GroupOf(std::size_t id)
      : fractional((id & 8U) != 0),
        lag((id & 4U) != 0),
        damper((id & 2U) != 0),
        filter((id & 1U) != 0),
        delay_samples(id / 16) {}
  static std::size_t id(bool fractional, bool lag, bool damper, bool filter, std::size_t delay_samples) {
    return 16 * delay_samples + (fractional ? 8 : 0) + (lag ? 4 : 0) + (damper ? 2 : 0) + (filter ? 1 : 0);
  }
};

}  // namespace

KernelColumns::KernelColumns(const DeviceParameters& base, std::span<const ParameterValues> changes) {
  const std::size_t bodies = base.bodies.size();
  if (base.transfer_function || bodies == 0 || bodies > 2 || base.links.size() != bodies - 1 ||
      !base.wall.filters.empty() || base.loop.damper || base.sensor.tracking_bandwidth > 0.0) {
    return;
  }
  const auto is_unknown = [](const ParameterValues& each) {
    const bool is_tracking = each.key == "sensor.tracking_bandwidth" &&
                             !std::ranges::all_of(each.values, [](double value) { return value == 0.0; });
    return each.key.starts_with("loop.damper.") || is_tracking;
  };
  if (std::ranges::any_of(changes, is_unknown)) return;
  suits_ = true;
  two_bodies_ = bodies == 2;
  collocated_ = base.loop.sensed == base.loop.actuated;
  holds_actuated_ = base.loop.held == base.loop.actuated;
  base_ = numbers_of(base);
  for (const ParameterValues& each : changes) columns_.push_back({number_of(base, each.key), each.values});
}

KernelColumns::Numbers KernelColumns::numbers_of(const DeviceParameters& device) const {
  Numbers values{};
  const Body& actuated = device.bodies[device.loop.actuated];
  values[actuated_mass] = actuated.mass;
  values[actuated_damping] = actuated.damping;
  values[actuated_stiffness] = actuated.stiffness;
  if (two_bodies_) {
    const Body& other = device.bodies[1 - device.loop.actuated];
    values[other_mass] = other.mass;
    values[other_damping] = other.damping;
    values[other_stiffness] = other.stiffness;
    values[link_stiffness] = device.links[0].stiffness;
    values[link_damping] = device.links[0].damping;
  }
  values[period] = device.loop.sampling_period;
  values[delay] = device.loop.delay;
  values[lag] = device.actuator.time_constant;
  values[damper] = device.wall.damping;
  values[velocity_filter] = device.wall.velocity_filter_hz;
  values[force_limit] = device.actuator.force_limit.value_or(1.0);
  values[user_mass] = device.user.mass;
  values[user_damping] = device.user.damping;
  values[user_stiffness] = device.user.stiffness;
  return values;
}

// The one that the key moves; `numbers` where it moves none.
std::size_t KernelColumns::number_of(const DeviceParameters& base, const std::string& key) const {
  DeviceParameters marked = base;
  set_parameter(marked, key, std::numeric_limits<double>::quiet_NaN());
  const Numbers values = numbers_of(marked);
  const auto* const moved = std::ranges::find_if(values, [](double value) { return std::isnan(value); });
  return static_cast<std::size_t>(moved - values.begin());
}

// False where the device is none, or of another kind.
bool KernelColumns::take(std::size_t i, Numbers& values) const {
  values = base_;
  bool plain = true;
  for (const Column& column : columns_) {
    const double value = column.values[i];
    plain = plain && is_plain(value);
    if (column.number < numbers) values[column.number] = value;
  }
  if (!plain || !(values[actuated_mass] > 0.0) || !(values[period] > 0.0) || !(values[force_limit] > 0.0)) {
    return false;
  }
  if (two_bodies_ && !(values[other_mass] > 0.0 && values[link_stiffness] > 0.0)) return false;
  values[holds_actuated_ ? actuated_mass : other_mass] += values[user_mass];
  values[holds_actuated_ ? actuated_damping : other_damping] += values[user_damping];
  values[holds_actuated_ ? actuated_stiffness : other_stiffness] += values[user_stiffness];
  if (two_bodies_ && (values[actuated_stiffness] > 0.0 || values[other_stiffness] > 0.0)) return false;
  return values[delay] <= static_cast<double>(most_kernel_delay) * values[period];
}

void KernelColumns::solve(std::size_t begin, std::size_t end, KernelAnswers& answers, BlockScratch& scratch) const {
  const std::size_t count = end - begin;
  answers.stiffness.resize(count);
  answers.frequency.resize(count);
  answers.mode.resize(count);
  answers.poles_leaving.resize(count);
  answers.certain.assign(count, 0);
  if (!suits_) return;
  const std::size_t length = padded(count);
  std::array<std::vector<double>, kernel_inputs>& inputs = scratch.devices.inputs;
  for (std::vector<double>& input : inputs) input.resize(length);
  scratch.answers.stiffness.resize(length);
  scratch.answers.frequency.resize(length);
  scratch.answers.mode.resize(length);
  scratch.answers.poles_leaving.resize(length);
  scratch.answers.certain.resize(length);
  scratch.rows.resize(count);
  scratch.groups.resize(GroupOf::count);
  for (std::vector<std::size_t>& group : scratch.groups) group.clear();
  Numbers values;
  for (std::size_t i = 0; i < count; ++i) {
    if (!take(begin + i, values)) continue;
    const SamplingInstants instants = sampling_instants({values[period], values[delay]});
    const bool fractional = instants.with_old > 0.0;
    const std::size_t samples = instants.whole_samples + (fractional ? 1 : 0);
    if (samples > most_kernel_delay) continue;
    scratch.rows[i] = {values[actuated_mass],
                       values[actuated_damping],
                       values[actuated_stiffness],
                       values[other_mass],
                       values[other_damping],
                       values[link_stiffness],
                       values[link_damping],
                       values[period],
                       instants.with_new,
                       instants.with_old,
                       values[lag],
                       values[damper],
                       values[velocity_filter]};
    const bool damped = values[damper] > 0.0;
    scratch.groups[GroupOf::id(fractional, values[lag] > 0.0, damped, damped && values[velocity_filter] > 0.0, samples)]
        .push_back(i);
  }
  for (std::size_t id = 0; id < GroupOf::count; ++id) {
    const std::vector<std::size_t>& members = scratch.groups[id];
    if (members.empty()) continue;
    for (std::size_t at = 0; at < members.size(); ++at) {
      const std::array<double, kernel_inputs>& row = scratch.rows[members[at]];
      for (std::size_t k = 0; k < kernel_inputs; ++k) inputs[k][at] = row[k];
    }
    for (std::size_t at = members.size(); at < padded(members.size()); ++at) {  // idle lanes
      for (std::vector<double>& input : inputs) input[at] = input[0];
    }
    const GroupOf kind(id);
    const KernelGroup group{two_bodies_, collocated_, kind.fractional,   kind.lag,
                            kind.damper, kind.filter, kind.delay_samples};
    solve_group(group, scratch.devices, members.size(), scratch.answers, scratch.kernel);
    for (std::size_t at = 0; at < members.size(); ++at) {
      const std::size_t i = members[at];
      answers.stiffness[i] = scratch.answers.stiffness[at];
      answers.frequency[i] = scratch.answers.frequency[at];
      answers.mode[i] = scratch.answers.mode[at];
      answers.poles_leaving[i] = scratch.answers.poles_leaving[at];
      answers.certain[i] = scratch.answers.certain[at];
    }
  }
}

}  // namespace zwidth::internal
