#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "identification/evidence/likelihood.hpp"
#include "identification/evidence/limit_evidence.hpp"
#include "identification/evidence/time_evidence.hpp"
#include "identification/motion_start.hpp"
#include "identification/optimiser/minimise.hpp"

namespace zwidth::internal {

/// What is measured beside the records, and who is told of the work.
struct BesideRecords {
  std::vector<MeasuredLimit> limits = {};
  std::function<void()> tell = {};  ///< at each step
};

/// The records in segments as a likelihood, and a search in it under the noise of what is left.
class RecordSearch {
 public:
  RecordSearch(const MotionModel& model, std::vector<Segment> segments, const MotionStart& start,
               const BesideRecords& beside);

  [[nodiscard]] const TimeEvidence& evidence() const { return *evidence_; }
  [[nodiscard]] std::unique_ptr<Likelihood> take_likelihood() { return std::move(all_); }
  [[nodiscard]] std::shared_ptr<TimeEvidence> take_evidence() { return std::move(evidence_); }

  /// White, of a few steps of the encoder or a hundredth of what the position changes in a sample: less than nearly all starts leave.
  void take_first_noise();
  void take_noise_of(const RecordSearch& other) { evidence_->set_noise(other.evidence_->noise()); }
  void set_noise(std::vector<Noise> noise) { evidence_->set_noise(std::move(noise)); }
  /// That of the residuals at z.
  [[nodiscard]] bool take_noise(const Eigen::VectorXd& z);
  /// Of all samples under the noise: the logarithm of what one has that those before do not. Maximum likelihood makes it small.
  [[nodiscard]] double innovations() const;

  /// These numbers, and segments' states that fit them: the records' own make a start that no number mends.
  [[nodiscard]] Eigen::VectorXd with_states(const Eigen::VectorXd& x) const;
  /// The numbers of an end of another search by the same model, and its states where segments begin alike.
  [[nodiscard]] Eigen::VectorXd carried_over(const RecordSearch& from, const Eigen::VectorXd& end) const;

  /// A minimum, then others under the noise of its residuals, `rounds` at most, until that stands still, or the minimum is one that
  /// is known. Nothing where none can be computed.
  [[nodiscard]] std::optional<Minimum> from(
      Eigen::VectorXd z, int rounds, MinimiseOptions options,
      const std::function<bool(const Minimum&)>& is_known = [](const Minimum&) { return false; });

 private:
  [[nodiscard]] double rows() const;

  const MotionModel& model_;
  std::vector<double> encoder_steps_;
  std::shared_ptr<TimeEvidence> evidence_;
  std::unique_ptr<Likelihood> all_;
};

/// RecordSearch::innovations() of such evidence.
[[nodiscard]] double innovations_of(const TimeEvidence& evidence);

}  // namespace zwidth::internal
