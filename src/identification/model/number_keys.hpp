#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace zwidth::internal {

// Keys of the numbers of rivals, which are none of a device: each says what it is of.

inline std::string friction_key(const std::string& body) { return "friction." + body; }
inline std::string link_friction_key(std::size_t link) { return "link_friction." + std::to_string(link); }
inline std::string link_presliding_key(std::size_t link) { return "link_presliding." + std::to_string(link); }
inline std::string drag_key(const std::string& body) { return "drag." + body; }
inline std::string constant_force_key(std::size_t record) { return "constant_force." + std::to_string(record); }

/// What stands behind the beginning of a key; nothing where it begins otherwise.
inline std::optional<std::string> behind(std::string_view beginning, std::string_view key) {
  if (!key.starts_with(beginning)) return std::nullopt;
  return std::string(key.substr(beginning.size()));
}

/// The link whose dry friction that is, by its index; nothing of another number.
inline std::optional<std::string> link_of_friction(std::string_view key) { return behind("link_friction.", key); }

/// The body whose dry friction that is; nothing of another number.
inline std::optional<std::string> body_of_friction(std::string_view key) { return behind("friction.", key); }

}  // namespace zwidth::internal
