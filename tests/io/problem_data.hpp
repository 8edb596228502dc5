#pragma once

#include <fmt/format.h>

#include <string>

#include "zwidth/io/input_error.hpp"
#include "zwidth/words/problem_text.hpp"

namespace zwidth {

/// "bytes_missing bytes=24 left=21 part=name": a problem's code, its numbers and its names.
inline std::string data_of(const Problem& problem) {
  std::string data(name_of(problem.code));
  for (const Evidence& each : problem.evidence) data += fmt::format(" {}={:.6g}", each.name, each.value);
  for (const Subject& each : problem.subjects) data += fmt::format(" {}={}", each.name, each.text);
  return data;
}

/// The same behind its place in the file: "13:1: force: bytes_missing ...".
inline std::string data_of(const InputError& refusal) {
  const InputPlace& place = refusal.place;
  const std::string line = place.line > 0 ? fmt::format("{}:{}: ", place.line, place.column) : "";
  const std::string key = place.key.empty() ? "" : place.key + ": ";
  return line + key + (refusal.problem ? data_of(*refusal.problem) : "no data");
}

}  // namespace zwidth
