#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "zwidth/model/mechanism_file.hpp"

namespace zwidth::internal {

// A text of a mechanism that names no file but those given with it, by the name that they have there.
struct MechanismText {
  std::string name;  // "mechanism.xml", "included_1.xml"
  std::string text;
  // Name and text.
  bool operator==(const MechanismText&) const = default;
};

// The key that a mechanism's text comes by.
[[nodiscard]] inline const char* source_key(const MechanismFile& file) {
  return file.text.empty() ? "mechanism.file" : "mechanism.text";
}

inline constexpr std::size_t most_mechanism_bytes = std::size_t{1} << 20;
inline constexpr std::size_t most_mechanism_joints = 300;

// What MuJoCo reads of a mechanism: bodies, joints, tendons, motors and loops. First the file itself, then what it includes.
//
// Meshes, textures, cameras and the like are left out, and each element stands in its line. Links of URDF stay apart where
// joints fix them, and have the inertia that they state. Throws Error (invalid_argument) for what is no XML or too large;
// elements that make or load others; a body that has its mass of a mesh; and every path where the mechanism is a text.
[[nodiscard]] std::vector<MechanismText> mechanism_texts(const MechanismFile& file);

// Those texts as one, what is included in its place.
[[nodiscard]] std::string one_text(std::vector<MechanismText> texts);

}  // namespace zwidth::internal
