#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/text/text_table.hpp"

namespace zwidth::report {

/// How a report is read.
enum class Medium { text, page };

/// Writes a report once for both media: text in the lines of a terminal, or HTML. What is empty is left out, and a part
/// without content with its heading.
class Document {
 public:
  explicit Document(Medium medium) : medium_(medium) {}
  [[nodiscard]] bool is_page() const { return medium_ == Medium::page; }

  /// Begins a part, by its heading in the text and on a page; a blank line comes before it.
  void part(std::string in_text, std::string on_page);
  void part(const std::string& heading = "") { part(heading, heading); }

  void paragraph(const std::optional<std::string>& text);
  void list(const std::vector<std::string>& items);
  /// Headings alone are empty.
  void table(const TextTable& table);
  /// A label and its text a line.
  void rows(std::span<const LabelledText> rows);
  /// On a page alone: what `draw` returns as SVG, with ids of `name`.
  void figure(std::string_view name, std::string_view caption, const std::function<std::optional<std::string>()>& draw);
  /// Text or markup of the medium, as it stands.
  void verbatim(std::string_view text) { content_ += text; }

  /// All of it; of a page, the body.
  [[nodiscard]] std::string str() &&;

 private:
  Medium medium_;
  std::string heading_;
  std::string content_;  ///< of the part
  std::string written_;  ///< the parts before it
};

}  // namespace zwidth::report
