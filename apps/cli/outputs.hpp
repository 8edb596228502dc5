#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/figure/canvas.hpp"
#include "report/output_file.hpp"
#include "report/text/findings_text.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::cli {

struct RequestContext;

/// What the ending of a file name may be.
enum class Ending { any, figure, figure_or_csv, page, hdf5 };

/// Where an answer goes, as the command line says it.
struct OutputArguments {
  bool json = false;
  report::ShownFindings findings = report::ShownFindings::three;  ///< of the text
  std::string csv = {};                                           ///< --csv; empty: none
  std::string figure = {};                                        ///< empty: none
  std::string width = {};                                         ///< of the figure on paper; empty: for a screen
  std::string figure_option = "--output";                         ///< the option that names it
  Ending ending = Ending::figure;                                 ///< of that file
};

inline constexpr const char* explain_help = "In words: every finding, not only the three that matter most";

/// What the help says of each; empty: the command has no such option.
struct OutputHelp {
  std::string json = "Print one JSON document on one line";
  std::string csv = {};
  std::string figure = {};
  std::string explain = {};
};

/// Declares --json, --csv, --explain, the figure's option (--output is -o and --figure, too) and --width; `arguments` must
/// outlive the parsing.
void add_output_options(CLI::App& command, OutputArguments& arguments, const OutputHelp& help);

/// What a command gives out. The files, each asked for with an option: checked before the work, written after it, all or
/// none of them. What it prints: of a request that is its answer, and what is for standard error is left out.
class Outputs {
 public:
  explicit Outputs(const CLI::App& command);
  Outputs(const CLI::App& command, const OutputArguments& arguments) : Outputs(command) { add(arguments); }

  /// Prints all of `answer`. Throws WorkFailed, and BadInput where a request's answer is too long.
  void print(std::string_view answer) const;
  /// The same of text for people: in ASCII where the locale has no other letters.
  void print_text(std::string_view text) const;
  /// Writes `text` for people to standard error.
  void tell(std::string_view text) const noexcept;
  /// Tells every warning as "zwidth: what; meaning". Notes belong into the report.
  void warn(std::span<const Remark> remarks) const;

  void add(const OutputArguments& arguments);
  /// Declares an output; an empty `path` is not asked for. Throws BadInput where its ending is not allowed, where it is
  /// "-" (who can write to standard output takes that before), or the file of another output, which it would replace.
  void add(const std::string& option, const std::string& path, Ending ending = Ending::any);

  /// Throws BadInput where an output is this input: `name` is "device file", "recording", "structure".
  void keep(const std::string& input, std::string_view name) const;
  void keep(const std::vector<std::string>& inputs, std::string_view name) const;

  /// Throws OutputFailed where one could not be written now: before work that cannot be done again.
  void require_writable() const;

  /// The format of a figure that was asked for with this option.
  [[nodiscard]] std::optional<report::FigureFormat> figure(std::string_view option) const;

  /// Writes what `make` returns, where the option asks for a file; where it asks for a figure instead of numbers,
  /// draw() writes it.
  void put(std::string_view option, const std::function<std::string()>& make);
  void put(std::string_view option, const std::function<void(const report::Sink&)>& produce);
  void draw(std::string_view option, const std::function<std::string(report::FigureFormat)>& make);

  /// Shows all that was put and drawn. Throws OutputFailed.
  void commit() { files_.commit(); }

 private:
  struct Output {
    std::string option;
    std::string path;
    std::optional<report::FigureFormat> figure;
  };
  [[nodiscard]] const Output* find(std::string_view option) const;

  RequestContext* request_;
  std::vector<Output> outputs_;
  report::OutputFiles files_;
};

}  // namespace zwidth::cli
