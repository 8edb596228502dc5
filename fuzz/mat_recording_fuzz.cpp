// Any bytes, as a MAT file: never a crash nor an allocation beyond what the file can hold, always finite channels of
// one size or a one-line error.
//
// Input: a byte that chooses the options, then the file.
#include <cstddef>
#include <cstdint>

#include "recording_checks.hpp"

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
  check_recording(file.path(), options, contents.has_value());
  return 0;
}
