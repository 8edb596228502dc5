#pragma once

#include <string>
#include <vector>

namespace zwidth::report {

/// A figure of the paper, as drawn by us.
struct PaperFigure {
  std::string file;     ///< "figure_03.svg"
  std::string title;    ///< what it shows
  std::string caption;  ///< how it relates to the printed one
  std::string svg;
};

/// Every figure that can be drawn so far, in the paper's order. Throws OutputFailed.
[[nodiscard]] std::vector<PaperFigure> paper_figures();

/// What our number says of a printed one.
enum class PaperVerdict {
  none,         ///< nothing is printed, or ours rests on what is
  agrees,       ///< within the digits that are printed, or the tolerance that its reason names
  differs,      ///< it does not
  contradicts,  ///< what is claimed is not so
};

/// A number or claim printed in the paper beside ours.
struct PaperNumber {
  std::string place;       ///< "Eq. 24"
  std::string what;        ///< "Q of Table I"
  std::string printed;     ///< with unit
  std::string ours;        ///< with unit; "-" where not reproduced yet
  std::string difference;  ///< ours - printed, or "agrees"
  std::string reason;
  PaperVerdict verdict = PaperVerdict::none;
};

/// Every number printed in the paper that the core computes, and what is still missing, in the paper's order.
[[nodiscard]] std::vector<PaperNumber> paper_numbers();

/// index.html: figures and numbers on one self-contained page.
[[nodiscard]] std::string reproduction_page(const std::vector<PaperFigure>& figures);

}  // namespace zwidth::report
