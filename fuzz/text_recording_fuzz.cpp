// Any bytes, as a text recording: never a crash, always finite channels of one size or a one-line error. A table's have
// a sample for each row; an export's columns may be longer than what they have in common.
//
// Input: two bytes that choose the options, then the file.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "memory_file.hpp"
#include "zwidth/io/recording_file.hpp"

namespace {

zwidth::RecordingOptions options_of(std::uint8_t first, std::uint8_t second) {
  using Header = zwidth::RecordingOptions::Header;
  zwidth::RecordingOptions options;
  options.format = zwidth::RecordingFormat::text;
  options.columns = {{first & 1 ? "2" : "F", 1.0}, {"1", -1e3}};
  if (first & 2) options.rate = 1000.0;
  if (first & 4) options.time_column = "1";
  if (first & 8) options.timer_bits = 16;
  if (first & 16) options.time_scale = 1e-6;
  options.header = first & 32 ? Header::present : first & 64 ? Header::absent : Header::detect;
  if (second & 1) options.delimiter = ",;\t "[(second >> 1) & 3];
  if (second & 8) options.decimal_mark = second & 16 ? ',' : '.';
  if (second & 32) options.comment = "";
  if (second & 64) options.skip_rows = 2;
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const zwidth::RecordingOptions options = options_of(data[0], data[1]);
  if (zwidth::find_problem(options)) return 0;  // of options, not of the file
  const MemoryFile file(data + 2, size - 2);
  const auto contents = zwidth::list_recording(file.path(), options);
  if (!contents) require_one_line(contents.error());
  const auto recording = zwidth::read_recording(file.path(), options);
  if (!recording) {
    require_one_line(recording.error());
    return 0;
  }
  require(contents.has_value() && !contents->columns.empty());
  require(recording->channels.size() == 2 && recording->sampling_period > 0.0);
  std::size_t rows = 0;
  for (const zwidth::RecordingColumn& column : contents->columns) rows = std::max(rows, column.size);
  const std::size_t samples = recording->channels.front().samples.size();
  require(samples > 0 && samples <= rows);
  for (const zwidth::Channel& channel : recording->channels) {
    require(channel.samples.size() == samples);
    for (const double value : channel.samples) require(std::isfinite(value));
    (void)zwidth::check_signal(channel, recording->sampling_period, zwidth::SignalRole::position);
  }
  return 0;
}
