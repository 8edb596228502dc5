#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

inline constexpr std::size_t most_sweep_points = 1'000'000;  ///< of all axes together

/// The values that one number of the device takes in turn.
struct SweepAxis {
  /// Equal steps, or equal factors.
  enum class Spacing { linear, logarithmic };
  std::string key;                    ///< as in model/parameter.hpp
  double first = 0.0;                 ///< logarithmic: > 0, as `last`
  double last = 0.0;                  ///< above or below `first`
  std::size_t count = 2;              ///< >= 2, both ends included
  Spacing spacing = Spacing::linear;  ///< logarithmic for positive ends only
};

/// first, ..., last: both exactly.
[[nodiscard]] std::vector<double> values_of(const SweepAxis& axis);

/// What a sweep computes at each point.
struct SweepOptions {
  bool any_user = false;    ///< the limit over all passive users too: slower; a device of bodies only
  bool crossovers = false;  ///< keep every crossover of every point, not only the limiting one
};

/// K_CR of the device with the axes' parameters at one of their values.
struct SweepPoint {
  StiffnessStatus status = StiffnessStatus::finite;  ///< whether there is a limit
  double stiffness = 0.0;          ///< K_CR; 0 when none_stable, infinity when unbounded, NaN when refused
  std::optional<Crossover> limit;  ///< absent unless finite
  std::optional<AbsoluteStabilityLimit> any_user;  ///< where asked for, unless refused
  std::vector<Crossover> crossovers;               ///< where asked for, by rising frequency
  Trust trust;                                     ///< of the device, and of both computations
};

/// The limits over a grid of one or two numbers.
struct ParameterSweep {
  std::vector<SweepAxis> axes;              ///< a body's inertia by its own name, mass
  std::vector<std::vector<double>> values;  ///< of each axis
  std::vector<SweepPoint> points;           ///< the last axis fastest: [i] or [i * values[1].size() + j]
  bool has_any_user = false;                ///< it was asked for
  Trust trust;                              ///< the device's; doubtful where a point is, refused where all are
};

/// The first combination of values that makes no device, or an axis that cannot be: what is wrong with the sweep.
[[nodiscard]] std::optional<DeviceProblem> find_sweep_problem(const Device& device, const std::vector<SweepAxis>& axes);

/// Checks: any_user for a device with a body to hold.
[[nodiscard]] std::optional<OptionProblem> find_problem(const SweepOptions& options, const Device& device);

/// Analyses the device at every value of one parameter, or at every pair of values of two, with the wall's damper
/// closed.
///
/// Points run in parallel where there are many; `progress` may be called from any thread, never from two at once.
/// Throws Error (invalid_argument) where find_sweep_problem() finds one, (needs_bodies) for the absolute stability limit of a
/// transfer function, and as critical_stiffness() and absolute_stability_limit() do.
[[nodiscard]] ParameterSweep parameter_sweep(const Device& device, const std::vector<SweepAxis>& axes,
                                             SweepOptions options = {}, const Progress& progress = {});

}  // namespace zwidth
