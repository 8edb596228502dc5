// Any bytes, as a table of a frequency response: never a crash, always finite values at rising frequencies or a
// one-line error.
//
// Input: two bytes that choose the options, then the file.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "memory_file.hpp"
#include "zwidth/io/recording_file.hpp"

namespace {

zwidth::ResponseTableOptions options_of(std::uint8_t first, std::uint8_t second) {
  zwidth::ResponseTableOptions options;
  if (first & 1) options.frequency = "1";
  if (first & 2) options.magnitude = "2";
  if (first & 4) options.phase = "3";
  if (first & 8) options.real = "2";
  if (first & 16) options.imaginary = "im";
  if (first & 32) options.coherence = "4";
  if (first & 64) options.frequency_step = 0.5;
  if (first & 128) options.sampling_period = 1e-3;
  options.magnitude_in_db = (second & 1) != 0;
  options.phase_in_degrees = (second & 2) != 0;
  if (second & 4) options.frequency_scale = 1.0;
  if (second & 8) options.scale = -1e300;
  if (second & 16) options.file.format = zwidth::RecordingFormat::uff;
  if (second & 32) options.file.format = zwidth::RecordingFormat::text;
  if (second & 64) options.file.decimal_mark = ',';
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const zwidth::ResponseTableOptions options = options_of(data[0], data[1]);
  const MemoryFile file(data + 2, size - 2);
  const auto response = zwidth::read_response_table(file.path(), options);
  if (!response) {
    require_one_line(response.error());
    return 0;
  }
  require(response->points.size() >= 2 && response->sampling_period == options.sampling_period);
  double last = 0.0;
  for (const zwidth::ResponsePoint& point : response->points) {
    require(std::isfinite(point.frequency) && point.frequency > last);
    require(std::isfinite(point.value.real()) && std::isfinite(point.value.imag()));
    require(point.coherence >= 0.0 && point.coherence <= 1.0);
    last = point.frequency;
  }
  return 0;
}
