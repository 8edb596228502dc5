#pragma once

#include <optional>

#include "stability/users/termination_discs.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth::internal {

// The disc of the plant behind the wall's filters over all passive users, at one frequency: of a body that is held, or of the
// tip of a mechanism along its wall's normal, grasped in every direction.
class UserDiscs {
 public:
  // The device must be mechanical, and a mechanism's along one normal; its user is left out. Of a tip that moves along one
  // direction alone: as of a body.
  explicit UserDiscs(const Device& device, const Progress& progress = {});

  // 0 < frequency <= pi/T, rad/s.
  [[nodiscard]] TerminationDiscs::Disc at(double frequency) const;

  [[nodiscard]] bool is_undamped() const;

 private:
  std::optional<TerminationDiscs> held_;
  std::optional<GraspedPlant> grasped_;
  std::optional<FilteredPlant> plant_;  // of the filters that a grasped tip is behind
  double period_ = 0.0;
};

}  // namespace zwidth::internal
