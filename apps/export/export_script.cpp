#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "export/export.hpp"
#include "export/octave_script.hpp"
#include "export/python_script.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

/// How a language writes what the scripts hold.
struct Notation {
  std::string_view matrix_start;
  std::string_view row_start;
  std::string_view row_end;
  std::string_view between_rows;
  std::string_view matrix_end;
};
constexpr Notation octave{"[", "", "", ";\n     ", "]"};
constexpr Notation python{"np.array([", "[", "]", ",\n     ", "])"};

std::string literal(const Eigen::MatrixXd& matrix, const Notation& notation) {
  std::string text(notation.matrix_start);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (i > 0) text += notation.between_rows;
    text += notation.row_start;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) text += fmt::format("{}{:.17g}", j > 0 ? ", " : "", matrix(i, j));
    text += notation.row_end;
  }
  return text += notation.matrix_end;
}

/// What a double holds of each coefficient, and what its rounding left out.
struct Rounded {
  Eigen::MatrixXd values;
  Eigen::MatrixXd rests;
};

/// The sampled terms as one matrix: a row of numerator and a row of denominator coefficients per term, ascending.
Rounded term_rows(const SampledPlant& plant) {
  constexpr auto width = static_cast<Eigen::Index>(ModalTerm::max_degree) + 1;
  const Eigen::MatrixXd zeros = Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(plant.terms.size()), width);
  Rounded rows{zeros, zeros};
  Eigen::Index row = 0;
  for (const SampledTerm& term : plant.terms) {
    for (std::size_t i = 0; i <= term.degree; ++i) {
      rows.values(row, static_cast<Eigen::Index>(i)) = term.numerator[i];
      rows.rests(row, static_cast<Eigen::Index>(i)) = term.numerator_rest[i];
    }
    for (std::size_t i = 0; i < term.degree; ++i) {
      rows.values(row + 1, static_cast<Eigen::Index>(i)) = term.denominator[i];
      rows.rests(row + 1, static_cast<Eigen::Index>(i)) = term.denominator_rest[i];
    }
    rows.values(row + 1, static_cast<Eigen::Index>(term.degree)) = 1.0;
    row += 2;
  }
  return rows;
}

/// The terms over one denominator where they nearly cancel: the numerator of their sum, one row; none elsewhere.
Rounded sum_row(const SampledPlant& plant) {
  const auto columns = static_cast<Eigen::Index>(plant.numerator.size());
  if (columns == 0) return {};
  Rounded row{Eigen::Map<const Eigen::RowVectorXd>(plant.numerator.data(), columns), Eigen::RowVectorXd::Zero(columns)};
  if (!plant.numerator_rest.empty()) {
    row.rests = Eigen::Map<const Eigen::RowVectorXd>(plant.numerator_rest.data(), columns);
  }
  return row;
}

Eigen::MatrixXd crossover_rows(const CriticalStiffness& critical) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(critical.crossovers.size()), 2);
  Eigen::Index row = 0;
  for (const Crossover& crossover : critical.crossovers) {
    rows(row, 0) = crossover.frequency;
    rows(row++, 1) = crossover.stiffness;
  }
  return rows;
}

/// The filters of the wall as one matrix each, numerator over denominator, by falling powers of z.
std::string filter_list(const Wall& wall, double period, const Notation& notation, std::string_view start,
                        std::string_view end) {
  std::string text(start);
  for (const WallFilter& filter : wall.filters) {
    const FilterCoefficients z = in_z(filter_section(filter, period));
    Eigen::MatrixXd rows(2, static_cast<Eigen::Index>(z.denominator.size()));
    rows.row(0) = Eigen::Map<const Eigen::RowVectorXd>(z.numerator.data(), rows.cols());
    rows.row(1) = Eigen::Map<const Eigen::RowVectorXd>(z.denominator.data(), rows.cols());
    text += (&filter == &wall.filters.front() ? "" : ", ") + literal(rows, notation);
  }
  return text += end;
}

/// A name as a comment or string of one line: control characters become spaces.
std::string one_line(std::string name) {
  for (char& character : name) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x20 || byte == 0x7f) character = ' ';
  }
  return name;
}

std::string octave_string(const std::string& text) {
  std::string quoted = "'";
  for (const char character : one_line(text)) quoted += character == '\'' ? "''" : std::string(1, character);
  return quoted + "'";
}

/// JSON's escapes are Python's.
std::string python_string(const std::string& text) { return nlohmann::json(one_line(text)).dump(); }

/// What a language calls things.
struct Words {
  std::string_view missing;
  std::string_view list_start;
  std::string_view list_end;
};

/// Behind the device's name in the first comment: whether its numbers are doubtful, and whether a damper is closed in them.
std::string doubt_of(const DeviceModel& model) {
  const auto note = trust_note(model.analysis.trust);
  std::string text = note ? ". " + *note : std::string();
  for (const Remark& remark : model.remarks) text += ". " + remark.what;
  return text;
}

std::string filled_in(std::string_view data, const DeviceModel& model, const Notation& notation, const Words& words,
                      const std::string& name) {
  const Wall& wall = model.wall;
  const Device& device = model.device;
  const DiscreteStateSpace& discrete = model.discrete;
  const auto matrix = [&](const Eigen::MatrixXd& values) { return literal(values, notation); };
  const Rounded terms = term_rows(model.sampled);
  const Rounded sum = sum_row(model.sampled);
  const std::optional<double>& at_nyquist = model.sampled.at_nyquist;
  return fmt::format(
      fmt::runtime(data), fmt::arg("comment", one_line(device.name() + doubt_of(model))),
      fmt::arg("version", ZWIDTH_VERSION), fmt::arg("device", name), fmt::arg("A", matrix(model.continuous.A)),
      fmt::arg("B", matrix(model.continuous.B)), fmt::arg("C", matrix(model.continuous.C)),
      fmt::arg("T", discrete.period), fmt::arg("delay", device.loop().delay), fmt::arg("l", discrete.delay_samples),
      fmt::arg("Phi", matrix(discrete.Phi)), fmt::arg("Gamma1", matrix(discrete.Gamma1)),
      fmt::arg("Gamma2", matrix(discrete.Gamma2)), fmt::arg("Cd", matrix(discrete.C)),
      fmt::arg("terms", matrix(terms.values)), fmt::arg("terms_rest", matrix(terms.rests)),
      fmt::arg("sum", matrix(sum.values)), fmt::arg("sum_rest", matrix(sum.rests)),
      fmt::arg("at_nyquist", at_nyquist ? fmt::format("{:.17g}", *at_nyquist) : std::string(words.missing)),
      fmt::arg("m", model.sampled.delay_samples), fmt::arg("damping", wall.damping),
      fmt::arg("K", wall.stiffness ? fmt::format("{:.17g}", *wall.stiffness) : std::string(words.missing)),
      fmt::arg("missing", wall.stiffness ? "" : ", not given"),
      fmt::arg("a", velocity_filter_pole(wall.velocity_filter_hz, discrete.period)),
      fmt::arg("filters", filter_list(wall, discrete.period, notation, words.list_start, words.list_end)),
      fmt::arg("crossovers", matrix(crossover_rows(model.analysis.critical))));
}

}  // namespace

std::string export_octave(const DeviceModel& model) {
  return filled_in(octave_data, model, octave, {"[]", "{", "}"}, octave_string(model.device.name())) +
         std::string(octave_body);
}

std::string export_python(const DeviceModel& model) {
  return filled_in(python_data, model, python, {"None", "[", "]"}, python_string(model.device.name())) +
         std::string(python_body);
}

}  // namespace zwidth::report
