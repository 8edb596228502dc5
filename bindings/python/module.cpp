#include <pybind11/pybind11.h>

#include "interruptible.hpp"
#include "parts.hpp"

namespace py = pybind11;

/// What PYBIND11_MODULE(_core, module) expands to, behind a question: pybind11 2.10 keeps its types once for the process,
/// and would wait for ever for the lock of a second interpreter.
extern "C" PYBIND11_EXPORT PyObject* PyInit__core() {
  if (PyInterpreterState_Get() != PyInterpreterState_Main()) {
    PyErr_SetString(PyExc_ImportError, "zwidth works in the main interpreter alone, not in a subinterpreter");
    return nullptr;
  }
  PYBIND11_CHECK_PYTHON_VERSION
  PYBIND11_ENSURE_INTERNALS_READY
  static py::module_::module_def definition;
  auto module = py::module_::create_extension_module("_core", nullptr, &definition);
  try {
    module.attr("__version__") = ZWIDTH_VERSION;
    // A module that the main interpreter has loaded is copied into others without the question above.
    module.def("is_main_interpreter", [] { return PyInterpreterState_Get() == PyInterpreterState_Main(); });
    py::module_::import("atexit").attr("register")(py::cpp_function(&zwidth::python::InterpreterEnd::begin));
    zwidth::python::bind_device(module);
    zwidth::python::bind_limits(module);
    zwidth::python::bind_mechanism(module);
    zwidth::python::bind_commands(module);
    return module.ptr();
  }
  PYBIND11_CATCH_INIT_EXCEPTIONS
}
