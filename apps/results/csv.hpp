#pragma once

#include <fmt/format.h>

#include <concepts>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "zwidth/trust.hpp"

namespace zwidth::results {

/// A number with fewer digits than it has, where a column is made by rounding: {0.1 + 0.2, 9}.
struct Rounded {
  double value = 0.0;
  int digits = 17;
};

/// A number with as many digits as it takes to read back the same double: 0.001, not 0.001000000000000000021.
struct Shortest {
  double value = 0.0;
};

/// Comma-separated values: a header line, then rows of numbers with 17 significant digits (they read back to the same
/// double), integers and texts. What is absent or not finite is an empty cell.
class Csv {
 public:
  /// Keeps every row for text().
  explicit Csv(std::initializer_list<std::string_view> header) {
    for (const std::string_view name : header) cell(name);
    end_row();
  }
  /// Hands the rows to `sink` in pieces of about 64 kB; flush() the last one.
  Csv(std::function<void(std::string_view)> sink, std::initializer_list<std::string_view> header) : Csv(header) {
    sink_ = std::move(sink);
  }
  /// A header of the caller's own: cell() by cell(), then end_row().
  Csv() = default;

  void cell(double value) { cell(Rounded{value, 17}); }
  void cell(Rounded number);
  void cell(Shortest number);
  void cell(std::integral auto value) { fmt::format_to(next(), "{}", +value); }
  /// Quoted where it holds what would end a cell.
  void cell(std::string_view text);
  void cell(const char* text) { cell(std::string_view(text)); }
  void cell(const std::string& text) { cell(std::string_view(text)); }
  /// Its verdict: the last column, `trust`, of whatever states a limit or follows from one.
  void cell(const Trust& trust);
  template <typename T>
  void cell(const std::optional<T>& value) {
    if (value) {
      cell(*value);
    } else {
      cell(std::string_view());
    }
  }
  void end_row();

  template <typename... Cells>
  void row(const Cells&... cells) {
    (cell(cells), ...);
    end_row();
  }

  void flush();
  [[nodiscard]] std::string text() const { return fmt::to_string(rows_); }

 private:
  [[nodiscard]] std::back_insert_iterator<fmt::memory_buffer> next();

  fmt::memory_buffer rows_;
  bool begun_ = false;  ///< the row has a cell
  std::function<void(std::string_view)> sink_;
};

}  // namespace zwidth::results
