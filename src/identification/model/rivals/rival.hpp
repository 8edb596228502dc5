#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identification/model/added_rival.hpp"
#include "identification/model/device_family.hpp"
#include "identification/model/motion_model.hpp"
#include "identification/model/motion_terms.hpp"
#include "identification/model/number.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// What the priors of rivals hang on: where the fit starts, and how far the records go.
struct RivalSetting {
  DeviceParameters device;          ///< of bodies
  std::vector<std::string> locked;  ///< bodies held still while the records were made
  double rms_force = 0.0;           ///< N or N m; > 0
  double rms_speed = 0.0;           ///< m/s or rad/s, of the sensed body; > 0
  double largest_speed = 0.0;       ///< m/s or rad/s; > 0
  double rms_position = 0.0;        ///< m or rad, about the mean; > 0
  double duration = 0.0;            ///< s, of the longest record
  double sampling_period = 0.0;     ///< s
  std::size_t records = 1;
  bool frees_lag = false;     ///< a lag may hide beside the delay
  bool has_one_size = false;  ///< has_one_size()
  /// m or rad, of each link whose bodies move, else 0: how far it stretches from one turn to the next, v^2/a of its rms speed and
  /// acceleration, in the linear device under the recorded force.
  std::vector<double> link_strokes = {};
};

/// Of records of such a device. Speeds are differences over 5 periods, which an encoder's steps hardly touch.
/// Requires a force and a motion in each.
[[nodiscard]] RivalSetting rival_setting(const DeviceParameters& device, const std::vector<std::string>& locked,
                                         std::span<const ForceMotionRecord> records);

/// Whether the force is 0 or of one size, but for a few samples: what a drive loses of it passes for another gain, which no record
/// shows.
[[nodiscard]] bool has_one_size(std::span<const ForceMotionRecord> records);

/// N s/m or N m s/rad: what all bodies' dampings come to, at least 2 % of the rms force over the rms speed.
[[nodiscard]] double typical_damping(const RivalSetting& setting);

/// Names of the bodies that move in the records.
[[nodiscard]] std::vector<std::string> moving_bodies_of(const RivalSetting& setting);

/// Name of the body that a hand holds; nothing where it stood still.
[[nodiscard]] std::optional<std::string> moving_held_body(const RivalSetting& setting);

/// N/m or N m/rad: the rms force over the rms position. A body on a stiffer spring had moved less.
[[nodiscard]] double typical_stiffness(const RivalSetting& setting);

/// Name of the body that the actuator pushes.
[[nodiscard]] const std::string& actuated_body(const RivalSetting& setting);

/// What a fit is made of: DeviceFamily takes the numbers, MotionModel the terms.
struct ModelParts {
  std::vector<Number> numbers = {};
  MotionTerms terms = {};

  [[nodiscard]] bool has(std::string_view key) const;
  /// The key of the number that is added.
  std::string add(Number number);
};

/// Another explanation of a record: what it adds to the linear device, and how large that is believed to be beforehand.
struct Rival {
  std::string_view code;  ///< stable: results name it
  /// Nothing where the setting rules it out, or the parts have its numbers.
  void (*add)(const RivalSetting& setting, ModelParts& parts);
  RivalMeasure measure = RivalMeasure::force;  ///< of its numbers
  bool is_linear = false;                      ///< a response shows it too
};

}  // namespace zwidth::internal
