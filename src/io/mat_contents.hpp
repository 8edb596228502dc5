#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/input_error.hpp"

namespace zwidth::internal {

/// A real numeric array of a MAT file, of one sample at least.
struct MatArray {
  std::string name;        ///< "force", "run.position", "run(2).position"
  std::string class_name;  ///< "double", "int16", "logical", ...
  std::size_t rows = 0;
  std::size_t columns = 0;
};

/// What of a MAT file is no MatArray.
struct SkippedMatArray {
  enum class Kind {
    object,       ///< a MATLAB object: table, timeseries, datetime, string, ...
    other_class,  ///< text, a cell array, a sparse array, a function handle
    complex,      ///< complex numbers
    no_table,     ///< empty, more than two dimensions, or more columns than a table of signals has
    damaged,      ///< its bytes contradict each other
  };
  std::string name;
  Kind kind = Kind::other_class;
  Problem why;  ///< as one that was asked for
};

/// It is "text", "a cell array", "empty", where an array of numbers is wanted: or what else the phrase names.
[[nodiscard]] Problem wrong_kind(std::string kind, std::string wanted = "array");

struct MatContents {
  std::vector<MatArray> arrays;
  std::vector<SkippedMatArray> skipped;

  void skip(std::string name, SkippedMatArray::Kind kind, Problem why);
  /// Adds an array, or skips it where it cannot hold signals side by side.
  void add(std::string name, std::string class_name, const std::vector<std::size_t>& dimensions);
};

/// An open MAT file: its contents, and the values of an array by its index among them, column after column.
struct MatFile {
  MatContents contents;
  std::function<tl::expected<std::vector<double>, InputError>(std::size_t array)> values;
};

/// The number of elements of an array of these dimensions, or more than `most`.
[[nodiscard]] std::size_t mat_count(const std::vector<std::size_t>& dimensions, std::size_t most);

/// Structs in structs that are followed.
inline constexpr int mat_deepest_nesting = 32;

/// Name of an element's field: "run.position", or "run(2).position" in a struct array (`index` from 0).
[[nodiscard]] std::string mat_field_name(const std::string& parent, std::size_t index, std::size_t elements,
                                         const std::string& field);

}  // namespace zwidth::internal
