#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "identification/evidence/likelihood_term.hpp"
#include "identification/evidence/noise.hpp"
#include "identification/model/motion_model.hpp"

namespace zwidth::internal {

/// The records in segments. Its own elements: each segment's state. Residuals: played less recorded, whitened.
class TimeEvidence : public LikelihoodTerm {
 public:
  TimeEvidence(const MotionModel& model, std::vector<Segment> segments, std::vector<double> encoder_steps,
               Eigen::Index noise_order);

  [[nodiscard]] Eigen::VectorXd own_lowest() const override;
  /// The states of the record.
  [[nodiscard]] Eigen::VectorXd own_start(const Eigen::VectorXd& x) const override;
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const override;
  [[nodiscard]] bool add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& own, Eigen::Index first,
                                 Picture& sum) const override;

  [[nodiscard]] Eigen::Index numbers() const { return static_cast<Eigen::Index>(model_.numbers().size()); }
  [[nodiscard]] const MotionModel& model() const noexcept { return model_; }
  [[nodiscard]] const std::vector<Segment>& segments() const noexcept { return segments_; }
  [[nodiscard]] const std::vector<Noise>& noise() const noexcept { return noise_; }
  /// Of each record, m or rad.
  [[nodiscard]] const std::vector<double>& encoder_steps() const noexcept { return steps_; }
  void set_noise(std::vector<Noise> noise) { noise_ = std::move(noise); }

  /// Played less recorded, by segment.
  [[nodiscard]] std::optional<std::vector<Eigen::VectorXd>> residuals(const Eigen::VectorXd& x,
                                                                      const Eigen::VectorXd& own) const;
  /// The noise that the residuals there have.
  [[nodiscard]] std::optional<std::vector<Noise>> noise_at(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const;

 private:
  [[nodiscard]] std::optional<std::vector<PlayedSegment>> play(const Eigen::VectorXd& x, const Eigen::VectorXd& own,
                                                               bool with_slopes) const;
  [[nodiscard]] Eigen::Map<const Eigen::VectorXd> recorded(const Segment& segment) const;

  const MotionModel& model_;
  std::vector<Segment> segments_;
  std::vector<double> steps_;
  Eigen::Index order_;
  std::vector<Noise> noise_;
};

}  // namespace zwidth::internal
