#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "answer.hpp"
#include "interruptible.hpp"
#include "parts.hpp"
#include "python_error.hpp"
#include "results/device_json.hpp"
#include "results/device_keys_json.hpp"
#include "server/api/device_toml.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/model/transfer_function.hpp"

namespace zwidth::python {
namespace py = pybind11;
namespace {

using Overrides = std::vector<std::string>;

Device device_of(tl::expected<Device, InputError> read) {
  if (!read) raise_input_error(read.error());
  return *std::move(read);
}

Device from_file(const std::string& path, const Overrides& overrides) {
  if (path == "-") raise_input_error("device", "is standard input", "a file, or the text itself");
  return device_of(without_lock([&] { return read_device_file(path, overrides); }));
}

std::string toml_of(const Device& device) { return write_device(device.parameters()); }

Device changed(const Device& device, const Overrides& overrides) {
  return device_of(parse_device(toml_of(device), "device", overrides));
}

/// A file's path, or a text: that has more than one line, which no path has.
Device from_toml(const py::object& source, const py::object& set) {
  const auto overrides = py::module_::import("zwidth._device").attr("assignments")(set).cast<Overrides>();
  if (py::isinstance<py::str>(source)) {
    const auto text = py::module_::import("zwidth._device").attr("text_of")("device", source).cast<std::string>();
    if (text.find('\n') != std::string::npos) return device_of(parse_device(text, "device", overrides));
  }
  if (!py::isinstance<py::str>(source) && !py::hasattr(source, "__fspath__")) {
    const auto type = py::str(py::type::of(source).attr("__name__")).cast<std::string>();
    raise_input_error("device", "is of type " + type,
                      "a path, or the text itself: of bytes, what their decode() returns");
  }
  const auto path = py::module_::import("os").attr("fsencode")(source).cast<std::string>();
  if (path.find('\0') != std::string::npos) raise_input_error("device", "has a character of code 0", "a path");
  return from_file(path, overrides);
}

/// The keys of a device file, with tables as dicts.
Device from_keys(const py::kwargs& keys) {
  const auto json = py::module_::import("zwidth._device").attr("json_of")(keys).cast<std::string>();
  const auto toml = server::device_toml(results::Json::parse(json));
  if (!toml) raise_input_error(toml.error());
  return device_of(parse_device(*toml, "device"));
}

Device with(const Device& device, const py::dict& changes, const py::kwargs& keywords) {
  const py::object overrides = py::module_::import("zwidth._device").attr("overrides")(changes, keywords);
  return changed(device, overrides.cast<Overrides>());
}

py::dict numbers_of(const Device& device) {
  py::dict numbers;
  for (const std::string& key : parameter_keys(device.parameters())) {
    numbers[py::str(key)] = py::cast(parameter(device.parameters(), key));
  }
  return numbers;
}

using Matrix = py::array_t<double, py::array::c_style>;

Eigen::MatrixXd matrix_of(const Matrix& entries) {
  if (entries.ndim() != 2) raise_input_error("system", "has a matrix of other than two dimensions", "A, B and C");
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(entries.data(), entries.shape(0), entries.shape(1));
}

/// The keys of [transfer_function], of one force and one position.
py::dict transfer_function_of(const Matrix& A, const Matrix& B, const Matrix& C) {
  const ContinuousStateSpace system{matrix_of(A), matrix_of(B).reshaped(), matrix_of(C).reshaped().transpose()};
  try {
    const TransferFunction made = without_lock([&] { return transfer_function(system); });
    py::dict keys;
    keys["numerator"] = made.numerator;
    keys["denominator"] = made.denominator;
    return keys;
  } catch (const Error& error) {
    raise_input_error("system", error.what(), "");
  }
}

}  // namespace

void bind_device(py::module_& module) {
  py::class_<Device, std::shared_ptr<Device>> bound(module, "Device",
                                                    "A haptic device and its sampled loop; never changes.");
  bound
      .def(py::init(&from_keys),
           "The device of these keys of a device file, tables as dicts: Device(body=[{\"name\": ...}], loop={...}). "
           "Numbers "
           "in SI units, or texts with a unit. Raises InputError with the key.")
      .def(py::init([](const py::object& source) { return from_toml(source, py::tuple()); }), py::arg("source"),
           py::pos_only(), "The device of a file: from_toml(source).")
      .def_static(
          "from_toml", &from_toml, py::arg("source"), py::arg("set") = py::tuple(),
          "Reads a device file: its path, or the text itself (more than one line). `set`: \"KEY=VALUE\" as --set "
          "of the command line. Raises InputError with file, line and column.")
      .def("with_", &with, py::arg("changes") = py::dict(),
           "The device with other numbers: with_(link__stiffness=8e4, body__motor__mass=\"300 g\") or "
           "with_({\"link.stiffness\": 8e4}); the keys of --set, \"__\" for a dot. Raises InputError with the key.")
      .def("to_toml", &toml_of, "The device as TOML text that from_toml() reads back to exactly the same numbers.")
      .def(
          "to_dict", [](const Device& device) { return to_python(results::device_json(device.parameters())); },
          "The keys of the device file, in SI units: Device(**device.to_dict()) is the same device.")
      .def_property_readonly("name", &Device::name, "The device's name.")
      .def_property_readonly(
          "motion",
          [](const Device& device) { return device.parameters().motion == Motion::linear ? "linear" : "rotary"; },
          "\"linear\" (kg, N s/m, N/m) or \"rotary\" (kg m², N m s/rad, N m/rad).")
      .def_property_readonly(
          "sampling_period", [](const Device& device) { return device.loop().sampling_period; }, "T of the loop, s.")
      .def_property_readonly(
          "delay", [](const Device& device) { return device.loop().delay; },
          "Of the loop, in addition to the zero-order hold, s.")
      .def_property_readonly("numbers", &numbers_of,
                             "Every number by its key, as with_() and critical_stiffness_many() take them, SI units; "
                             "None where the device leaves it out.")
      .def("__eq__",
           [](const Device& one, const py::object& other) {
             return py::isinstance<Device>(other) && toml_of(one) == toml_of(other.cast<const Device&>());
           })
      .def("__hash__", [](const Device& device) { return py::hash(py::str(toml_of(device))); })
      .def("_repr_html_",
           [](const Device& device) {
             return "<pre>" + py::module_::import("html").attr("escape")(toml_of(device)).cast<std::string>() +
                    "</pre>";
           })
      .def("__repr__",
           [](const Device& device) {
             return "<zwidth.Device " + py::repr(py::str(device.name())).cast<std::string>() + ">";
           })
      .def("__reduce__", [](const Device& device) {
        return py::make_tuple(py::module_::import("zwidth._device").attr("restored"), py::make_tuple(toml_of(device)));
      });
  module.def("transfer_function_of", &transfer_function_of);
  module.def(
      "device_keys", [] { return to_python(results::device_keys_json()["tables"]); },
      "The keys of a device file: a dict for each table with its \"path\" and its \"keys\", each with unit, range, "
      "default "
      "and a sentence.");
}

}  // namespace zwidth::python
