// Any bytes, as a MAT file: never a crash nor an allocation beyond what the file can hold, always finite channels of
// one size or a one-line error.
//
// Input: a byte that chooses the options, then the file.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "memory_file.hpp"
#include "zwidth/io/recording_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const MemoryFile file(data + 1, size - 1);
  zwidth::RecordingOptions options;
  options.format = zwidth::RecordingFormat::mat;
  const auto contents = zwidth::list_recording(file.path(), options);
  if (!contents) require_one_line(contents.error());

  options.columns = {{contents && (data[0] & 1) ? contents->columns.back().name : "1", -1e3}, {"x", 1.0}};
  if (data[0] & 2) options.columns.pop_back();
  if (data[0] & 4) options.rate = 1000.0;
  if (data[0] & 8) options.time_column = "2";
  const auto recording = zwidth::read_recording(file.path(), options);
  if (!recording) {
    require_one_line(recording.error());
    return 0;
  }
  require(contents.has_value());
  require(recording->channels.size() == options.columns.size() && recording->sampling_period > 0.0);
  for (const zwidth::Channel& channel : recording->channels) {
    require(channel.samples.size() == recording->channels.front().samples.size() && channel.samples.size() > 1);
    for (const double value : channel.samples) require(std::isfinite(value));
  }
  return 0;
}
