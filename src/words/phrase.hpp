#pragma once

#include <span>
#include <string>
#include <string_view>

#include "zwidth/finding.hpp"

namespace zwidth::internal {

// The sentence of a code. In braces the name of an evidence or a subject:
//     {stiffness}         with its unit and prefix, quantity(); without a unit four digits, number(); a subject as it is
//     {stiffness:.6g}     as fmt prints a double
//     {rows:n}            a whole number
//     {error:x}           the same in hexadecimal, with 0x
//     {rows:s}            nothing for 1, else the "s" of a plural
//     {after:time}        a time in s, ms or us
//     {share:percent}     percent(), with its sign
//     {share:%}           100 times it, whole, without the sign; {share:%.1f} as fmt prints 100 times it
//     {promised:limit}    as {promised}; "every stiffness" where it is no number
//     {value:exact}       as it is, with all its digits
//     {key}               the finding's key, where no evidence or subject is called so; {?key|...} does not see it
//     {measure:of}        of a subject "force": "a force in N or N m"
//     {gain:gain}         as {gain}; of a damping without a prefix
//     {?cells|of {cells:n}}  the text behind the bar where the finding holds `cells`; {!cells|...} where it does not
//     {?gaps=1|one gap}      where it holds `gaps` and that is 1 (a subject: the same text); {!gaps=1|...} elsewhere
struct Phrase {
  FindingCode code{};
  const char* name = "";
  // That is made of it: a doubt may be a remark too, and a refusal of a part a doubt.
  Finding::Severity worst = Finding::Severity::note;
  const char* what = "";
  const char* consequence = "";
  const char* remedy = "";
};

// A subject that stands ahead of every sentence: which one of several recordings shows it.
inline constexpr std::string_view of_recording = "of_recording";
// The same: who holds the device that it is said of.
inline constexpr std::string_view of_holder = "of_holder";

// A phrase with what stands in its braces.
[[nodiscard]] std::string filled_in(const Finding& finding, std::string_view phrase);

// By the room that finds them.
[[nodiscard]] std::span<const Phrase> model_phrases();
[[nodiscard]] std::span<const Phrase> stability_phrases();
[[nodiscard]] std::span<const Phrase> design_phrases();
[[nodiscard]] std::span<const Phrase> design_reason_phrases();
[[nodiscard]] std::span<const Phrase> study_phrases();
[[nodiscard]] std::span<const Phrase> simulation_phrases();
[[nodiscard]] std::span<const Phrase> relay_phrases();  // of simulation: reasons
[[nodiscard]] std::span<const Phrase> rig_phrases();
[[nodiscard]] std::span<const Phrase> signal_phrases();
[[nodiscard]] std::span<const Phrase> io_phrases();
[[nodiscard]] std::span<const Phrase> response_phrases();  // of identification: excitation, records, responses
[[nodiscard]] std::span<const Phrase> identification_phrases();

}  // namespace zwidth::internal
