#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth {

/// What is fitted, from where, and what is held to be known.
struct ParameterFitOptions {
  /// Keys as in model/parameter.hpp. Empty, or "all" among them: every mass and damping of a body, every stiffness and
  /// damping of a link, and stiffnesses to ground, delay and lag where they are not 0 in the structure; of what is not
  /// locked.
  std::vector<std::string> free{};
  /// Bodies held still during the experiment, by name (the paper locks the handle); the result is of the free device.
  std::vector<std::string> locked{};
  std::optional<double> lowest{};   ///< rad/s; points outside are left out
  std::optional<double> highest{};  ///< rad/s
  /// Residuals beyond this many standard deviations count linearly (Huber loss); 0: plain least squares.
  double robust_threshold = 3.0;
  /// Whether the structure's values of the free parameters are the starting point, or the starting point is found from
  /// the data (antiresonance, resonance, low-frequency line), other places of the resonances tried where it leaves more
  /// than their noise.
  enum class Start { from_data, from_structure } start = Start::from_data;  ///< from the data alone
};

inline constexpr std::size_t max_free_parameters = 40;  ///< of one fit

/// One fitted parameter.
struct ParameterEstimate {
  std::string key;     ///< in full: links with their index
  double value = 0.0;  ///< SI units
  /// The data determine it by itself. If not, they determine at most a combination of it with others (see
  /// ParameterFit::unidentifiable); `value` is then as near to the starting point (the structure's value) as the data
  /// allow, and the interval is absent.
  bool identifiable = true;
  std::optional<double> standard_deviation;  ///< absent where the data do not determine it
  std::optional<double> lower;               ///< 95 %; 0 where the value itself is at that bound
  std::optional<double> upper;               ///< absent where nothing bounds it
};

/// Two parameters that the data hardly tell apart.
struct StrongCorrelation {
  std::string first;         ///< key of the one
  std::string second;        ///< key of the other
  double correlation = 0.0;  ///< |correlation| > 0.95
};

/// Parameters of which the data determine only a combination, or nothing.
struct UnidentifiableCombination {
  std::vector<std::string> parameters;  ///< keys of the numbers of which only a combination shows
};

/// A structure fitted to a measured response.
struct ParameterFit {
  Device device;  ///< the structure with the fitted values, and the uncertainty of the identifiable ones
  std::vector<ParameterEstimate> estimates{};               ///< in the order of `free`
  std::vector<StrongCorrelation> correlations{};            ///< the pairs that go together
  std::vector<UnidentifiableCombination> unidentifiable{};  ///< what the data leave free
  /// Root mean square of residual / standard deviation of the noise: near 1 for a right structure. Absent where the
  /// response has no variances.
  std::optional<double> misfit;
  /// What the structure leaves unexplained beyond the noise, as a share of |P_i|: e in variance_i + e^2 |P_i|^2. 0
  /// where the noise explains the residuals.
  double model_error = 0.0;
  std::vector<double> frequencies{};              ///< of the points used, rad/s
  std::vector<std::complex<double>> fitted{};     ///< the model there
  std::vector<std::complex<double>> residuals{};  ///< measured - fitted
  std::vector<Remark> remarks{};                  ///< of what the data leave open
  bool settled = true;  ///< the search came to rest; false: it was stopped while still improving
};

/// The parameters that ParameterFitOptions::free means when it is empty.
[[nodiscard]] std::vector<std::string> fittable_parameters(const Device& structure,
                                                           const std::vector<std::string>& locked = {});

/// Whether ParameterFitOptions::free leaves the choice to the library: it is empty, or "all" stands in it.
[[nodiscard]] bool frees_all(const std::vector<std::string>& free);

/// The keys of ParameterFitOptions::free in full, "all" written out.
[[nodiscard]] std::vector<std::string> free_parameters(const Device& structure, const std::vector<std::string>& free,
                                                       const std::vector<std::string>& locked = {});

/// Fits a device to a measured response by weighted complex least squares.
///
///     min over p  sum_i rho( |P_i - P(p; e^{j w_i T})|^2 / (variance_i + e^2 |P_i|^2) )
///
/// where P is the exact sampled plant of the record's own period (hold, delay and lag included), or the continuous
/// G(jw) e^{-jw t_d} of a table. e is the least model error for which the median residual is what it should be (0 where
/// the noise explains it; the whole weight where variances are unknown), so that friction or a missing mode is not
/// mistaken for information. The covariance is that of the normal equations at the solution, widened where residuals of
/// neighbouring points are correlated or larger than their deviations. Parameters that may be 0 are bounded there. The
/// fitted device's sampling_period is the structure's.
///
/// It is linear, and judges nothing: what moves the device beside its linear equations stands in the numbers. identify()
/// begins its search there. Requires a device of bodies, known keys and names, an actuated and a sensed body that are not
/// locked, 1 to max_free_parameters free ones and more points than that; throws Error (invalid_argument, no_such_body)
/// otherwise, (did_not_converge) when the fit does not. Source: Díaz & Gil, section II (locked device, chirp); Pintelon &
/// Schoukens, System Identification, ch. 9.
[[nodiscard]] ParameterFit fit_parameters(const Device& structure, const FrequencyResponse& response,
                                          const ParameterFitOptions& options = {});

/// The device as it is with these bodies held still: a link to one becomes stiffness and damping to ground.
/// Throws Error (invalid_argument) where the actuated or the sensed body is among them.
[[nodiscard]] Device locked_device(const Device& device, const std::vector<std::size_t>& locked);

}  // namespace zwidth
