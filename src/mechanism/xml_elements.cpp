#include "mechanism/xml_elements.hpp"

#include <algorithm>
#include <utility>

namespace zwidth::internal {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool starts_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool is_in_name(char c) { return starts_name(c) || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == ':'; }

class XmlScanner {
 public:
  explicit XmlScanner(std::string_view text) : text_(text) {}

  tl::expected<std::vector<XmlElement>, XmlProblem> read() && {
    if (text_.find('\0') != std::string_view::npos) fail("zero");
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
    while (why_.empty() && find_tag()) read_tag();
    if (why_.empty() && !open_.empty()) fail("unclosed");
    if (why_.empty() && elements_.empty()) fail("none");
    if (!why_.empty()) return tl::unexpected(XmlProblem{line_of(at_), std::move(why_)});
    return std::move(elements_);
  }

 private:
  // Text stands within elements alone.
  bool find_tag() {
    const std::size_t next = text_.find('<', at_);
    const std::string_view before = text_.substr(at_, next == std::string_view::npos ? next : next - at_);
    const bool is_blank = std::ranges::all_of(before, is_space);
    if (open_.empty() && !is_blank) fail("text");
    if (next == std::string_view::npos || !why_.empty()) return false;
    at_ = next;
    return true;
  }

  void read_tag() {
    if (is_here("<?")) return skip("<?", "?>");
    if (is_here("<!--")) return skip("<!--", "-->");
    if (is_here("<!")) return fail("declared");
    if (is_here("</")) return read_end();
    read_start();
  }

  void skip(std::string_view begins, std::string_view ends) {
    const std::size_t end = text_.find(ends, at_ + begins.size());
    if (end == std::string_view::npos) return fail("comment");
    at_ = end + ends.size();
  }

  void read_end() {
    const std::size_t begin = at_;
    at_ += 2;
    const std::string_view name = read_name();
    skip_spaces();
    if (open_.empty() || name.empty() || elements_[open_.back()].name != name || !is_here(">")) {
      at_ = begin;
      return fail("closing");
    }
    ++at_;
    elements_[open_.back()].range.end = at_;
    open_.pop_back();
  }

  void read_start() {
    if (open_.empty() && !elements_.empty()) return fail("roots");
    if (elements_.size() == most_elements) return fail("many");
    if (open_.size() == most_levels) return fail("deep");
    XmlElement element;
    element.range.begin = at_;
    element.line = line_of(at_);
    if (!open_.empty()) element.parent = open_.back();
    ++at_;
    element.name = read_name();
    element.opened = at_;
    if (element.name.empty()) return fail("nameless");
    while (true) {
      const bool is_apart = skip_spaces();
      if (is_here(">") || is_here("/>")) break;
      if (!is_apart) return fail("apart");
      if (!read_attribute(element)) return;
    }
    const bool is_empty = is_here("/>");
    at_ += is_empty ? 2 : 1;
    element.entered = element.range.end = at_;
    if (!is_empty) open_.push_back(elements_.size());
    elements_.push_back(std::move(element));
  }

  bool read_attribute(XmlElement& element) {
    XmlAttribute attribute;
    attribute.range.begin = at_;
    attribute.name = read_name();
    skip_spaces();
    const bool has_value = !attribute.name.empty() && is_here("=");
    if (has_value) ++at_;
    skip_spaces();
    if (!has_value || !(is_here("\"") || is_here("'"))) {
      fail("quotes");
      return false;
    }
    const std::size_t begin = at_ + 1;
    const std::size_t end = text_.find(text_[at_], begin);
    if (end == std::string_view::npos) {
      fail("open");
      return false;
    }
    attribute.value = text_.substr(begin, end - begin);
    at_ = end + 1;
    attribute.range.end = at_;
    const bool is_plain = attribute.value.find('<') == std::string_view::npos;
    if (!is_plain || std::ranges::count(element.attributes, attribute.name, &XmlAttribute::name) > 0) {
      fail(is_plain ? "twice" : "value");
      return false;
    }
    element.attributes.push_back(attribute);
    return true;
  }

  std::string_view read_name() {
    const std::size_t begin = at_;
    if (at_ < text_.size() && starts_name(text_[at_])) {
      while (at_ < text_.size() && is_in_name(text_[at_])) ++at_;
    }
    return text_.substr(begin, at_ - begin);
  }

  bool skip_spaces() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    return at_ > begin;
  }

  [[nodiscard]] bool is_here(std::string_view what) const { return text_.substr(at_).starts_with(what); }

  void fail(std::string why) { why_ = std::move(why); }

  // Asked for rising places.
  std::size_t line_of(std::size_t place) {
    line_ += static_cast<std::size_t>(std::ranges::count(text_.substr(counted_, place - counted_), '\n'));
    counted_ = place;
    return line_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t counted_ = 0;
  std::size_t line_ = 1;
  std::string why_;
  std::vector<std::size_t> open_;
  std::vector<XmlElement> elements_;
};

}  // namespace

std::string_view XmlElement::value(std::string_view attribute) const {
  const auto found = std::ranges::find(attributes, attribute, &XmlAttribute::name);
  return found == attributes.end() ? std::string_view{} : found->value;
}

tl::expected<std::vector<XmlElement>, XmlProblem> xml_elements(std::string_view text) {
  return XmlScanner(text).read();
}

}  // namespace zwidth::internal
