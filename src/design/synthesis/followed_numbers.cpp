#include "design/synthesis/followed_numbers.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "design/sensitivities/two_rate_sensitivity.hpp"
#include "design/synthesis/users_at_frequency.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

// One limit with any user takes a tenth of a second with ten bodies, and each number some twenty of them. With more bodies
// than these only the numbers that move the limit most are followed, and less far.
constexpr std::size_t most_bodies_followed_whole = 4;
constexpr std::size_t bodies_times_numbers = 40;
constexpr std::size_t fewest_followed = 4;
constexpr double little_more = 1.01;   // times a number, to see how it moves the limit
constexpr double towards_rest = 1e-2;  // rad per sample, where the limit is reached towards zero frequency

// How much a number moves what users reach at one frequency: |log(K'/K)| where it is 1 % more. A number that is 0 now has
// no such step.
double influence_of(const Device& device, const DesignParameter& parameter, WallNumber number, double frequency) {
  DeviceParameters moved = device.parameters();
  moved.uncertainty.reset();
  set_with_ratio(moved, parameter.key, little_more * parameter.value);
  if (parameter.value == 0.0 || find_problem(moved) || !knows_users_of(Device(moved))) return 0.0;
  const auto reached_by = [number, frequency](const Device& each) {
    const UsersAtFrequency users(each, number);
    return users.least_gain_at(std::min(frequency, users.nyquist()));
  };
  try {
    const double influence = std::abs(std::log(reached_by(Device(std::move(moved))) / reached_by(device)));
    return std::isnan(influence) ? 0.0 : influence;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    return 0.0;
  }
}

}  // namespace

std::vector<DesignParameter> take_out_least(const Device& device, WallNumber number, double limit_frequency,
                                            const Progress& progress, std::vector<DesignParameter>& parameters) {
  const std::size_t bodies = device.degrees_of_freedom();
  const std::size_t most = std::max(fewest_followed, bodies_times_numbers / std::max<std::size_t>(bodies, 1));
  if (bodies <= most_bodies_followed_whole || parameters.size() <= most) return {};
  const double frequency = limit_frequency > 0.0 ? limit_frequency : towards_rest / device.loop().sampling_period;
  struct Influence {
    double size = 0.0;
    std::size_t index = 0;
  };
  std::vector<Influence> influences(parameters.size());
  tbb::parallel_for(std::size_t{0}, parameters.size(), [&](std::size_t i) {
    tell(progress, 0.0);
    influences[i] = {influence_of(device, parameters[i], number, frequency), i};
  });
  std::ranges::stable_sort(influences, std::greater{}, &Influence::size);
  std::vector<bool> is_followed(parameters.size(), false);
  for (std::size_t i = 0; i < most; ++i) is_followed[influences[i].index] = true;
  // The virtual damper costs nothing, and from 0 or next to it a small step tells nothing of it.
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].kind == DesignParameter::Kind::wall_damping) is_followed[i] = true;
  }
  std::vector<DesignParameter> kept;
  std::vector<DesignParameter> left_out;
  for (std::size_t i = 0; i < parameters.size(); ++i) (is_followed[i] ? kept : left_out).push_back(parameters[i]);
  parameters = std::move(kept);
  return left_out;
}

}  // namespace zwidth::internal
