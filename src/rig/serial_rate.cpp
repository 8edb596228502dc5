#include "zwidth/rig/serial_rate.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace zwidth {
namespace {

constexpr double bits_per_byte = 10.0;  // with start and stop bit
constexpr std::array<double, 7> usual_bauds{230400, 460800, 921600, 1000000, 2000000, 3000000, 4000000};

}  // namespace

double serial_rate(double bytes, double baud) { return baud / (bits_per_byte * bytes); }

std::optional<OptionProblem> find_problem(const SerialLoad& load) {
  const double carried = serial_share_of_cycle * serial_rate(load.bytes_per_cycle, load.baud);
  const double wanted = 1.0 / load.sampling_period;
  if (wanted <= carried) return std::nullopt;
  Problem problem{.code = ProblemCode::serial_line_too_slow,
                  .evidence = {{"bytes", load.bytes_per_cycle},
                               {"baud", load.baud},
                               {"carried_hz", std::floor(carried)},
                               {"wanted_hz", wanted},
                               {"period", std::ceil(1e4 / carried) * 1e-4}}};
  for (const double baud : usual_bauds) {
    if (wanted > serial_share_of_cycle * serial_rate(load.bytes_per_cycle, baud)) continue;
    problem.evidence.push_back({"sufficient_baud", baud});
    break;
  }
  return option_problem("sampling_period", std::move(problem));
}

}  // namespace zwidth
