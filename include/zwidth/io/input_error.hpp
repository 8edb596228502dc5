#pragma once

#include <cstddef>
#include <string>

namespace zwidth {

/// Source of what comes from an override, not from the device file.
inline constexpr const char* override_source = "an override";

/// Where and why an input was refused. str() is one line: "FILE:LINE:COLUMN: key: what is wrong; what is allowed".
struct InputError {
  std::string source;      ///< file name, "standard input", or `override_source`
  std::size_t line = 0;    ///< from 1; 0 where there is no line
  std::size_t column = 0;  ///< from 1; 0 where there is none
  std::string key;         ///< dotted key as in an override, or the name of a recording's column; may be empty
  std::string what;        ///< what is wrong
  std::string allowed;     ///< what is allowed, or the remedy, members of options in `backquotes`; may be empty
  /// One line: "FILE:LINE:COLUMN: key: what is wrong; what is allowed".
  [[nodiscard]] std::string str() const;
};

}  // namespace zwidth
