#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/output_file.hpp"
#include "reproduce/reproduction.hpp"

namespace zwidth::cli {
namespace {

void run_reproduce(const std::string& directory) {
  report::make_directory(directory);  // first: the figures take seconds
  // Everything is computed before any file is written.
  const std::vector<report::PaperFigure> figures = report::paper_figures();
  const std::string page = report::reproduction_page(figures);
  const std::filesystem::path folder(directory);
  report::OutputFiles files;
  for (const report::PaperFigure& figure : figures) files.write(folder / figure.file, figure.svg);
  const std::string index = folder / "index.html";
  files.write(index, page);
  files.commit();
  write_standard_output(fmt::format("{} figures and the numbers beside the printed ones: {}\n", figures.size(), index));
}

}  // namespace

void add_reproduce(CLI::App& app) {
  auto directory = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("reproduce", "The figures and numbers of the LHIfAM paper, ours beside printed");
  command->add_option("OUTDIR", *directory, "Folder for figure_*.svg and index.html; made where missing")
      ->type_name("")
      ->required();
  command->footer(
      "Examples:\n"
      "  zwidth reproduce paper");
  command->callback([directory] { run_reproduce(*directory); });
}

}  // namespace zwidth::cli
