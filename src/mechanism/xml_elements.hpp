#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace zwidth::internal {

// Where something stands in a text: from a byte to before another.
struct TextRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

struct XmlAttribute {
  std::string_view name;
  std::string_view value;  // as it stands, with its entities
  TextRange range;         // of name="value"
};

struct XmlElement {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::string_view name;
  std::vector<XmlAttribute> attributes;
  std::size_t parent = none;  // among the elements
  std::size_t line = 0;       // from 1
  TextRange range;            // with all that stands in it
  std::size_t opened = 0;     // behind the name in its start tag
  std::size_t entered = 0;    // behind its start tag; the end of the element where that is empty

  // Its value, or an empty one.
  [[nodiscard]] std::string_view value(std::string_view attribute) const;
};

// What is no XML of the kind that is read.
struct XmlProblem {
  std::size_t line = 0;
  std::string why;  // by the name that the phrase of `no_xml` has for it
};

inline constexpr std::size_t most_elements = 10000;
inline constexpr std::size_t most_levels = 60;

// The elements of an XML text in their order, parents ahead of what stands in them.
//
// Declarations of types and entities, CDATA and bytes of 0 are refused: every element of the text is here, whatever its
// bytes. The elements look into the text.
[[nodiscard]] tl::expected<std::vector<XmlElement>, XmlProblem> xml_elements(std::string_view text);

}  // namespace zwidth::internal
