#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// A force that hangs on the position or on the commanded force in no linear way: a sum of these, each of any size.
struct NonlinearForce {
  std::vector<std::vector<double>> terms;  ///< by sample
  bool is_of_command = false;              ///< acts where the actuator does; else where the position is sensed
  std::string what;                        ///< in words, with its likely cause
  std::string remedy;
};

inline constexpr const char* force_not_in_proportion_to_the_speed =
    "a force that is not in proportion to the speed: drag of air or of a fluid, an eddy-current brake, or friction "
    "that "
    "changes with the speed";
inline constexpr const char* friction_not_coulombs =
    "friction that is not Coulomb's as the motion turns: what rubs, or a cable, bends before it slips, or friction at "
    "rest is "
    "more";
inline constexpr const char* strong_motion_remedy = "excite more strongly: its share falls with the amplitude";
inline constexpr const char* slow_motion_remedy =
    "record it at the speeds that matter: slow motion is damped less, and its critical stiffness is lower";

/// How clearly a record shows such a force beside all that is linear.
struct NonlinearEvidence {
  double chi_squared = 0.0;  ///< less its degrees of freedom
  double share = 0.0;        ///< of the squares of what is left
};

/// What a linear device with dry friction does not do.
struct Nonlinearity {
  std::string what;  ///< in words, with its likely cause
  std::string remedy;
  NonlinearEvidence evidence;
};

/// The clearest of
///
///     cos and sin of 2 pi n x / range, n = 1..100 (each n by itself);   x^2 and x^3;   v |v|;   the part of the force
///     beyond 1/4, 1/2 and 3/4 of its largest
///
/// where chi-squared and the share explained are both beyond what records of linear devices show; nothing where none is.
[[nodiscard]] std::optional<Nonlinearity> clearest_nonlinearity(
    std::span<const double> position, std::span<const double> force, Motion motion,
    const std::function<NonlinearEvidence(const NonlinearForce&)>& evidence_of);

/// Orthonormal columns that span these less what the orthonormal linear ones have of them; fewer where nothing is left.
[[nodiscard]] Eigen::MatrixXd outside_linear_terms(Eigen::MatrixXd columns, const Eigen::MatrixXd& linear);

}  // namespace zwidth::internal
