#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {

/// How a limit K of the wall's stiffness answers to one number p of the device file.
struct Sensitivity {
  std::string key;     ///< as in model/parameter.hpp: "body.motor.mass", "loop.delay"
  double value = 0.0;  ///< p, in the unit of its key
  double slope = 0.0;  ///< dK/dp, N/m or N m/rad per unit of p
  std::optional<double>
      relative;  ///< p/K dK/dp: 0.5 says that +1 % of p gives +0.5 % of K; absent where p is 0 or an angle
};

/// The derivatives of K_CR with respect to every number that it depends on, by implicit differentiation at its
/// crossover: nothing is solved again.
///
/// On z = e^{j theta} the loop is critical where L(theta; p) = -1/(F P) - B v is real, and K is that value:
///
///     dK/dp = Re L_p - Im L_p Re L_theta / Im L_theta;    Re L_p at Nyquist and at z = 1, where theta stays
///
/// P_p comes from the Frechet derivative of the matrix exponential, for all parameters at once by its adjoint; L_p is
/// exact up to rounding: 1e-9 of K/p or better for T from 10 us to 10 ms.
/// By rising order of the device file: body.*, link.*, loop.sampling_period and delay, actuator.time_constant, sensor.tracking_bandwidth,
/// wall.damping, velocity_filter_hz (where there is one), wall.filter.*, operator.*. Left out: what K_CR does not
/// depend on (friction, force limit, encoder step, wall.stiffness). Where p is 0 the slope is that of growing p; so it
/// is for the delay of whole samples and the period of a transfer function of relative degree 1, which jump there.
/// Where the damper runs in a loop of its own (has_damper_loop()) loop.damper.delay is one of them, if the file gives it. The
/// ratio of the two periods is whole and has no derivative: loop.sampling_period is that of both, which keep their ratio, and
/// loop.damper.sampling_period is left out. There L_p is a difference, extrapolated until two agree: 1e-7 of K/p.
/// Of a mechanism also mechanism.* (springs of joints and numbers of tendons where they are not 0) and transmission.*; L_p and
/// L_theta are such differences of its response, for each of which it is put to its pose again: 1e-6 of K/p.
/// Empty where K_CR is 0 or unbounded. Throws Error (did_not_converge) as critical_stiffness() does.
/// Source: implicit function theorem; N. J. Higham, Functions of Matrices, SIAM 2008, section 3.2.
[[nodiscard]] std::vector<Sensitivity> stiffness_sensitivities(const Device& device);

/// The same for a crossover already found: `critical` is critical_stiffness() of filtered_plant(device) with the wall's
/// damper. Throws Error (invalid_argument) where its limit is not a crossover of that loop.
[[nodiscard]] std::vector<Sensitivity> stiffness_sensitivities(const Device& device, const CriticalStiffness& critical);

/// The derivatives of the limit over all passive users, absolute_stability_limit() with the wall's damper.
///
/// That limit is the least over frequency of K(theta; p) with |1 + C c_T| = |C| r_T; at the frequency of the least
/// value its slope is that of K alone (envelope theorem), and c_T and r_T are differentiated exactly, alias by alias.
/// Good to 1e-5 of K/p; to 1e-4 where the limit is reached below 3e-3 rad per sample: there each slope is held against
/// differences of the limit, and a parameter whose slope they do not confirm is left out. Without operator.*, which the
/// limit does not depend on. Where p is 0, and for the delay of whole samples, the slope is that of growing p: the
/// limit has a corner there. Empty where the limit is 0 or infinite. With a faster damper in a loop of its own the slopes are
/// those of differences at the frequency of the least value, its delay among them; a delay or period that leaves the limit unknown
/// has none, and all are left out where the limit is approached towards zero frequency. Those of a mechanism are differences
/// of any_grasp_limit(). Throws Error (needs_bodies) for a transfer function, (invalid_argument) where that limit is not known.
[[nodiscard]] std::vector<Sensitivity> absolute_stability_sensitivities(const Device& device);

/// The same for a limit already found.
[[nodiscard]] std::vector<Sensitivity> absolute_stability_sensitivities(const Device& device,
                                                                        const AbsoluteStabilityLimit& limit);

}  // namespace zwidth
