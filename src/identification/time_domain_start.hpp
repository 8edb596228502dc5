#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/fit_model.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth::internal {

/// The critical stiffness of the linear fit of the same record.
struct LinearStiffness {
  double value = 0.0;
  double upper = 0.0;            ///< of its 95 % interval
  bool leaves_too_much = false;  ///< more than noise: friction, or something that the structure lacks
};

/// Where a fit in time begins.
struct TimeDomainStart {
  Device device;                  ///< from the linear fit of the recording with the largest force
  std::vector<std::string> free;  ///< keys in full
  double lowest = 0.0;            ///< rad/s: band of that recording's response
  double highest = 0.0;
  bool is_turned = false;                   ///< the position falls as the force rises
  bool may_be_late = false;                 ///< more than the structure says: the fit in time tells
  std::optional<LinearStiffness> linear{};  ///< unless that fit is refused
  std::vector<Remark> remarks{};
};

/// Throws Error as identify_in_time() does.
[[nodiscard]] TimeDomainStart time_domain_start(std::span<const Recording> recordings, const Device& structure,
                                                const TimeDomainOptions& options);

/// A device from which a search with friction begins.
struct FrictionStart {
  DeviceParameters device;
  /// To be beaten by this much of the log-likelihood, lest what does not show decide where the masses are.
  double handicap = 0.0;
};

/// The start with several frictions of the bodies whose friction is free; the dampings less what a linear fit takes the
/// friction for, sqrt(2/pi) F_c / s at a Gaussian velocity of deviation s. Then the same of alike_devices(), which a linear
/// fit does not tell from it.
[[nodiscard]] std::vector<FrictionStart> starting_frictions(const TimeDomainStart& start,
                                                            std::span<const Recording> recordings);

/// How each free parameter is searched: its unit is the start's value, or what it typically is.
[[nodiscard]] std::vector<Coordinate> time_domain_coordinates(const TimeDomainStart& start,
                                                              std::span<const Recording> recordings);

}  // namespace zwidth::internal
