#pragma once

#include <span>

#include "zwidth/finding_code.hpp"

namespace zwidth::internal {

// The sentence of a code. In braces the name of an evidence or a subject:
//     {stiffness}         with its unit and prefix, quantity(); without a unit four digits, number(); a subject as it is
//     {stiffness:.6g}     as fmt prints a double
//     {rows:n}            a whole number
//     {share:%}           100 times it, whole, without the sign; {share:%.1f} as fmt prints 100 times it
//     {share:percent}     "0.34 %", "12 %", "many times over"
//     {promised:limit}    as {promised}; "every stiffness" where it is no number
struct Phrase {
  FindingCode code;
  const char* name;
  const char* what;
  const char* consequence = "";
  const char* remedy = "";
};

// By the room that finds them.
[[nodiscard]] std::span<const Phrase> model_phrases();
[[nodiscard]] std::span<const Phrase> stability_phrases();
[[nodiscard]] std::span<const Phrase> design_phrases();
[[nodiscard]] std::span<const Phrase> study_phrases();
[[nodiscard]] std::span<const Phrase> simulation_phrases();
[[nodiscard]] std::span<const Phrase> rig_phrases();

}  // namespace zwidth::internal
