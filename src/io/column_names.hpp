#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "zwidth/io/input_error.hpp"

namespace zwidth::internal {

/// A column's name and the unit that follows it in brackets or parentheses: "F [N]" is F in N. No unit: empty.
struct NameAndUnit {
  std::string_view name;
  std::string_view unit;
};
[[nodiscard]] NameAndUnit name_and_unit(std::string_view column);

/// The name in a cell of a header: in UTF-8, without control characters and doubled quotes.
[[nodiscard]] std::string name_in_cell(std::string_view cell);

/// "F [N]" of F and N (or "[N]", "(N)").
[[nodiscard]] std::string with_unit(const std::string& name, const std::string& unit);

/// The problem with the `columns` that there are and their `names`, the first of them where there are many.
[[nodiscard]] Problem with_columns(Problem problem, std::span<const std::string> columns);

/// Index (from 0) of the column that is asked for: by its exact name, by its name without the unit, by either without
/// regard to case, or by its number from 1 -- the first of these that fits one column.
/// Refused: a name that no column or several have; the error lists the columns and the one that was probably meant.
/// `shown`: how the error lists each column ("force (double 100x1)"); empty: by its name.
[[nodiscard]] tl::expected<std::size_t, InputError> find_column(std::span<const std::string> columns,
                                                                const std::string& asked, const std::string& source,
                                                                std::span<const std::string> shown = {});

}  // namespace zwidth::internal
