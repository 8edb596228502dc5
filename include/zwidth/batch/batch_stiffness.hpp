#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/parameter_values.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

inline constexpr std::size_t most_batch_threads = 1024;  ///< as one call may use

/// What is computed of each device, and by how many threads.
struct BatchOptions {
  bool any_user = false;    ///< the limit over all passive users too: much slower; a device of bodies only
  std::size_t threads = 0;  ///< 0: all cores. No result depends on it
  bool vectorised = true;   ///< false: critical_stiffness(Device) of every device, whatever its structure
};

/// Checks: any_user for a device with a body to hold; threads.
[[nodiscard]] std::optional<OptionProblem> find_problem(const BatchOptions& options, const Device& device);

/// What is to be said of one device that has no sound answer of its own.
struct BatchException {
  std::size_t index = 0;     ///< of the device, in the order of the values
  Trust trust = {};          ///< of the computation, the base device's apart
  std::string failure = {};  ///< the values make no device, or the computation failed; empty: neither
};

/// One element of every column for each device, in the order of the values.
struct BatchStiffness {
  std::vector<double> stiffness;        ///< K_CR; 0 when none_stable, infinity when unbounded, NaN when refused
  std::vector<StiffnessStatus> status;  ///< refused too where the device failed
  std::vector<double> frequency;        ///< rad/s, of the limiting crossover; NaN unless finite
  std::vector<std::int16_t> mode;       ///< of the limiting mechanism: 0 the rigid body, 1.. the mode; -1 unless finite
  std::vector<std::int8_t> poles_leaving;  ///< Crossover::poles_leaving of the limiting one; 0 unless finite
  std::vector<Trust::Verdict> verdict;     ///< of trust_of(i)
  std::vector<double> any_user;  ///< AbsoluteStabilityLimit::stiffness; NaN when refused; empty unless asked for
  std::vector<double> absolute_stability_frequency;  ///< rad/s, AbsoluteStabilityLimit::frequency; as any_user
  Trust trust;                                       ///< of the base device: every element has it
  std::vector<BatchException> exceptions;            ///< by rising index: every device with more to say than `trust`
  std::size_t scalar_count = 0;  ///< devices that critical_stiffness(Device) answered, not the kernel

  [[nodiscard]] std::size_t size() const { return stiffness.size(); }  ///< how many devices
  /// What limits the i-th device; nothing unless its status is finite.
  [[nodiscard]] std::optional<Oscillator> limited_by(std::size_t i) const;
  /// Trust in the i-th device's answer: the base device's, its computation's, and the absolute stability limit's.
  [[nodiscard]] Trust trust_of(std::size_t i) const;
  /// Why the i-th device has no answer; empty where it has one, or is refused for its trust.
  [[nodiscard]] std::string failure_of(std::size_t i) const;
};

/// critical_stiffness() of the device with the i-th value of every key set, for every i, in columns.
///
/// Each element is that of critical_stiffness(Device) for it alone: status, mechanism and verdict are the same, values
/// to 1e-12 relative. It depends neither on its neighbours nor on the number of threads, bit for bit. Values that make
/// no device, and what does not converge, end nothing: that element is refused, and `exceptions` says why.
/// `progress` may be called from any thread, never from two at once.
/// Throws Error (invalid_argument) where find_problem() of the changes or of the options finds one, (needs_bodies) for
/// the absolute stability limit of a transfer function.
[[nodiscard]] BatchStiffness batch_stiffness(const Device& device, std::span<const ParameterValues> changes,
                                             const BatchOptions& options = {}, const Progress& progress = {});

}  // namespace zwidth
