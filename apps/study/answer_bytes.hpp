#pragma once

#include <optional>
#include <span>
#include <vector>

#include "zwidth/batch/batch_stiffness.hpp"

namespace zwidth::study_engine {

/// The answers of a chunk as bytes, of this machine's order.
void write_bytes(const BatchStiffness& answers, std::vector<char>& bytes);

/// The answers again; nothing where the bytes are not those of answers.
[[nodiscard]] std::optional<BatchStiffness> answers_of(std::span<const char> bytes);

}  // namespace zwidth::study_engine
