#include "results/relay_csv.hpp"

#include <fmt/format.h>

#include "results/csv.hpp"

namespace zwidth::results {

std::string relay_csv(const RelayResult& result) {
  Csv rows;
  rows.cell("time_s");
  for (std::size_t i = 1; i <= result.trials.size(); ++i) {
    rows.cell(fmt::format("force_{}", i));
    rows.cell(fmt::format("position_{}", i));
  }
  rows.end_row();
  const std::size_t samples = result.trials.empty() ? 0 : result.trials.front().force.size();
  for (std::size_t k = 0; k < samples; ++k) {
    rows.cell(Rounded{static_cast<double>(k) * result.sampling_period, 12});
    for (const RelayTrial& trial : result.trials) {
      rows.cell(trial.force[k]);
      rows.cell(trial.position[k]);
    }
    rows.end_row();
  }
  return rows.text();
}

}  // namespace zwidth::results
