#pragma once

#include <array>
#include <memory>
#include <optional>

#include "design/synthesis/worst_case_screening.hpp"
#include "zwidth/finding.hpp"

namespace zwidth::internal {

// What is left of a wall where the device may be another than the one that it was found for: by its uncertainty, and by
// the uncertainty of its modal frequencies that was asked for.
class WallLowering {
 public:
  // `device`: without its wall; both must outlive this.
  WallLowering(const Device& device, const RecommendationOptions& options) : device_(device), options_(options) {}

  struct Kept {
    double stiffness = 0.0;  // 0: none
    VirtualDamper damper;
    std::optional<WallBound> by;  // what has lowered it
    std::optional<Finding> why_none;
  };
  // No stiffer and no more damped than this one, with `notch` behind its filters. None where the notch lowers the limit
  // with any user at a modal shift.
  [[nodiscard]] Kept lowered(double stiffness, VirtualDamper damper, const std::optional<WallFilter>& notch,
                             WallGoal goal);

 private:
  [[nodiscard]] WorstCaseScreening& draws(const std::optional<WallFilter>& notch);
  [[nodiscard]] WorstCaseScreening& modal_shifts(const std::optional<WallFilter>& notch);

  const Device& device_;
  const RecommendationOptions& options_;
  std::array<std::unique_ptr<WorstCaseScreening>, 2> draws_;  // without and with the notch
  std::array<std::unique_ptr<WorstCaseScreening>, 2> modal_shifts_;
};

}  // namespace zwidth::internal
