#include "results/simulation_csv.hpp"

#include "results/csv.hpp"

namespace zwidth::results {

std::string simulation_csv(const Device& device, const Simulation& result) {
  const Trajectory& kept = result.trajectory;
  Csv rows;
  for (const char* name : {"time_s", "measured", "command", "user_force"}) rows.cell(name);
  for (const Body& body : device.bodies()) {
    rows.cell(body.name + ".position");
    rows.cell(body.name + ".velocity");
  }
  if (!device.has_bodies()) rows.cell("position");
  rows.end_row();
  for (std::size_t k = 0; k < kept.time.size(); ++k) {
    for (const auto* column : {&kept.time, &kept.measured, &kept.command, &kept.user_force}) rows.cell((*column)[k]);
    for (std::size_t i = 0; i < kept.position.size(); ++i) {
      rows.cell(kept.position[i][k]);
      if (i < kept.velocity.size()) rows.cell(kept.velocity[i][k]);
    }
    rows.end_row();
  }
  return rows.text();
}

}  // namespace zwidth::results
