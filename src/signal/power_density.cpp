#include "zwidth/signal/power_density.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>

#include "signal/fourier.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;

PowerDensity power_density(std::span<const double> signal, double rate) {
  const bool finite = std::all_of(signal.begin(), signal.end(), [](double value) { return std::isfinite(value); });
  if (signal.size() < 2 || !finite || !(std::isfinite(rate) && rate > 0.0)) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::power_density_not_possible});
  }
  constexpr std::size_t longest_block = std::size_t{1} << 20;
  const std::size_t block = std::min(signal.size(), longest_block);
  const std::size_t blocks = signal.size() / block;
  const auto n = static_cast<double>(block);
  PowerDensity density{rate / n, std::vector<double>(block / 2 + 1, 0.0)};
  for (std::size_t i = 0; i < blocks; ++i) {
    const auto lines = spectrum(signal.subspan(i * block, block));
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const double sides = k == 0 || 2 * k == block ? 1.0 : 2.0;
      density.values[k] += sides * std::norm(lines[k]) / (rate * n * static_cast<double>(blocks));
    }
  }
  return density;
}

}  // namespace zwidth
