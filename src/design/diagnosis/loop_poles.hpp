#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "stability/second_route/scheduled_loop.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Eigenvalues of the loop with the device's wall, but that of a position that nothing holds. With two loops they are those over
// the longer period.
class LoopPoles {
 public:
  // `device`: its wall.stiffness is known.
  explicit LoopPoles(const Device& device);

  [[nodiscard]] bool is_stable() const;

  // Of the pole that is least stable, rad/s.
  [[nodiscard]] double critical_frequency() const;

  // Of the unstable pole nearest to this frequency, rad/s; nothing where none oscillates.
  [[nodiscard]] std::optional<double> unstable_frequency(double nearest_to) const;

 private:
  [[nodiscard]] double frequency_of(std::complex<double> delta) const;

  double period_ = 0.0;
  double stiffness_ = 0.0;
  std::optional<ScheduledLoop> two_loops_;
  std::vector<std::complex<double>> deltas_;  // z - 1
};

}  // namespace zwidth::internal
