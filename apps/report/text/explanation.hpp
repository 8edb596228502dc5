#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/analysed_device.hpp"

namespace zwidth::report {

// The sentences of an answer, for an engineer who knows mechanics. Plain text, one paragraph each, shared by the text
// and the HTML report. Texts from the device file appear as they are: escape them for the medium.

/// The device's name, or "(unnamed device)" where it is empty.
[[nodiscard]] std::string display_name(const Device& device);

/// "the rigid body", "vibration mode 1 (37.1 Hz, damping ratio 0.03)".
[[nodiscard]] std::string oscillator_name(const Analysis& analysis, const Oscillator& oscillator);

/// What limits the wall, with its cause: the mechanism and the delay that turns it unstable.
/// Nothing unless the critical stiffness is finite.
[[nodiscard]] std::optional<std::string> what_limits(const AnalysedDevice& analysed);

/// The same of an oscillation at this frequency, rad/s, whose mechanism has this name.
[[nodiscard]] std::string what_turns_unstable(const Device& device, const std::string& oscillator, double frequency);

/// The device with nobody holding; without an [operator], as it is.
[[nodiscard]] AnalysedDevice with_nobody_holding(const AnalysedDevice& analysed);

/// "8.849 kN/m", "none: no wall is stable", "unbounded".
[[nodiscard]] std::string critical_stiffness_text(const CriticalStiffness& critical, Motion motion);

/// "8.7 kN/m to 9.1 kN/m, ...": what the uncertainty of the parameters makes of it. Nothing without an uncertainty.
[[nodiscard]] std::optional<std::string> interval_note(const AnalysedDevice& analysed);

/// "5.776 kN/m, worst at 41.4 Hz": the limit over all passive users; or that there are too many bodies. Nothing for a
/// transfer function.
[[nodiscard]] std::optional<std::string> absolute_stability_note(const AnalysedDevice& analysed);

/// "a spring of 362.5 kN/m: unstable from 5.776 kN/m, 2.3 ppm above the limit": who proves that limit tight. Nothing
/// where it was not asked for.
[[nodiscard]] std::optional<std::string> worst_user_note(const AnalysedDevice& analysed);

/// "8.829 kN/m, least with 0 kg, 0 N s/m, 1 kN/m ...": what the users of a family leave, and the ranges that were
/// asked for. Nothing where it was not asked for.
[[nodiscard]] std::optional<std::string> user_family_note(const AnalysedDevice& analysed);

/// What the critical stiffness means for a wall, and every stable interval where there is more than one.
[[nodiscard]] std::string meaning(const AnalysedDevice& analysed);

/// How far off a rigid model is, and on which side. Nothing where there is no rigid model or the device is one.
[[nodiscard]] std::optional<std::string> rigid_model_note(const AnalysedDevice& analysed, const Detail& detail = {});

/// Q and its plain meaning, its approximation stated. Nothing unless the device has two bodies, and its mode matters or
/// formulas are asked for.
[[nodiscard]] std::optional<std::string> q_criterion_note(const AnalysedDevice& analysed, const Detail& detail = {});

/// What the encoder does to the wall's force, and friction about it where that formula holds or formulas are asked for,
/// one phrase each.
[[nodiscard]] std::vector<std::string> encoder_notes(const AnalysedDevice& analysed, const Detail& detail = {});

/// What the numbers leave out: user, friction, encoder steps, force limit.
[[nodiscard]] std::vector<std::string> caveats(const AnalysedDevice& analysed);

}  // namespace zwidth::report
