#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "identification/response/line_regression.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

/// Samples of a record, and which lines of their spectrum count.
struct RestPart {
  std::size_t first = 0;
  std::size_t count = 0;
  LineBand band;
};

/// What a fit leaves of a record, on lines of the spectra of its parts, and what everything that is known to move would change
/// of that.
struct RestLines {
  Eigen::MatrixXcd known;
  Eigen::VectorXcd target;
  std::vector<RestPart> parts;                                     ///< in the order of time; none begins in another
  std::vector<Eigen::Index> stretches;                             ///< rows of each part
  Eigen::VectorXcd filter;                                         ///< of each row: what whitens the motion there
  std::function<Eigen::VectorXcd(std::span<const double>)> lines;  ///< of a motion, by sample of the whole record
};

/// Where to look for it.
struct ModeQuestion {
  std::span<const double> force;
  double sampling_period = 0.0;  ///< s
  double delay = 0.0;            ///< s, from the force to the motion
  double lowest = 0.0;           ///< rad/s
  double highest = 0.0;
};

/// (a + b s) / (s^2 + 2 zeta w s + w^2) from the force to the position, beside a fit.
struct ModeBeside {
  double frequency = 0.0;  ///< w, rad/s
  double damping_ratio = 0.0;
  ModalTerm term;
  double ratio = 0.0;    ///< its size in deviations, of positions or of accelerations: the smaller one
  double peak = 0.0;     ///< of its motion in the record
  LineRegression found;  ///< the known columns, then the mode's two
};

/// The mode that explains most of what is left, of any frequency in the band: a frame that shakes, a body that the structure
/// lacks. A narrow one does not show in a response of which the lines lie farther apart than it is wide, and noise that is
/// predicted from its past takes it up; here each line counts, and a mode rings on from part to part. Nothing where no mode
/// explains anything.
[[nodiscard]] std::optional<ModeBeside> find_missing_mode(const RestLines& rest, const ModeQuestion& question);

/// How large it is where it is largest, of the device's response there.
[[nodiscard]] double share_of(const Device& device, const ModeBeside& mode);

/// K_CR of a device of which the response has that mode too; NaN where there is none.
[[nodiscard]] double stiffness_with(const Device& device, const ModeBeside& mode);

}  // namespace zwidth::internal
