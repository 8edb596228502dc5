#include "results/region_csv.hpp"

#include <fmt/format.h>

#include <iterator>

#include "results/region_json.hpp"

namespace zwidth::results {
namespace {

void append_ring(std::string& rows, const BoundaryRing& ring, std::size_t component) {
  for (const BoundaryArc& arc : ring.arcs) {
    for (const BoundaryPoint& point : arc.points) {
      fmt::format_to(std::back_inserter(rows), "{},{},{:.17g},{:.17g},{},{}\n", component, name_of(arc.kind),
                     point.stiffness, point.damping, point.frequency ? fmt::format("{:.17g}", *point.frequency) : "",
                     point.limited_by ? fmt::format("{}", point.limited_by->mode) : "");
    }
  }
}

std::vector<double> middles(double largest, std::size_t count) {
  constexpr double beyond = 1.1;
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = beyond * largest * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  }
  return values;
}

}  // namespace

std::string region_csv(const StableRegion& region) {
  std::string rows = "component,boundary,stiffness,damping,frequency_rad_s,mode\n";
  for (std::size_t i = 0; i < region.components.size(); ++i) {
    append_ring(rows, region.components[i].outline, i + 1);
  }
  return rows;
}

std::string region_raster_csv(const WallRegion& walls, std::size_t count) {
  std::string rows = "stiffness,damping,stable\n";
  if (!walls.walls || !walls.region.stiffest) return rows;
  const std::vector<double> stiffnesses = middles(walls.region.stiffest->stiffness, count);
  const std::vector<double> dampings = middles(walls.region.most_damped->damping, count);
  const std::vector<std::uint8_t> stable = stable_on_grid(*walls.walls, stiffnesses, dampings);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      fmt::format_to(std::back_inserter(rows), "{:.17g},{:.17g},{}\n", stiffnesses[j], dampings[i],
                     stable[i * count + j]);
    }
  }
  return rows;
}

}  // namespace zwidth::results
