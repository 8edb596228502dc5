#include "io/cell_splitter.hpp"

#include <algorithm>

#include "io/number_cell.hpp"

namespace zwidth::internal {
namespace {

/// Position of the quote that closes the one at the start of `text`; a doubled quote is a quote inside the cell.
std::size_t closing_quote(std::string_view text) {
  std::size_t quote = text.find('"', 1);
  while (quote != std::string_view::npos && quote + 1 < text.size() && text[quote + 1] == '"')
    quote = text.find('"', quote + 2);
  return quote;
}

}  // namespace

std::span<const std::string_view> CellSplitter::split(std::string_view line) {
  cells_.clear();
  std::string_view rest = delimiter_ == ' ' ? trimmed(line) : line;
  if (delimiter_ == ' ') {
    while (!rest.empty()) add_cell_of_blanks(rest);
  } else if (line.find('"') == std::string_view::npos) {
    add_unquoted_cells(line);
  } else {
    while (rest.data() != nullptr) add_cell(rest);
  }
  return cells_;
}

void CellSplitter::add_unquoted_cells(std::string_view line) {
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(delimiter_, begin), line.size());
    cells_.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

void CellSplitter::add_cell_of_blanks(std::string_view& rest) {
  const std::size_t quote = rest.front() == '"' ? closing_quote(rest) : std::string_view::npos;
  if (quote != std::string_view::npos) {
    cells_.push_back(rest.substr(1, quote - 1));
    rest = trimmed(rest.substr(quote + 1));
    return;
  }
  const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
  cells_.push_back(rest.substr(0, end));
  rest = trimmed(rest.substr(end));
}

/// Moves one cell, quoted or not, from `rest` to the list; `rest` is without data after the last cell.
void CellSplitter::add_cell(std::string_view& rest) {
  const std::string_view begin = trimmed(rest);
  const std::size_t quote = !begin.empty() && begin.front() == '"' ? closing_quote(begin) : std::string_view::npos;
  const bool quoted = quote != std::string_view::npos;
  const std::size_t searched = quoted ? static_cast<std::size_t>(begin.data() - rest.data()) + quote + 1 : 0;
  const std::size_t end = rest.find(delimiter_, searched);
  cells_.push_back(quoted ? begin.substr(1, quote - 1) : trimmed(rest.substr(0, end)));
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
}

}  // namespace zwidth::internal
