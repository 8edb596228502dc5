#include "zwidth/io/input_error.hpp"

#include <fmt/format.h>

#include "io/prose.hpp"

namespace zwidth {
using namespace internal;

std::string InputProblem::str() const {
  std::string text;
  const auto put = [&text](const std::string& part) {
    if (!part.empty()) text += part + ": ";
  };
  put(place.option);
  put(place.line > 0 ? fmt::format("{}:{}:{}", place.file, place.line, place.column) : place.file);
  put(place.key);
  text += what;
  if (!allowed.empty()) text += "; " + allowed;
  // Names come from the file: nothing in them may break the line or reach the terminal as a control sequence.
  return without_controls(text);
}

std::vector<InputProblem> InputError::problems() const {
  std::vector<InputProblem> all{*this};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace zwidth
