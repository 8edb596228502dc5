#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// What is fitted to the motion itself.
struct TimeDomainOptions {
  /// Keys as in model/parameter.hpp. Empty, or "all" among them: what identify() frees, and the Coulomb friction of every
  /// body that moves.
  std::vector<std::string> free{};
  std::vector<std::string> locked{};  ///< bodies held still during the experiment, by name
  /// What the numbers of the structure stand for.
  IdentifyOptions::StructureValues structure_values = IdentifyOptions::StructureValues::known;
  /// Whether delay and lag are fitted too where frees_all(free), or the structure's taken as they are.
  IdentifyOptions::LoopDelay loop_delay = IdentifyOptions::LoopDelay::by_free;
  double segment = 10.0;         ///< s; each begins in a state of its own
  std::size_t noise_order = 24;  ///< of the autoregression that describes the noise; 0: white
};

/// Checks `segment` and `noise_order` by themselves.
[[nodiscard]] std::optional<OptionProblem> find_problem(const TimeDomainOptions& options);

/// A recording beside the motion of the fitted device.
struct FittedMotion {
  std::string source;                     ///< of the record: a file's name
  double sampling_period = 0.0;           ///< s
  double constant_force = 0.0;            ///< N or N m, beside the recorded one
  double constant_force_deviation = 0.0;  ///< one standard deviation
  double noise = 0.0;                     ///< m or rad, root mean square: what one sample has that those before do not
  double unexplained = 0.0;         ///< share of the linear response that the fitted device leaves, e of identify()
  double feedback = 0.0;            ///< how clearly the force answers to the noise; above 5 a controller made it
  std::vector<double> residuals{};  ///< recorded - fitted, by sample; 0 before the first segment
  std::vector<double> recorded{};   ///< position, m or rad, by sample
};

/// A device with dry friction identified from records, and the critical stiffness of its linear part.
struct TimeDomainIdentification {
  Device device;  ///< with its Coulomb friction and the uncertainty of all; its file keeps the verdict and the reasons
  std::vector<ParameterEstimate> estimates{};               ///< in the order of `free`
  std::vector<StrongCorrelation> correlations{};            ///< the pairs that go together
  std::vector<UnidentifiableCombination> unidentifiable{};  ///< what the data leave free
  std::vector<FittedMotion> motions{};                      ///< by recording
  double lowest = 0.0;                                      ///< rad/s, excited band of all recordings
  double highest = 0.0;                                     ///< rad/s, up to which the records excite the device
  double model_error = 0.0;                                 ///< the largest `unexplained` of the recordings
  bool settled = true;                                      ///< the search came to rest
  Analysis analysis = {};                                   ///< of the device, as analyze() gives it, without users
  StiffnessBasis basis = {};                                ///< of analysis.critical
  std::vector<Remark> remarks{};                            ///< what is worth knowing beside it
  Trust trust = {};                                         ///< of analysis.critical
};

/// Identifies a device with Coulomb friction from records of force and position.
///
///     min over p, x_s  sum over segments s, samples k  ( W (y[k] - y(p, x_s; t_k)) )^2
///
/// y(p, x_s; t): the exact motion of the device, stick and slip included, from the state x_s under the recorded force,
/// held over each sample, through delay and lag, and a constant force per recording. W: the autoregression that makes a
/// recording's residuals white, found in turn with p, so that drift and disturbances do not matter. Start: identify() of
/// the recording with the largest force, and several frictions. Covariance: of the least squares with the states
/// eliminated, widened for residuals that stay correlated (Newey & West 1987), the noise at least that of the encoder's
/// rounding. Several recordings of one device, best at two amplitudes: friction is what does not grow with the force.
///
/// Trust as identify()'s; doubtful also where the residuals are larger at reversals than elsewhere (the friction is not
/// Coulomb's), and where the force answers to the noise of the position (a record in feedback). Requires recordings of two channels (force, position) of at least 512 samples, a structure of bodies, and
/// what fit_parameters() does of names and keys. Throws Error (invalid_argument) otherwise and where
/// find_problem(options) finds one, (did_not_converge) where no start can be played. Source: Ljung, System
/// Identification, ch. 7; Bock 1983 (multiple shooting).
[[nodiscard]] TimeDomainIdentification identify_in_time(std::span<const Recording> recordings, const Device& structure,
                                                        const TimeDomainOptions& options = {},
                                                        const Progress& progress = {});

}  // namespace zwidth
