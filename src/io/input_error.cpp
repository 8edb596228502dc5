#include "zwidth/io/input_error.hpp"

#include <fmt/format.h>

#include "io/prose.hpp"

namespace zwidth {
using namespace internal;

std::string InputError::str() const {
  std::string line_of_text = source;
  if (line > 0) line_of_text += fmt::format(":{}:{}", line, column);
  line_of_text += ": ";
  if (!key.empty()) line_of_text += key + ": ";
  line_of_text += what;
  if (!allowed.empty()) line_of_text += "; " + allowed;
  // Names come from the file: nothing in them may break the line or reach the terminal as a control sequence.
  return without_controls(line_of_text);
}

}  // namespace zwidth
