#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "identification/model/motion_terms.hpp"
#include "identification/model/number.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// What a record says of its own size, and who moves: what the priors are stated in.
struct RivalSetting {
  DeviceParameters start;           ///< as a linear fit has it
  std::vector<std::string> moving;  ///< bodies that are not locked, by name
  std::size_t records = 0;          ///< how many
  double sampling_period = 0.0;     ///< s
  double force = 0.0;               ///< N or N m, root mean square
  double speed = 0.0;               ///< m/s or rad/s, the largest
  double position = 0.0;            ///< m or rad, root mean square about its mean
  double damping = 0.0;             ///< N s/m or N m s/rad, of all bodies to the ground
  bool frees_lag = false;           ///< a lag may hide beside the delay
  bool frees_ground = false;        ///< the held body may be tied to the ground
};

/// Numbers of a fit and what they do.
struct ModelParts {
  std::vector<Number> numbers = {};  ///< those of the device first
  MotionTerms terms = {};
};

/// Adds everything that may explain a record in the linear device's stead, with what builders meet as its prior:
///
/// - a constant force in each record: 30 % of the force;
/// - Coulomb friction of each moving body: 10 % of the force, half-normal;
/// - drag c |v| v of each moving body, of either sign, so that friction which falls with speed is in it too: as much as the
///   damping at the largest speed;
/// - damping of the actuated body that drifts linearly over the record: 30 % of all damping;
/// - a dead band of the drive: 5 % of the force; a limit of the drive below the largest command: 10 %;
/// - a lag beside the delay: some sampling periods; a spring from the held body to the ground: a tenth of force over position.
///
/// Source: theory, section 10.
void add_rivals(const RivalSetting& setting, ModelParts& parts);

}  // namespace zwidth::internal
