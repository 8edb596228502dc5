#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "cli/request_commands.hpp"
#include "results/json.hpp"

namespace zwidth::python {

/// A document of a command, as it was printed and as values.
class Answer {
 public:
  explicit Answer(cli::RequestAnswer answer);

  [[nodiscard]] const std::string& printed() const { return answer_.printed; }
  [[nodiscard]] const std::optional<std::string>& device() const { return answer_.device; }
  [[nodiscard]] bool is_document() const { return !document_.is_discarded(); }

  /// The value at a JSON pointer ("/crossovers/0") as dict, list, str, float, int, bool or None.
  [[nodiscard]] pybind11::object value(const std::string& pointer) const;
  /// Samples that are not in the document, as an array over their own memory: `self` is this, and lives as long.
  [[nodiscard]] static pybind11::object series(const pybind11::object& self, const std::string& name);
  /// The numbers at a JSON pointer as an array of float64; null is NaN. Rows of equal length make a matrix.
  [[nodiscard]] pybind11::array array(const std::string& pointer) const;

 private:
  cli::RequestAnswer answer_;
  results::Json document_;
};

/// A document's value as Python's own.
[[nodiscard]] pybind11::object to_python(const results::Json& json);

/// An array over the vector itself, which moves into it.
[[nodiscard]] pybind11::array array_over(std::vector<double> values, std::vector<pybind11::ssize_t> shape = {});

}  // namespace zwidth::python
