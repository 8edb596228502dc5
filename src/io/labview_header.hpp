#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace zwidth::internal {

/// How a LabVIEW measurement file saves the x of its rows.
enum class LabviewX { no, one, multi };

/// The tags of one header of a LabVIEW measurement file, each with the cells of its line (the tag itself the first).
class LabviewTags {
 public:
  void add(std::string_view tag, std::vector<std::string> cells) { cells_[std::string(tag)] = std::move(cells); }
  void clear() { cells_.clear(); }

  /// The cell of a tag's line in a column; empty where there is none.
  [[nodiscard]] std::string cell(const std::string& tag, std::size_t column) const;

 private:
  std::map<std::string, std::vector<std::string>> cells_;
};

/// Whether a word is a tag that a segment's header may begin with.
[[nodiscard]] bool is_labview_tag(std::string_view word);

/// The separator that a file's header states in the line "Separator": a tab where it does not.
[[nodiscard]] char labview_separator(std::string_view text);

/// Seconds from a fixed day on at "2013/02/19" and "09:51:40.727" (or with a comma).
[[nodiscard]] std::optional<double> labview_seconds(const std::string& date, const std::string& time);

/// The unit of a label: "N" of "Newtons".
[[nodiscard]] std::string labview_unit(const std::string& label);

}  // namespace zwidth::internal
