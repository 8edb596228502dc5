#include "reproduce/table_2.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/text/quantity.hpp"
#include "reproduce/paper_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/simulation/relay.hpp"

namespace zwidth::report {
namespace {

constexpr double least_level = 0.06;
constexpr double level_step = 0.0025;
constexpr int levels = 17;
constexpr double compared_from = 1.5e-3;  // s: the rows of 2 ms and more

std::vector<RelayTrial> trials_of(const Table2Setting& setting, const Device& device, double start) {
  RelayOptions options;
  options.relay.amplitude = setting.relay_force;
  options.duration = setting.duration;
  options.trials = trials_per_delay;
  options.start_offset = start;
  options.variation = setting.variation;
  options.seed = static_cast<std::uint64_t>(std::llround(1e6 * device.loop().delay));  // each row its own
  return relay_trials(device, options);
}

/// The rigid device of eq. 2 with the friction of the handle.
Device rigid_device(const Table2Setting& setting, double level, double delay) {
  DeviceParameters device = with_delay(paper_lhifam_rigid(), delay + setting.inherent_delay);
  device.bodies.front().coulomb = level * setting.relay_force;
  return Device(std::move(device));
}

Table2Row row_of(const std::vector<RelayTrial>& trials, double delay) {
  const auto mean = relay_mean(trials);
  if (!mean || mean->trials != trials.size()) {
    throw Error(ErrorCode::did_not_converge, "a relay trial of Table II does not oscillate");
  }
  return {delay, hertz(mean->frequency), decibels(mean->stiffness), hertz(mean->lowest_frequency),
          hertz(mean->highest_frequency)};
}

using DeviceAt = Device (*)(const Table2Setting& setting, double level, double delay);

std::array<Table2Row, 9> rows_of(const Table2& table, DeviceAt device_at, double level, double start) {
  std::array<Table2Row, 9> rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double delay = table.printed.at(i).delay;
    rows.at(i) = row_of(trials_of(table.setting, device_at(table.setting, level, delay), start), delay);
  }
  return rows;
}

/// Over the compared rows; `ours` may hold only those.
template <typename OursAt>
Table2Error error_of(const std::array<Table2Row, 9>& printed, const OursAt& ours_at) {
  Table2Error sums;
  double count = 0.0;
  for (const Table2Row& row : printed) {
    if (row.delay < compared_from) continue;
    const Table2Row ours = ours_at(row.delay);
    sums.frequency += std::pow(ours.frequency_hz / row.frequency_hz - 1.0, 2);
    sums.margin_db += std::pow(ours.margin_db - row.margin_db, 2);
    count += 1.0;
  }
  return {std::sqrt(sums.frequency / count), std::sqrt(sums.margin_db / count)};
}

Table2 reproduced() {
  Table2 table;
  const Table2Setting& setting = table.setting;
  table.printed = table_2_printed();
  for (int i = 0; i < levels; ++i) {
    const double level = least_level + level_step * i;
    table.friction_scan.push_back(
        {level, error_of(table.printed, [&](double delay) {
           return row_of(trials_of(setting, table_2_device(setting, level, delay), setting.large_start), delay);
         })});
  }
  const auto best = std::min_element(
      table.friction_scan.begin(), table.friction_scan.end(),
      [](const FrictionTrial& a, const FrictionTrial& b) { return a.error.frequency < b.error.frequency; });
  table.friction_level = best->level;
  table.error = best->error;
  table.from_large = rows_of(table, table_2_device, table.friction_level, setting.large_start);
  table.from_small = rows_of(table, table_2_device, table.friction_level, setting.small_start);
  table.without_friction = rows_of(table, table_2_device, 0.0, setting.large_start);
  table.rigid = rows_of(table, rigid_device, table.friction_level, setting.large_start);
  table.first_trial =
      trials_of(setting, table_2_device(setting, table.friction_level, 0.0), setting.large_start).front();
  return table;
}

}  // namespace

std::array<Table2Row, 9> table_2_printed() {
  std::array<Table2Row, 9> rows;
  const auto& trials = paper_table_2();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Table2Row& row = rows.at(i);
    row.lowest_hz = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < trials_per_delay; ++k) {
      const PaperTrial& trial = trials.at(i * trials_per_delay + k);
      row.delay = trial.delay;
      row.frequency_hz += trial.frequency_hz / static_cast<double>(trials_per_delay);
      row.margin_db += trial.margin_db / static_cast<double>(trials_per_delay);
      row.lowest_hz = std::min(row.lowest_hz, trial.frequency_hz);
      row.highest_hz = std::max(row.highest_hz, trial.frequency_hz);
    }
  }
  return rows;
}

Device table_2_device(const Table2Setting& setting, double level, double delay) {
  DeviceParameters device = with_delay(paper_lhifam_reduced_pretension(), delay + setting.inherent_delay);
  device.bodies[device.loop.held].coulomb = level * setting.relay_force;
  return Device(std::move(device));
}

const Table2& table_2() {
  static const Table2 table = reproduced();
  return table;
}

}  // namespace zwidth::report
