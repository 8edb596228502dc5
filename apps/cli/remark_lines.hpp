#pragma once

#include <span>

#include "zwidth/remark.hpp"

namespace zwidth::cli {

/// Writes every warning to standard error as "zwidth: what; meaning". Notes belong into the report.
void write_warnings(std::span<const Remark> remarks);

}  // namespace zwidth::cli
