#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "design/sensitivities/design_parameter.hpp"
#include "stability/users/absolute_stability_search.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// The limit of a device with one number moved, for many values of it. Of two loops the damper's period keeps its ratio to that of
// the spring.
class LimitAlongParameter {
 public:
  // All must outlive this.
  LimitAlongParameter(const Device& device, const DesignParameter& parameter, StiffnessGoal goal, WallNumber number)
      : device_(device), parameter_(parameter), goal_(goal), number_(number) {}

  struct Limit {
    double stiffness = 0.0;  // or the damping, of a damper alone
    bool is_bound = false;   // the limit is no higher; what it is was not asked
  };
  // What of the limit is worth knowing.
  struct Interest {
    double enough =
        0.0;  // a bound below this is as good: that of the device that nobody holds, or what some user does at
              // a frequency where users have set the limit at other values
    double most = std::numeric_limits<double>::infinity();  // stands for any limit that is higher
  };
  // Whether the limit is known beside the device's own value: that with any user of two loops depends on how their delays
  // differ.
  [[nodiscard]] bool is_known() const;

  // Why the limit of two loops, or that with any user, was last refused at a value that makes a device; nothing where it never was.
  [[nodiscard]] const std::optional<std::string>& refused_at() const { return refused_at_; }

  // The limit. Absent where the value makes no device, or its limit is not found.
  [[nodiscard]] std::optional<Limit> at(double value, const Interest& interest);

 private:
  [[nodiscard]] Limit of_damper(const Device& device, const Interest& interest) const;
  [[nodiscard]] std::optional<Limit> of_two_loops(const Device& device, const Interest& interest);
  // Nothing where it is not known.
  [[nodiscard]] std::optional<double> of_any_user(const Device& device, double enough, Limit& limit);

  const Device& device_;
  const DesignParameter& parameter_;
  StiffnessGoal goal_;
  WallNumber number_;
  std::optional<std::string> refused_at_;
  std::vector<double> angles_;  // where users have set the limit, rad per sample, the latest last
  std::unique_ptr<AbsoluteStabilitySearch>
      users_;  // of a number of the wall's damper, which the termination discs do not depend on
};

}  // namespace zwidth::internal
