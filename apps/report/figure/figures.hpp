#pragma once

#include <optional>
#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth {
struct Excitation;
struct MeasuredResponse;
struct NotchDesign;
struct NotchOptions;
struct ParameterSweep;
struct RelayResult;
struct RelayTrial;
struct RigLimit;
struct Simulation;
struct WallRegion;
struct Workspace;
namespace results {
struct FrfUnits;
}
}  // namespace zwidth

namespace zwidth::report {

struct AnalysedDevice;

// The figures of the commands, each in a file of its own. They throw OutputFailed as gnuplot does.

/// One parameter: K_CR over it, bold, with every branch of crossovers by the mechanism that it belongs to (points must
/// hold their crossovers) and the absolute stability limit dashed. Two: K_CR as a map of colours.
[[nodiscard]] std::string draw_sweep(const Device& device, const ParameterSweep& sweep, FigureFormat format);

/// Entitled by excitation_title(): the excitation over time (of many samples: its envelope) above its power density over
/// frequency.
[[nodiscard]] std::string draw_excitation(const Excitation& excitation, FigureFormat format);

/// Magnitude and phase with their 95 % bands, and coherence, over frequency, with every crossover marked and listed.
[[nodiscard]] std::string draw_frf(const MeasuredResponse& frf, const results::FrfUnits& units, FigureFormat format);

/// The stiffest wall over the modal shift, with and without; and the gain of the notch.
[[nodiscard]] std::string draw_notch(const Device& device, const NotchOptions& options, const NotchDesign& notch,
                                     FigureFormat format);

/// The stable walls, B to the right and K up, with those that no passive user destabilises and the formulas of the
/// literature; where these lie in a corner of the region, that corner beside it. `recommended`: a wall to mark. `one_rate`:
/// the region of the same device with both loops at the slower rate, whose boundary is drawn over it; none at one rate.
[[nodiscard]] std::string draw_region(const Device& device, const WallRegion& walls, FigureFormat format,
                                      const std::optional<Wall>& recommended = std::nullopt,
                                      const WallRegion* one_rate = nullptr);

/// Force and position of the end of one trial, over the same time: ten cycles of its oscillation, or all of the record
/// where there is none (Fig. 11 of Díaz & Gil).
[[nodiscard]] std::string draw_relay_record(const std::string& title, const RelayTrial& trial, double sampling_period,
                                            Motion motion, FigureFormat format);
/// The same of the first trial that oscillates, of the first one where none does.
[[nodiscard]] std::string draw_relay(const RelayResult& result, FigureFormat format);

/// How fast the oscillation after each impulse grew (above 0) or decayed, over the stiffness of the wall, with three of its
/// deviations; K_CR as measured and as predicted. Trials of which nothing was read are left out.
[[nodiscard]] std::string draw_limit_trials(const Device& device, const RigLimit& limit, FigureFormat format);

/// Positions (sensed and held body, the wall shaded) over forces (commanded, user's) against time, with the verdict.
/// Requires a kept trajectory.
[[nodiscard]] std::string draw_simulation_figure(const Device& device, const Simulation& result, FigureFormat format);

/// The axis of wall stiffness K: where the loop is stable, every crossover (numbered as in the Bode figure), and beside
/// them the rigid model's critical stiffness, Q and the wall, where there are such.
[[nodiscard]] std::string draw_stiffness_axis(const AnalysedDevice& analysed, FigureFormat format);

/// The least limit at every place of the tip, as colours, with any passive user where that is known; the worst pose marked
/// with its normal. Planar: a map, with the limit over directions at some poses. Spatial: seen along each axis of the world,
/// and every direction at the worst pose.
[[nodiscard]] std::string draw_workspace(const Device& device, const Workspace& workspace, FigureFormat format);

}  // namespace zwidth::report
