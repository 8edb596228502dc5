#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "identification/shot_model.hpp"

namespace zwidth::internal {

/// What is left of a record's positions, as a filter that makes it white: e[k] = sum_j filter[j] r[k - j] / deviation.
struct ShotNoise {
  std::vector<double> filter = {1.0};
  double deviation = 1.0;
};

/// An autoregression of the residuals of all shots of each record, by least squares (Hannan & Deistler 1988, ch. 5).
///
/// Motion that a disturbance makes is the device's own response, measurement noise is white: the filter holds both, so
/// that the fit weighs each frequency by its noise, drift included. The deviation is that of the filtered residuals, at
/// least that of an encoder's rounding, step / sqrt(12), through the filter.
[[nodiscard]] std::vector<ShotNoise> shot_noise(const std::vector<Shot>& shots, const ShotPositions& residuals,
                                                const std::vector<double>& steps, std::size_t order);

/// The filtered rows of a shot: as many as it has samples, less the filter's order.
[[nodiscard]] Eigen::MatrixXd whitened(const ShotNoise& noise, const Eigen::MatrixXd& columns);

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
