#include "results/simulation_csv.hpp"

#include <fmt/format.h>

#include <iterator>

namespace zwidth::report {
namespace {

/// A header cell: quoted where it holds what would end it.
std::string header_cell(const std::string& name) {
  if (name.find_first_of(",\"\n\r;") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char each : name) {
    quoted += each;
    if (each == '"') quoted += each;
  }
  return quoted + "\"";
}

}  // namespace

std::string simulation_csv(const SimulatedLoop& loop) {
  const Trajectory& kept = loop.result.trajectory;
  std::string rows = "time_s,measured,command,user_force";
  if (loop.analysed.device.has_bodies()) {
    for (const Body& body : loop.analysed.device.bodies()) {
      rows += fmt::format(",{},{}", header_cell(body.name + ".position"), header_cell(body.name + ".velocity"));
    }
  } else {
    rows += ",position";
  }
  rows += '\n';
  for (std::size_t k = 0; k < kept.time.size(); ++k) {
    fmt::format_to(std::back_inserter(rows), "{:.17g},{:.17g},{:.17g},{:.17g}", kept.time[k], kept.measured[k],
                   kept.command[k], kept.user_force[k]);
    for (std::size_t i = 0; i < kept.position.size(); ++i) {
      fmt::format_to(std::back_inserter(rows), ",{:.17g}", kept.position[i][k]);
      if (i < kept.velocity.size()) fmt::format_to(std::back_inserter(rows), ",{:.17g}", kept.velocity[i][k]);
    }
    rows += '\n';
  }
  return rows;
}

}  // namespace zwidth::report
