#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace zwidth {

/// An option that a sentence names, as a field: a front puts its own name there.
struct NamedOption {
  std::string name;        ///< member of an options struct, "skip_rows"; in a front, its name for that
  std::size_t at = 0;      ///< of the sentence, in bytes: where it stands
  std::size_t length = 0;  ///< of what stands there
};

/// The members of options that stand in `backquotes`.
[[nodiscard]] std::vector<NamedOption> options_named_in(std::string_view phrase);

/// A sentence with the options that it names. Only a literal names any: no text of a user is taken for an option.
struct OptionText {
  // NOLINTBEGIN(google-explicit-constructor): a sentence without options is a string
  OptionText(const char* literal);                           ///< with members of options in `backquotes`
  OptionText(std::string plain) : text(std::move(plain)) {}  ///< that names none
  // NOLINTEND(google-explicit-constructor)
  /// As it is.
  OptionText(std::string sentence, std::vector<NamedOption> named)
      : text(std::move(sentence)), options(std::move(named)) {}

  std::string text;                       ///< the sentence
  std::vector<NamedOption> options = {};  ///< in the order in which they stand there
};

/// One behind the other.
[[nodiscard]] OptionText operator+(OptionText begin, const OptionText& end);

}  // namespace zwidth
