#pragma once

// Which poles share a term of the modal form, and what the term is called. Private to modal_form().

#include <cstddef>
#include <vector>

#include "model/drive_path.hpp"
#include "model/extended_precision.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

// What the grouping must know of the device beyond its poles.
struct PoleLabels {
  bool has_bodies = false;            // overdamped pairs are modes; of a transfer function they are not
  bool lowest_mode_is_rigid = false;  // springs to ground, not the links, carry the lowest mode
  bool has_dampers = false;           // of bodies: poles on the imaginary axis are so by structure, not by default
  std::size_t rigid_poles = 0;        // of coordinates: real ones of the motions that no spring holds
  double rigid_pole = 0.0;            // b/m of the whole device, to tell -b/m from the poles of overdamped modes
};

struct PoleGroup {
  std::vector<Complex<Extended>> poles;  // a complex group holds its half with positive imaginary part
  bool closed = true;                    // closed under conjugation; false: the conjugate half is implied
  bool cluster = false;                  // poles too close to treat one by one
  int mode = 0;                          // as ModalTerm::mode
};

// A pole whose damping ratio is smaller is undamped, but where the device's own dampers say what it is.
inline constexpr double undamped_below = 1e-14;

// Poles closer than this, relative to their magnitude, share a term.
inline constexpr double cluster_tolerance = 1e-4;

// Groups all poles: the rigid body's {0, -b/m} first, then modes by rising frequency; fills form.modes and
// form.suspended_rigid_body. `poles` are the non-zero ones, closed under conjugation to rounding; they come back with
// the ones at zero and, where they stand alone, with exact symmetry. Throws Error (did_not_converge) when they are not
// closed.
std::vector<PoleGroup> group_poles(std::vector<Complex<Extended>>& poles, std::size_t zero_roots,
                                   const PoleLabels& labels, ModalForm& form);

// Whether double-double leaves open what the structure of a device of bodies decides: whether a mode is damped at all,
// and which of several alike modes the path sees.
[[nodiscard]] bool asks_for_exact(const std::vector<Complex<Extended>>& poles, const PoleLabels& labels);

// Adds a real pole of the drive, so many times, as the last group of that mode, or to a real pole that it nearly coincides with.
struct DrivePole {
  Complex<Extended> at;
  std::size_t copies = 1;
  int mode = -1;  // as ModalTerm::mode
};
void add_drive_pole(std::vector<PoleGroup>& groups, const DrivePole& pole);

// Those of the actuator's lag and of the tracking, as far as there are any.
[[nodiscard]] std::vector<DrivePole> poles_of(const DrivePath& drive);

}  // namespace zwidth::internal
