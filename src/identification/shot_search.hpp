#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "identification/shot_fit.hpp"
#include "identification/shot_model.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The records cut into shots of about `length` s and at least `least` samples, the first after the forces on their way
/// at its start.
[[nodiscard]] std::vector<Shot> cut_into_shots(const std::vector<MotionRecord>& records, const Device& device,
                                               double length, std::size_t least);

/// A few of the shots of each record, spread over it.
[[nodiscard]] std::vector<Shot> some_of(const std::vector<Shot>& shots, std::size_t records, std::size_t each);

/// A fit with the noise that its residuals have.
struct FittedShots {
  ShotFit fit;
  std::vector<ShotNoise> noise;
};

/// Where a search begins, and what it has to be better by than others.
struct SearchStart {
  Eigen::VectorXd x;
  double handicap = 0.0;  ///< of the log-likelihood
};

/// What a search came to; `badness` with the handicap of its start.
struct SearchEnd {
  FittedShots fitted;
  double badness = 0.0;
};

/// The least bad, the first of equals; nothing of none.
[[nodiscard]] std::optional<FittedShots> least_bad(std::vector<std::optional<SearchEnd>> ends);

/// Looks for the parameters of a model, the noise unknown beforehand.
class ShotSearch {
 public:
  /// `steps`: of each record's encoder; `order`: of the autoregression that describes the noise.
  ShotSearch(const ShotModel& model, std::vector<double> steps, std::size_t order)
      : model_(model), steps_(std::move(steps)), order_(order) {}

  /// From each, side by side: as if the noise were white, what a linear fit does not tell from friction alone, then all
  /// under the noise of the residuals. With the states of the record, and with those fitted alone: of either some searches
  /// end in side minima, and the better one counts. In the order of the starts; each as if it were alone.
  [[nodiscard]] std::vector<std::optional<SearchEnd>> from_each(const std::vector<SearchStart>& starts,
                                                                const std::vector<Shot>& shots) const;

  /// Noise from the residuals, then a fit under that noise.
  [[nodiscard]] std::optional<FittedShots> with_noise(const ShotFit& start, const std::vector<Shot>& shots,
                                                      const Eigen::VectorXd& towards,
                                                      const ShotFitOptions& options) const;

  enum class Constants : std::uint8_t { held, fitted };
  /// x with states from the record that are fitted while the parameters stay, with or without the constant forces. Those of
  /// the record are a poor start where all is free at once: the parameters follow the states' error, and between kinks of
  /// friction they do not come back.
  [[nodiscard]] std::optional<ShotFit> with_fitted_states(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                                                          const std::vector<ShotNoise>& noise,
                                                          Constants constants) const;

  /// For each shot its states, or those found from the record again while the parameters stay: the better ones. By how
  /// much the log-likelihood grows.
  double restart_states(ShotFit& fit, const std::vector<Shot>& shots, const std::vector<ShotNoise>& noise) const;

  /// Log of the innovations' size, over all samples: what maximum likelihood makes small.
  [[nodiscard]] double badness(const FittedShots& fitted, const std::vector<Shot>& shots) const;

 private:
  enum class From : std::uint8_t { recorded_states, fitted_states };
  [[nodiscard]] std::optional<FittedShots> from(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                                                From from) const;

  const ShotModel& model_;
  std::vector<double> steps_;
  std::size_t order_;
};

}  // namespace zwidth::internal
