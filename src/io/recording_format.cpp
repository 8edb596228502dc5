#include "io/recording_format.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "io/number_cell.hpp"

namespace zwidth::internal {
namespace {

using namespace std::string_view_literals;

/// MAT 5 has a text of 116 bytes, then a version 1.0 and "IM" or "MI"; MAT 7.3 is HDF5, mostly after such a text.
bool is_mat_5_or_7(std::string_view bytes) {
  constexpr std::string_view hdf5 = "\x89HDF\r\n\x1A\n";
  constexpr std::size_t byte_order = 126;
  if (bytes.starts_with("MATLAB 5.0 MAT-file"sv) || bytes.starts_with("MATLAB 7.3 MAT-file"sv)) return true;
  if (bytes.starts_with(hdf5) || (bytes.size() > 512 && bytes.substr(512).starts_with(hdf5))) return true;
  return bytes.size() >= 128 && (bytes.substr(byte_order - 2).starts_with("\x00\x01IM"sv) ||
                                 bytes.substr(byte_order - 2).starts_with("\x01\x00MI"sv));
}

/// MAT 4 has no text: five small integers (type, rows, columns, whether complex, length of the name), then the name.
bool is_mat_4(std::string_view bytes) {
  std::array<std::uint32_t, 5> header{};
  if (bytes.size() <= sizeof header) return false;
  std::memcpy(header.data(), bytes.data(), sizeof header);
  const bool small_type = header[0] <= 4052;  // 1000 (byte order) + 10 (precision) + 1 (matrix kind)
  const bool complex_flag = header[3] <= 1;
  const std::uint32_t length = header[4];  // with the zero at its end
  if (!small_type || !complex_flag || length < 2 || length > 64 || bytes.size() < sizeof header + length) return false;
  const std::string_view name = bytes.substr(sizeof header, length - 1);
  return bytes[sizeof header + length - 1] == '\0' &&
         std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
}

/// The first line that is not empty is -1 in six columns, the next the number of a dataset in six.
bool is_uff(std::string_view bytes) {
  const auto next_line = [&] {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    return line;
  };
  const auto without_end = [](std::string_view line) {
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  };
  std::string_view line;
  while (!bytes.empty() && trimmed(line = without_end(next_line())).empty()) {
  }
  if (!line.starts_with("    -1"sv) || !trimmed(line.substr(6)).empty()) return false;
  const std::string_view dataset = next_line().substr(0, 6);
  const std::string_view digits = trimmed(dataset);
  return dataset.size() == 6 && dataset.front() == ' ' && !digits.empty() &&
         std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

RecordingFormat format_of(std::string_view first_bytes) {
  if (is_mat_5_or_7(first_bytes) || is_mat_4(first_bytes)) return RecordingFormat::mat;
  return is_uff(first_bytes) ? RecordingFormat::uff : RecordingFormat::text;
}

}  // namespace zwidth::internal
