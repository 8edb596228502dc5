#include "zwidth/rig/serial_rate.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

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
  OptionProblem problem;
  problem.member = "sampling_period";
  problem.what = fmt::format("{:.0f} bytes per cycle at {:.0f} Bd leave {:.0f} Hz at most, the loop runs at {:.0f} Hz",
                             load.bytes_per_cycle, load.baud, std::floor(carried), wanted);
  for (const double baud : usual_bauds) {
    if (wanted > serial_share_of_cycle * serial_rate(load.bytes_per_cycle, baud)) continue;
    problem.allowed = fmt::format("set the drive and driver.baud to {:.0f} or more, or ", baud);
    break;
  }
  const double period = std::ceil(1e4 / carried) * 1e-4;
  problem.allowed += fmt::format("loop.sampling_period to {:.4g} s or more", period);
  return problem;
}

}  // namespace zwidth
