#include "report/text/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/text/text_medium.hpp"

namespace zwidth::report {
namespace {

bool starts_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }

/// Characters (code points) of UTF-8 text.
std::size_t length(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

/// Where character number `index` begins; the end of the text for the one after the last.
std::size_t byte_of(std::string_view text, std::size_t index) {
  std::size_t byte = 0;
  for (std::size_t characters = 0; byte < text.size(); ++byte) {
    if (starts_character(text[byte]) && characters++ == index) break;
  }
  return byte;
}

}  // namespace

std::string layout(const TextTable& with_all_letters) {
  TextTable table = with_all_letters;
  for (auto& row : table.rows) {
    for (std::string& cell : row) cell = for_medium(cell);
  }
  std::vector<std::size_t> widths(table.alignment.size(), 0);
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], length(row[i]));
  }
  std::string text;
  for (const auto& row : table.rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - length(row[i]), ' ');
      line += table.alignment[i] == Align::left ? "  " + row[i] + padding : "  " + padding + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::size_t width_of(std::string_view lines) {
  std::size_t widest = 0;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    widest = std::max(widest, length(lines.substr(0, end)));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return widest;
}

std::string wrap(std::string_view text, std::size_t width, std::size_t indent) {
  const std::size_t of_medium = text_medium().line_length;
  return broken(for_medium(text), of_medium > 0 ? of_medium : width, indent);
}

std::string labelled(std::string_view label, std::string_view text, std::size_t indent) {
  return wrap(text, line_width, indent).replace(0, label.size(), label);
}

std::string broken(std::string_view text, std::size_t width, std::size_t indent) {
  std::string wrapped;
  std::string line;
  const auto end_line = [&] { wrapped += std::string(indent, ' ') + line + "\n"; };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    if (!line.empty() && indent + length(line) + 1 + length(word) > width) {
      end_line();
      line.clear();
    }
    if (!line.empty()) line += ' ';
    line += word;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (!line.empty()) end_line();
  return wrapped;
}

std::string lines_of(std::span<const LabelledText> rows) {
  std::string text;
  for (const LabelledText& each : rows) text += labelled(each.label.empty() ? "" : "  " + each.label, each.text);
  return text;
}

std::string shortened(std::string_view text, std::size_t width) {
  const std::size_t whole = length(text);
  if (whole <= width) return std::string(text);
  const std::size_t kept = width - 1;
  const std::size_t at_end = kept / 2;
  return fmt::format("{}…{}", text.substr(0, byte_of(text, kept - at_end)), text.substr(byte_of(text, whole - at_end)));
}

}  // namespace zwidth::report
