#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "io/byte_order.hpp"
#include "zwidth/io/input_error.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::internal {

/// Function types of a record (field 1 of its sixth line).
inline constexpr int uff_unknown_function = 0;
inline constexpr int uff_time_response = 1;
inline constexpr int uff_frequency_response = 4;
inline constexpr int uff_coherence = 6;

/// Specific data types of an axis.
inline constexpr int uff_displacement = 8;
inline constexpr int uff_velocity = 11;
inline constexpr int uff_acceleration = 12;
inline constexpr int uff_time = 17;
inline constexpr int uff_frequency = 18;

struct UffAxis {
  int quantity = 0;   ///< specific data type; 0: unknown
  std::string label;  ///< empty where the file says NONE
  std::string unit;
};

/// Where a function was measured: a node of the structure and a direction of it.
struct UffPoint {
  std::string entity;  ///< empty where the file says NONE
  long node = 0;
  int direction = 0;  ///< 0 scalar; 1 2 3 +X +Y +Z, 4 5 6 rotations about them; negative: against them
};

/// One function: dataset 58 (text) or 58b (binary). Its numbers stay in the file's bytes.
struct UffRecord {
  std::size_t line = 0;  ///< of its first line in the file
  std::array<std::string, 5> id_lines;
  int function_type = 0;
  UffPoint response;
  UffPoint reference;
  bool is_complex = false;
  bool is_double = false;
  bool is_even = true;     ///< abscissa from `first` by `step`; else a value of it stands before each ordinate
  std::size_t points = 0;  ///< as the header says
  double first = 0.0;
  double step = 0.0;
  UffAxis abscissa;
  UffAxis ordinate;
  UffAxis denominator;
  std::optional<ByteOrder> binary;  ///< absent: text
  bool single_abscissa = false;     ///< binary: abscissae in single precision before ordinates in double
  std::size_t data_line = 0;        ///< first line of the numbers
  std::size_t data_begin = 0;       ///< bytes of the numbers
  std::size_t data_end = 0;
};

/// A universal file: its bytes and the functions in it.
struct UffFile {
  std::string source;
  std::string bytes;
  std::vector<UffRecord> records;
  std::vector<Remark> remarks;  ///< what was passed over
};

/// Reads a universal file and finds its functions. Datasets other than 58 are passed over with a remark.
/// Refused, with the line: text that is no universal file, a header that makes no sense, binary data of another length
/// than the header says, a file without a function or larger than 2 GiB.
/// Source: Universal Dataset Number 58, Function at Nodal DOF (SDRC, revision of 30 June 1999); The Binary 58 Universal
/// File Format (UC-SDRL).
[[nodiscard]] tl::expected<UffFile, InputError> read_uff_file(const std::string& path, const Progress& progress);

/// The same of bytes that are already there.
[[nodiscard]] tl::expected<UffFile, InputError> parse_uff(std::string bytes, const std::string& source);

}  // namespace zwidth::internal
