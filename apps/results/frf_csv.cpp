#include "results/frf_csv.hpp"

#include <fmt/format.h>

#include <numbers>
#include <optional>

#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

std::string cell(std::optional<double> value) { return value ? fmt::format("{:.17g}", *value) : ""; }

std::optional<double> degrees(std::optional<double> radians) {
  if (!radians) return std::nullopt;
  return *radians * 180.0 / std::numbers::pi;
}

}  // namespace

std::string frf_csv(const FrequencyResponse& response) {
  std::string rows =
      "frequency_rad_s,frequency_hz,magnitude,magnitude_lower,magnitude_upper,phase_deg,phase_lower_deg,"
      "phase_upper_deg,coherence,real,imaginary\n";
  const std::vector<ResponseLine> points = response_lines(response);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ResponseLine& point = points[i];
    const std::complex<double>& value = response.points[i].value;
    rows += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", cell(point.frequency), cell(hertz(point.frequency)),
                        cell(point.magnitude), cell(point.magnitude_lower), cell(point.magnitude_upper),
                        cell(degrees(point.phase)), cell(degrees(point.phase_lower)), cell(degrees(point.phase_upper)),
                        cell(point.coherence), cell(value.real()), cell(value.imag()));
  }
  return rows;
}

}  // namespace zwidth::report
