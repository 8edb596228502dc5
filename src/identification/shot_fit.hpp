#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "identification/shot_model.hpp"
#include "identification/shot_noise.hpp"

namespace zwidth::internal {

/// Filtered residuals (played less recorded) of the shots, and how they change.
struct ShotSlopes {
  std::vector<Eigen::VectorXd> residuals;
  std::vector<Eigen::MatrixXd> of_parameters;  ///< a column per element of x
  std::vector<Eigen::MatrixXd> of_states;      ///< a column per element of the shot's own state
};

/// As the model plays them; nothing where it cannot be played.
[[nodiscard]] std::optional<ShotSlopes> shot_slopes(const ShotModel& model, const std::vector<Shot>& shots,
                                                    const std::vector<ShotNoise>& noise, const Eigen::VectorXd& x,
                                                    const std::vector<Eigen::VectorXd>& states);

struct ShotFit {
  Eigen::VectorXd x;
  std::vector<Eigen::VectorXd> states;
  std::vector<bool> held = {};  ///< elements of x that stay (at 0, their bound); empty: none
  bool settled = false;         ///< false: the iterations ran out
};

/// min over x and the states  sum e^2 + a weak pull of masses and link stiffnesses (known to a factor of 28 beforehand)
/// towards `towards`, by Levenberg and Marquardt's method, the states eliminated (Ceres). Nothing where the model cannot
/// be played at the start. A trial is played until its misfit is above that of the point it starts from, which rejects
/// it whatever it would come to.
struct ShotFitOptions {
  int most_iterations = 30;
  double tolerance = 1e-6;
  bool holds_bounds = false;  ///< what comes to its bound stays there from then on
};
[[nodiscard]] std::optional<ShotFit> fit_shots(const ShotModel& model, const std::vector<Shot>& shots,
                                               const std::vector<ShotNoise>& noise, ShotFit start,
                                               const Eigen::VectorXd& towards, const ShotFitOptions& options);

/// Played less recorded, not filtered.
[[nodiscard]] std::optional<ShotPositions> shot_residuals(const ShotModel& model, const std::vector<Shot>& shots,
                                                          const Eigen::VectorXd& x,
                                                          const std::vector<Eigen::VectorXd>& states,
                                                          const PlayOn& play_on = {});

}  // namespace zwidth::internal
