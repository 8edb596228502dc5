#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "io/uff_file.hpp"

namespace zwidth::internal {

/// What each record of a file is called: the first of its first ID line, its entity's name, its response point and its
/// other ID lines that no other record shares (else "record 3"), with its unit: "Mic 01 [Pa]".
[[nodiscard]] std::vector<std::string> uff_names(const UffFile& file);

/// "12+Z": node and direction; "12" for a scalar, "12-RX" for a rotation.
[[nodiscard]] std::string uff_point_name(const UffPoint& point);

/// What a record is, in words: "time response, 250 points, every 0.01 s".
[[nodiscard]] std::string uff_description(const UffRecord& record);

/// The refusal of a record that was asked for and is of another kind; `wanted` is a name of the phrase.
[[nodiscard]] InputError wrong_record(const UffFile& file, const UffRecord& record, const std::string& asked,
                                      std::string wanted);

/// Index of the record that is asked for: by its name (with or without the unit), one of its ID lines, its entity's
/// name, its response point, or its number from 1. Refused: a name that no record or several have.
[[nodiscard]] tl::expected<std::size_t, InputError> find_uff_record(const UffFile& file, const std::string& asked);

}  // namespace zwidth::internal
