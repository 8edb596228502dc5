#include "answer.hpp"

#include <limits>
#include <memory>
#include <utility>

namespace zwidth::python {
namespace py = pybind11;
using results::Json;

namespace {

double number(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Answer::Answer(cli::RequestAnswer answer)
    : answer_(std::move(answer)), document_(Json::parse(answer_.printed, nullptr, /*allow_exceptions=*/false)) {}

py::object Answer::value(const std::string& pointer) const {
  return to_python(document_.at(Json::json_pointer(pointer)));
}

py::array Answer::array(const std::string& pointer) const {
  const Json& rows = document_.at(Json::json_pointer(pointer));
  std::vector<double> values;
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows.size())};
  if (!rows.empty() && rows.front().is_array()) shape.push_back(static_cast<py::ssize_t>(rows.front().size()));
  for (const Json& row : rows) {
    if (!row.is_array()) {
      values.push_back(number(row));
    } else {
      if (row.size() != rows.front().size()) throw py::value_error(pointer + " is no matrix");
      for (const Json& each : row) values.push_back(number(each));
    }
  }
  return array_over(std::move(values), std::move(shape));
}

py::object Answer::series(const py::object& self, const std::string& name) {
  const auto& all = self.cast<const Answer&>().answer_.series;
  const auto found = all.find(name);
  if (found == all.end()) return py::none();
  const auto size = static_cast<py::ssize_t>(found->second.size());
  py::array array(py::dtype::of<double>(), {size}, found->second.data(), self);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array array_over(std::vector<double> values, std::vector<py::ssize_t> shape) {
  if (shape.empty()) shape.push_back(static_cast<py::ssize_t>(values.size()));
  auto kept = std::make_unique<std::vector<double>>(std::move(values));
  double* first = kept->data();
  const py::capsule owner(kept.get(), [](void* vector) { delete static_cast<std::vector<double>*>(vector); });
  kept.release();
  py::array array(py::dtype::of<double>(), std::move(shape), first, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::object to_python(const Json& json) {
  switch (json.type()) {
    case Json::value_t::object: {
      py::dict made;
      for (const auto& [key, value] : json.items()) made[py::str(key)] = to_python(value);
      return made;
    }
    case Json::value_t::array: {
      py::list made(json.size());
      for (std::size_t i = 0; i < json.size(); ++i) made[i] = to_python(json[i]);
      return made;
    }
    case Json::value_t::string:
      return py::str(json.get_ref<const std::string&>());
    case Json::value_t::boolean:
      return py::bool_(json.get<bool>());
    case Json::value_t::number_integer:
      return py::int_(json.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return py::int_(json.get<std::uint64_t>());
    case Json::value_t::number_float:
      return py::float_(json.get<double>());
    default:
      return py::none();
  }
}

}  // namespace zwidth::python
