#pragma once

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace zwidth {

/// A function of a universal file to be written as the format's description has it.
struct UffFunction {
  std::array<std::string, 5> id_lines{"NONE", "NONE", "01-Jan-26 12:00:00", "NONE", "NONE"};
  int function_type = 1;
  std::string entity = "NONE";
  long node = 1;
  int direction = 3;
  int data_type = 4;  ///< 2, 4 real; 5, 6 complex; 4, 6 in double precision
  bool even = true;
  double first = 0.0;
  double step = 1e-3;
  std::vector<double> numbers;  ///< as they follow each other: abscissa (if uneven), real part, imaginary part
  int abscissa_quantity = 17;
  int ordinate_quantity = 8;
  std::string abscissa_unit = "s";
  std::string ordinate_unit = "m";

  [[nodiscard]] bool is_double() const { return data_type == 4 || data_type == 6; }
  [[nodiscard]] std::size_t per_point() const { return (data_type >= 5 ? 2U : 1U) + (even ? 0U : 1U); }
};

/// The eleven lines of header.
inline std::string uff_header(const UffFunction& function, std::string_view line_end) {
  std::string text;
  for (const std::string& line : function.id_lines) text += fmt::format("{:<80}{}", line, line_end);
  text += fmt::format("{:5}{:10}{:5}{:10} {:<10}{:10}{:4} {:<10}{:10}{:4}{}", function.function_type, 0, 0, 0,
                      function.entity, function.node, function.direction, "NONE", 0, 0, line_end);
  text += fmt::format("{:10}{:10}{:10}{:13.5E}{:13.5E}{:13.5E}{}", function.data_type,
                      function.numbers.size() / function.per_point(), function.even ? 1 : 0,
                      function.even ? function.first : 0.0, function.even ? function.step : 0.0, 0.0, line_end);
  const auto axis = [&](int quantity, std::string_view label, std::string_view unit) {
    text += fmt::format("{:10}{:5}{:5}{:5} {:<20} {:<20}{}", quantity, 0, 0, 0, label, unit, line_end);
  };
  axis(function.abscissa_quantity, "abscissa", function.abscissa_unit);
  axis(function.ordinate_quantity, "ordinate", function.ordinate_unit);
  axis(13, "force", "N");
  axis(0, "NONE", "NONE");
  return text;
}

/// The function as dataset 58: numbers in fields without blanks between them where they fill these.
inline std::string uff_text(const UffFunction& function, std::string_view line_end = "\n") {
  std::string text = fmt::format("{:6}{}{:6}{}", -1, line_end, 58, line_end) + uff_header(function, line_end);
  const std::size_t per_line = function.is_double() ? (function.even || function.per_point() == 2 ? 4U : 3U) : 6U;
  for (std::size_t i = 0; i < function.numbers.size(); ++i) {
    const bool single = !function.is_double() || (!function.even && i % function.per_point() == 0);
    text += single ? fmt::format("{:13.5E}", function.numbers[i]) : fmt::format("{:20.12E}", function.numbers[i]);
    if (i % per_line == per_line - 1 || i + 1 == function.numbers.size()) text += line_end;
  }
  return text + fmt::format("{:6}{}", -1, line_end);
}

enum class UffOrder { little = 1, big = 2 };

template <class T>
std::string uff_bytes(double number, UffOrder order) {
  const T value = static_cast<T>(number);
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  if ((order == UffOrder::little) != (std::endian::native == std::endian::little))
    bytes = {bytes.rbegin(), bytes.rend()};
  return bytes;
}

/// The function as dataset 58b. `single_abscissa`: abscissae in single precision before ordinates in double.
inline std::string uff_binary(const UffFunction& function, UffOrder order, bool single_abscissa = false) {
  std::string data;
  for (std::size_t i = 0; i < function.numbers.size(); ++i) {
    const bool single = !function.is_double() || (single_abscissa && !function.even && i % function.per_point() == 0);
    data += single ? uff_bytes<float>(function.numbers[i], order) : uff_bytes<double>(function.numbers[i], order);
  }
  return fmt::format("{:6}\n{:6}b{:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}\n", -1, 58, static_cast<int>(order), 2, 11,
                     data.size(), 0, 0, 0, 0) +
         uff_header(function, "\n") + data + fmt::format("{:6}\n", -1);
}

}  // namespace zwidth
