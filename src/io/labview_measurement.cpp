#include "io/labview_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/column_names.hpp"
#include "io/column_unit.hpp"
#include "io/export_lines.hpp"
#include "io/labview_header.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

using LvmRead = tl::expected<void, InputError>;
using Kind = NumberCell::Kind;

constexpr std::string_view lvm_word = "LabVIEW Measurement";
constexpr std::string_view end_of_header = "***End_of_Header***";

/// Where a channel of a segment has its times from.
struct LvmChannel {
  std::size_t x = 0;     ///< column of X values
  bool is_even = false;  ///< X0 + i Delta_X, not that column
  double first = 0.0;    ///< X0
  double step = 0.0;     ///< Delta_X
  double start = 0.0;    ///< of the segment after the first one, in the unit of x
  std::size_t declared = std::numeric_limits<std::size_t>::max();  ///< Samples
  std::size_t rows = 0;                                            ///< of this segment
};

class LvmReader {
 public:
  LvmReader(ExportLines& lines, const RecordingOptions& options) : lines_(lines), options_(options) {
    exported_.source = lines.source();
  }

  tl::expected<ExportedColumns, InputError> read() {
    const auto take_row_or_tag = [this](const ExportLine& line) { return line.is_empty() ? LvmRead() : take(line); };
    if (auto taken = lines_.for_each(take_row_or_tag); !taken) return tl::unexpected(std::move(taken.error()));
    if (state_ != State::rows) {
      return tl::unexpected(InputError{{.file = exported_.source}, {.code = ProblemCode::ends_in_header}});
    }
    end_segment();
    describe();
    return std::move(exported_);
  }

 private:
  enum class State { file_header, segment_header, names, rows };

  LvmRead take(const ExportLine& line) {
    const std::string_view tag = line.cell(0);
    if (is_in_special_) {
      is_in_special_ = tag != "***End_Special***";
      return {};
    }
    switch (state_) {
      case State::file_header:
        return take_file_tag(tag, line);
      case State::segment_header:
        return take_segment_tag(tag, line);
      case State::names:
        return take_names(line);
      default:
        return take_row(tag, line);
    }
  }

  LvmRead take_file_tag(std::string_view tag, const ExportLine& line) {
    const std::string_view value = line.cell(1);
    if (tag == end_of_header) state_ = State::segment_header;
    if (tag == "X_Columns")
      x_columns_ = value == "No" ? LabviewX::no : value == "Multi" ? LabviewX::multi : LabviewX::one;
    if (tag == "Decimal_Separator" && !options_.decimal_mark) {
      if (value != "." && value != ",") {
        return tl::unexpected(
            lines_.refused(line, {.code = ProblemCode::separator_not_possible,
                                  .subjects = {{"of", "decimal_mark"}, {"separator", in_quotes(as_utf8(value))}}}));
      }
      lines_.set_decimal_mark(value.front());
    }
    file_.add(tag, texts(line));
    return {};
  }

  LvmRead take_segment_tag(std::string_view tag, const ExportLine& line) {
    if (tag == end_of_header) {
      state_ = State::names;
      return {};
    }
    if (tag == "***Start_Special***") {
      is_in_special_ = true;
      return {};
    }
    if (read_number(tag, '.').kind != Kind::text) {
      return tl::unexpected(
          lines_.refused(line, {.code = ProblemCode::line_without_header, .subjects = {{"format", "labview"}}}));
    }
    segment_.add(tag, texts(line));
    return {};
  }

  static std::vector<std::string> texts(const ExportLine& line) {
    std::vector<std::string> cells;
    for (const std::string_view cell : line.cells) cells.push_back(name_in_cell(cell));
    return cells;
  }

  [[nodiscard]] bool holds_x(std::size_t column) const {
    return x_columns_ == LabviewX::multi ? column % 2 == 0 : column == 0;
  }

  LvmRead take_names(const ExportLine& line) {
    std::vector<std::string> names = texts(line);
    while (!names.empty() && names.back().empty()) names.pop_back();
    has_comments_ = !names.empty() && names.back() == "Comment";
    if (has_comments_) names.pop_back();
    const bool is_whole = names.size() >= 2 && (x_columns_ != LabviewX::multi || names.size() % 2 == 0);
    if (!is_whole) {
      Problem problem{.code = ProblemCode::section_incomplete, .evidence = {counted("names", names.size())}};
      if (x_columns_ == LabviewX::multi) problem.evidence.push_back(counted("in_turn", 2));
      return tl::unexpected(lines_.refused(line, std::move(problem)));
    }
    ++segments_;
    state_ = State::rows;
    if (segments_ == 1) {
      rows_begin_ = line.line.number + 1;
      names_ = names;
      for (std::size_t c = 0; c < names.size(); ++c) add_column(c, names[c]);
      mark_columns_to_keep(exported_, options_);
    } else if (names != names_) {
      return tl::unexpected(lines_.refused(
          line, {.code = ProblemCode::segment_of_other_columns, .evidence = {counted("segment", segments_)}}));
    }
    return begin_segment(line);
  }

  void add_column(std::size_t c, const std::string& name) {
    ExportedColumn column;
    const std::string x_unit = segment_.cell("X_Unit_Label", holds_x(c) ? c + 1 : c);
    column.holds_times = holds_x(c);
    const std::string unit = seconds_per(x_unit) ? x_unit : "s";
    const std::string time =
        with_unit(x_columns_ == LabviewX::multi && names_.size() > 2 && c + 1 < names_.size() && holds_x(c)
                      ? "time of " + names_[c + 1]
                      : std::string("time"),
                  unit);
    column.name = column.holds_times ? time : name.empty() ? std::to_string(c + 1) : name;
    if (!column.holds_times && name_and_unit(name).unit.empty()) {
      column.name = with_unit(column.name, labview_unit(segment_.cell("Y_Unit_Label", c)));
    }
    if (!column.holds_times && is_time(c)) {
      column.time_name = exported_.columns[x_columns_ == LabviewX::multi ? c - 1 : 0].name;
    }
    exported_.columns.push_back(std::move(column));
  }

  [[nodiscard]] bool is_time(std::size_t c) const {
    const std::string dimension = segment_.cell("X_Dimension", c);
    return dimension.empty() || lower_case(dimension) == "time";
  }

  LvmRead begin_segment(const ExportLine& line) {
    channels_.assign(names_.size(), {});
    if (!lines_.decimal_mark()) {
      for (const char* const tag : {"X0", "Delta_X"}) {
        for (std::size_t c = 1; c < names_.size() && !lines_.decimal_mark(); ++c) {
          if (const auto mark = decimal_mark_in(segment_.cell(tag, c))) lines_.set_decimal_mark(*mark);
        }
      }
    }
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (holds_x(c)) continue;
      LvmChannel& channel = channels_[c];
      channel.x = x_columns_ == LabviewX::multi ? c - 1 : 0;
      const NumberCell first = lines_.number(segment_.cell("X0", c));
      const NumberCell step = lines_.number(segment_.cell("Delta_X", c));
      channel.first = first.kind == Kind::number ? first.value : 0.0;
      channel.step = step.kind == Kind::number ? step.value : 0.0;
      if (const NumberCell samples = read_number(segment_.cell("Samples", c), '.');
          samples.kind == Kind::number && samples.value >= 0.0 && samples.value < 1e15) {
        channel.declared = static_cast<std::size_t>(samples.value);
      }
      if (auto placed = place(c, channel, line); !placed) return placed;
    }
    if (x_columns_ == LabviewX::multi) return {};
    // One column of X values is that of the first channel with the most samples.
    const auto most =
        std::max_element(channels_.begin() + 1, channels_.end(), [](const LvmChannel& a, const LvmChannel& b) {
          const auto size = [](const LvmChannel& channel) {
            return channel.declared == std::numeric_limits<std::size_t>::max() ? 0 : channel.declared;
          };
          return size(a) < size(b);
        });
    for (std::size_t c = 1; c < channels_.size(); ++c) {
      LvmChannel& channel = channels_[c];
      channel.is_even = x_columns_ == LabviewX::no || channel.first != most->first || channel.step != most->step;
      if (!channel.is_even || channel.step > 0.0 || !is_time(c) || options_.rate || !exported_.columns[c].is_kept)
        continue;
      return tl::unexpected(lines_.refused(
          line, {.code = ProblemCode::no_times, .subjects = {{"of", "step"}, {"column", shortened(names_[c])}}}));
    }
    return {};
  }

  /// When the channel's segment began, after the first segment of the first channel that is kept.
  LvmRead place(std::size_t c, LvmChannel& channel, const ExportLine& line) {
    const auto cell = [&](const char* tag) {
      const std::string own = segment_.cell(tag, c);
      return own.empty() ? file_.cell(tag, 1) : own;
    };
    const auto seconds = labview_seconds(cell("Date"), cell("Time"));
    const double unit = seconds_per(segment_.cell("X_Unit_Label", c)).value_or(1.0);
    if (segments_ == 1) {
      begins_.resize(names_.size());
      begins_[c] = first_begin(c, seconds, unit * channel.step);
    }
    if (seconds && begins_[c]) {
      channel.start = (*seconds - *begins_[c]) / unit;
    } else if (segments_ > 1 && !options_.rate && exported_.columns[c].is_kept) {
      return tl::unexpected(lines_.refused(
          line,
          {.code = ProblemCode::no_times, .evidence = {counted("segment", segments_)}, .subjects = {{"of", "start"}}}));
    }
    return {};
  }

  /// From when on a channel's times count: a scanner takes one channel after the other, and so small a part of a period
  /// is remarked; what began later lies later.
  std::optional<double> first_begin(std::size_t c, std::optional<double> seconds, double period) {
    constexpr double largest_skew = 0.1;     // of a period
    constexpr double smallest_skew = 0.001;  // of a period
    if (!seconds || !exported_.columns[c].is_kept) return seconds;
    if (!first_begin_) first_begin_ = seconds;
    const double skew = *seconds - *first_begin_;
    if (!(std::abs(skew) < largest_skew * period) && skew != 0.0) return first_begin_;
    if (std::abs(skew) > smallest_skew * period) {
      exported_.remarks.push_back(
          warning({.code = FindingCode::channel_sampled_off_the_first,
                   .evidence = {{"microseconds", 1e6 * std::abs(skew)}},
                   .subjects = {{"column", in_quotes(names_[c])}, {"side", skew > 0.0 ? "after" : "before"}}}));
    }
    return seconds;
  }

  void end_segment() {
    for (std::size_t c = 1; c < channels_.size(); ++c) {
      const LvmChannel& channel = channels_[c];
      if (x_columns_ != LabviewX::no || channel.declared == 0 || channel.rows <= channel.declared) continue;
      if (!exported_.columns[c].is_kept || !exported_.doubts.empty()) continue;
      exported_.doubts.push_back({.code = FindingCode::more_rows_than_stated,
                                  .evidence = {counted("stated", channel.declared), counted("rows", channel.rows)},
                                  .subjects = {{"column", in_quotes(exported_.columns[c].name)}}});
    }
  }

  LvmRead take_row(std::string_view first, const ExportLine& line) {
    const bool is_text = x_columns_ == LabviewX::no ? !first.empty() : lines_.number(first).kind == Kind::text;
    if (is_text && is_labview_tag(first)) {
      end_segment();
      segment_.clear();
      state_ = State::segment_header;
      widest_ = 0;
      return take_segment_tag(first, line);
    }
    if (is_text) return tl::unexpected(lines_.no_number(line, 0, exported_.columns[0].name));
    if (line.may_be_cut_off && line.cells.size() < std::min(widest_, names_.size())) {
      exported_.remarks.push_back(
          warning({.code = FindingCode::last_line_cut_off,
                   .evidence = {counted("line", line.line.number), counted("cells", line.cells.size()),
                                counted("expected", widest_)},
                   .subjects = {{"document", "recording"}}}));
      return {};
    }
    widest_ = std::max(widest_, line.cells.size());
    for (std::size_t c = names_.size(); c < line.cells.size() && !has_comments_; ++c) {
      if (line.cells[c].empty()) continue;
      return tl::unexpected(lines_.wrong_cells(line, line.cells.size(), names_.size(), "names"));
    }
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (holds_x(c)) continue;
      if (auto added = add_sample(c, line); !added) return added;
    }
    return {};
  }

  LvmRead add_sample(std::size_t c, const ExportLine& line) {
    ExportedColumn& column = exported_.columns[c];
    LvmChannel& channel = channels_[c];
    const std::string_view cell = line.cell(c);
    const bool has_ended = cell.empty() && (channel.rows >= channel.declared ||
                                            (x_columns_ == LabviewX::multi && line.cell(channel.x).empty()));
    if (has_ended) return {};
    double x = channel.first + channel.step * static_cast<double>(channel.rows);
    ++channel.rows;
    ++column.samples;
    ExportedColumn& times = exported_.columns[channel.x];
    const bool is_first_of_x = c == channel.x + 1;
    if (is_first_of_x) ++times.samples;
    if (!column.is_kept && !(is_first_of_x && times.is_kept)) return {};
    if (!channel.is_even) {
      const NumberCell number = lines_.number(line.cell(channel.x));
      if (number.kind != Kind::number) return tl::unexpected(lines_.no_number(line, channel.x, times.name));
      x = number.value;
    }
    const double time = seconds_of(x, channel);
    if (is_first_of_x && times.is_kept) {
      times.lines.add(times.values.size(), line.line.number);
      times.values.push_back(time);
    }
    if (!column.is_kept) return {};
    const NumberCell number = lines_.number(cell);
    if (number.kind == Kind::text && !column.unreadable) column.unreadable = lines_.no_number(line, c, column.name);
    column.lines.add(column.values.size(), line.line.number);
    column.values.push_back(number.value);
    if (!column.time_name.empty()) column.times.push_back(time);
    return {};
  }

  /// From the file's first segment on; x that is absolute, seconds since 1904, says so by its size.
  double seconds_of(double x, const LvmChannel& channel) {
    constexpr double least_absolute = 1e9;  // 1935
    if (x < least_absolute) return x + channel.start;
    if (!origin_) origin_ = x;
    return x - *origin_;
  }

  void describe() {
    const char* times = x_columns_ == LabviewX::no ? "stated" : x_columns_ == LabviewX::multi ? "each" : "one";
    const std::size_t channels = x_columns_ == LabviewX::multi ? names_.size() / 2 : names_.size() - 1;
    exported_.remarks.insert(exported_.remarks.begin(),
                             note({.code = FindingCode::labview_measurement_file,
                                   .evidence = {counted("channels", channels), counted("segments", segments_),
                                                counted("first_row", rows_begin_)},
                                   .subjects = {{"times", times}}}));
  }

  ExportLines& lines_;
  const RecordingOptions& options_;
  ExportedColumns exported_;
  State state_ = State::file_header;
  LabviewX x_columns_ = LabviewX::one;
  LabviewTags file_;
  LabviewTags segment_;
  std::vector<std::string> names_;
  std::vector<LvmChannel> channels_;           ///< of the segment, by column
  std::vector<std::optional<double>> begins_;  ///< what times count from, by column, s
  std::optional<double> first_begin_;          ///< of the first channel that is kept, s
  std::optional<double> origin_;               ///< of absolute times, s
  std::size_t segments_ = 0;
  std::size_t rows_begin_ = 0;
  std::size_t widest_ = 0;  ///< cells of a row of the segment
  bool has_comments_ = false;
  bool is_in_special_ = false;
};

}  // namespace

bool is_labview_measurement(std::string_view text) { return text.starts_with(lvm_word); }

tl::expected<ExportedColumns, InputError> read_labview_measurement(TextLines text, const RecordingOptions& options,
                                                                   const Progress& progress) {
  const char separator = labview_separator(text.buffered());
  if (std::string_view("\t,;").find(separator) == std::string_view::npos) {
    return tl::unexpected(InputError{{.file = text.file().source(), .key = "Separator"},
                                     {.code = ProblemCode::separator_not_possible, .subjects = {{"of", "labview"}}}});
  }
  ExportLines lines(std::move(text), separator, options.decimal_mark, progress);
  return LvmReader(lines, options).read();
}

}  // namespace zwidth::internal
