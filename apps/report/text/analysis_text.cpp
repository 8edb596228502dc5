#include "report/text/analysis_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "report/text/analysis_tables.hpp"
#include "report/text/explanation.hpp"
#include "report/text/limit_rows.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "report/text/wall_note.hpp"

namespace zwidth::report {
namespace {

std::string paragraph(const std::optional<std::string>& text) { return text ? wrap(*text, line_width, 0) + "\n" : ""; }

/// The device with only its crossovers of least stiffness, `most` of them.
AnalysedDevice with_softest_crossovers(AnalysedDevice analysed, std::size_t most) {
  auto& crossovers = analysed.analysis.critical.crossovers;
  std::vector<double> stiffnesses;
  for (const Crossover& crossover : crossovers) stiffnesses.push_back(crossover.stiffness);
  const auto last = stiffnesses.begin() + static_cast<std::ptrdiff_t>(most - 1);
  std::nth_element(stiffnesses.begin(), last, stiffnesses.end());
  std::erase_if(crossovers, [last](const Crossover& crossover) { return crossover.stiffness > *last; });
  return analysed;
}

std::string crossovers(const AnalysedDevice& analysed) {
  // A long delay has hundreds.
  static constexpr std::size_t most = 20;
  if (analysed.analysis.critical.trust.refused()) return "";
  const std::size_t count = analysed.analysis.critical.crossovers.size();
  const std::string title =
      wrap(fmt::format("Phase crossovers with {} (a closed-loop pole on the unit circle), all up to Nyquist at {}{}",
                       words_of(analysed.analysis.limits.user ? Holder::user : Holder::nobody),
                       quantity(0.5 / analysed.device.loop().sampling_period, "Hz"), count == 0 ? ": none" : ""),
           line_width, 0);
  if (count == 0) return title + "\n";
  if (count <= most) return title + layout(crossover_table(analysed)) + "\n";
  return title + layout(crossover_table(with_softest_crossovers(analysed, most))) +
         fmt::format("  ... the {} softest of {}; --json gives all\n\n", most, count);
}

std::string modes(const AnalysedDevice& analysed) {
  const TextTable table = mode_table(analysed);
  return table.rows.size() < 2 ? "" : "Vibration modes\n" + layout(table) + "\n";
}

std::string answer_lines(const AnalysedDevice& analysed) {
  const auto trust = trust_note(analysed.analysis.trust);
  std::string text = limit_lines(analysed) + (trust ? labelled("  trust", *trust) : "");
  if (const auto interval = interval_note(analysed)) text += labelled("  95 % interval", *interval);
  if (const auto worst = worst_user_note(analysed)) text += labelled("  the worst one", *worst);
  if (const auto family = user_family_note(analysed)) text += labelled("  users as given", *family);
  return text + "\n";
}

std::string bullets(const std::vector<std::string>& texts) {
  std::string lines;
  for (const std::string& text : texts) lines += labelled("  - ", text, 4);
  return lines;
}

std::string wall_section(const AnalysedDevice& analysed) {
  const auto verdict = wall_note(analysed);
  const auto filters = wall_filters_text(analysed.device.parameters().wall);
  const std::string encoder = bullets(encoder_notes(analysed));
  if (!verdict && !filters) return encoder.empty() ? "" : encoder + "\n";
  return (filters ? wrap(fmt::format("Filters in the wall, closed in every number here: {}.", *filters), line_width, 0)
                  : "") +
         (verdict ? wrap(*verdict, line_width, 0) + bullets(wall_margin_notes(analysed.analysis)) : "") + encoder +
         "\n";
}

std::string full_answer(const AnalysedDevice& analysed) {
  return answer_lines(analysed) + paragraph(meaning(analysed)) + wall_section(analysed) + crossovers(analysed) +
         modes(analysed) + paragraph(rigid_model_note(analysed)) + paragraph(q_criterion_note(analysed)) +
         "What these numbers leave out\n" + bullets(caveats(analysed));
}

/// The comparison with device names as long as a line allows.
std::string fitted_comparison(std::span<const AnalysedDevice> devices) {
  static constexpr std::size_t shortest_name = 6;
  const std::size_t beside_names = width_of(layout(comparison_table(devices, shortest_name))) - shortest_name;
  return layout(comparison_table(devices, std::max(shortest_name, line_width - std::min(line_width, beside_names))));
}

std::string short_answer(const AnalysedDevice& analysed) {
  return answer_lines(analysed) + paragraph(meaning(analysed)) + wall_section(analysed) +
         paragraph(rigid_model_note(analysed));
}

}  // namespace

std::string analysis_text(std::span<const AnalysedDevice> devices) {
  if (devices.size() == 1) return full_answer(devices.front());
  std::string text = fitted_comparison(devices) + wrap(comparison_legend(devices), line_width, 2) + "\n";
  for (std::size_t i = 0; i < devices.size(); ++i) text += fmt::format("{}. {}", i + 1, short_answer(devices[i]));
  text += wrap(
      "Each device alone (zwidth analyze FILE) gives its walls with a damper and with margins, its crossovers, modes "
      "and "
      "what the numbers leave out.",
      line_width, 0);
  return text;
}

}  // namespace zwidth::report
