#include "report/text/text_medium.hpp"

#include <algorithm>
#include <utility>

namespace zwidth::report {
namespace {

TextMedium& current_medium() {
  static TextMedium medium;
  return medium;
}

constexpr std::pair<std::string_view, std::string_view> likenesses[] = {
    {"\u00b2", "^2"},       {"\u00b3", "^3"},  {"\u00b5", "u"},  {"\u03bc", "u"},  {"\u00b0", " deg"}, {"\u00b7", "."},
    {"\u00d7", "x"},        {"\u00b1", "+/-"}, {"\u2264", "<="}, {"\u2265", ">="}, {"\u2013", "-"},    {"\u2014", "-"},
    {"\u2018", "'"},        {"\u2019", "'"},   {"\u201c", "\""}, {"\u201d", "\""}, {"\u2026", "..."},  {"\u2192", "->"},
    {"\u221e", "infinity"}, {"\u00c4", "Ae"},  {"\u00d6", "Oe"}, {"\u00dc", "Ue"}, {"\u00e4", "ae"},   {"\u00f6", "oe"},
    {"\u00fc", "ue"},       {"\u00df", "ss"},  {"\u00c5", "A"},  {"\u00e5", "a"},  {"\u00e1", "a"},    {"\u00e0", "a"},
    {"\u00e2", "a"},        {"\u00e3", "a"},   {"\u00e9", "e"},  {"\u00e8", "e"},  {"\u00ea", "e"},    {"\u00eb", "e"},
    {"\u00ed", "i"},        {"\u00ec", "i"},   {"\u00ee", "i"},  {"\u00ef", "i"},  {"\u00f3", "o"},    {"\u00f2", "o"},
    {"\u00f4", "o"},        {"\u00f8", "o"},   {"\u00fa", "u"},  {"\u00f9", "u"},  {"\u00fb", "u"},    {"\u00e7", "c"},
    {"\u00f1", "n"},        {"\u00c9", "E"},   {"\u00cd", "I"},  {"\u00d3", "O"},  {"\u00c1", "A"}};

bool continues_letter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

}  // namespace

void set_text_medium(TextMedium medium) { current_medium() = medium; }

const TextMedium& text_medium() { return current_medium(); }

std::string for_medium(std::string_view text) {
  if (!text_medium().is_ascii) return std::string(text);
  std::string ascii;
  while (!text.empty()) {
    std::size_t length = 1;
    if (static_cast<unsigned char>(text.front()) < 0x80U) {
      ascii += text.front();
    } else {
      while (length < text.size() && continues_letter(text[length])) ++length;
      const auto found =
          std::ranges::find(likenesses, text.substr(0, length), [](const auto& each) { return each.first; });
      ascii += found == std::end(likenesses) ? "?" : found->second;
    }
    text.remove_prefix(length);
  }
  return ascii;
}

}  // namespace zwidth::report
