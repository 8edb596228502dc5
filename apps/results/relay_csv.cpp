#include "results/relay_csv.hpp"

#include <fmt/format.h>

#include <iterator>

namespace zwidth::report {

std::string relay_csv(const RelayReport& report) {
  std::string rows = "time_s";
  for (std::size_t i = 1; i <= report.trials.size(); ++i) rows += fmt::format(",force_{0},position_{0}", i);
  rows += '\n';
  const std::size_t samples = report.trials.empty() ? 0 : report.trials.front().force.size();
  for (std::size_t k = 0; k < samples; ++k) {
    auto out = std::back_inserter(rows);
    fmt::format_to(out, "{:.12g}", static_cast<double>(k) * report.sampling_period);
    for (const RelayTrial& trial : report.trials) {
      fmt::format_to(out, ",{:.17g},{:.17g}", trial.force[k], trial.position[k]);
    }
    rows += '\n';
  }
  return rows;
}

}  // namespace zwidth::report
