#include "words/stated_quantity.hpp"

#include <fmt/format.h>

#include "zwidth/quantity.hpp"

namespace zwidth::internal {

std::string force_in_words(double force, std::string_view force_unit) {
  const bool is_stated = force_unit == "N" || force_unit == "N m";
  return fmt::format("{:.2g} {}", force, is_stated ? force_unit : "N (N m where it turns)");
}

std::string stiffness_in_words(double stiffness, std::string_view force_unit, std::string_view length_unit) {
  if (force_unit == "N" && length_unit == "m") return quantity(stiffness, "N/m");
  if (force_unit == "N m" && length_unit == "rad") return quantity(stiffness, "N m/rad");
  return fmt::format("{} (where it turns {})", quantity(stiffness, "N/m"), quantity(stiffness, "N m/rad"));
}

}  // namespace zwidth::internal
