#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/analysed_device.hpp"
#include "report/bode_points.hpp"
#include "report/figure/bode_figure.hpp"
#include "results/json.hpp"

namespace zwidth::report {

struct BodeOptions {
  std::optional<double> from;  ///< rad/s; absent: below everything that matters
  std::optional<double> to;    ///< rad/s; absent: Nyquist
  std::size_t points = 400;    ///< even on the logarithmic axis; more are added where a curve bends
};

/// The two frequency responses of a device, at the same frequencies.
struct DeviceBode {
  std::vector<BodePoint> continuous;  ///< G, the virtual damper and the delay left out
  std::vector<BodePoint>
      sampled;  ///< Z[H G e^{-t_d s}] through the wall's filters, its virtual damper closed; to Nyquist
};

[[nodiscard]] FrequencyRange bode_range(std::span<const AnalysedDevice> devices, const BodeOptions& options);

[[nodiscard]] DeviceBode device_bode(const AnalysedDevice& analysed, FrequencyRange range, std::size_t points);

/// One device: sampled and continuous response; up to most_curves devices: the sampled ones. Every crossover is marked.
[[nodiscard]] BodeFigure device_bode_figure(std::span<const AnalysedDevice> devices, const BodeOptions& options);

/// "frequency_rad_s,frequency_hz,magnitude_db,phase_deg,continuous_magnitude_db,continuous_phase_deg": the sampled
/// response first. A cell above Nyquist is empty. Numbers carry 17 significant digits.
[[nodiscard]] std::string bode_csv(const AnalysedDevice& analysed, const BodeOptions& options);

/// The same numbers with every crossover, schema "zwidth.bode/1".
[[nodiscard]] results::Json bode_json(const AnalysedDevice& analysed, const BodeOptions& options);

}  // namespace zwidth::report
