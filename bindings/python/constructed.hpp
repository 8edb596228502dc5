#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "answer.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth::python {

/// Takes only objects that were constructed: pybind11 hands out memory without a value in it after `Device.__new__(Device)`.
template <typename Type>
struct ConstructedCaster : pybind11::detail::type_caster_base<Type> {
  bool load(pybind11::handle source, bool convert) {
    namespace detail = pybind11::detail;
    const bool ours = pybind11::isinstance(source, detail::get_type_handle(typeid(Type), true));
    if (ours && !reinterpret_cast<detail::instance*>(source.ptr())->get_value_and_holder().holder_constructed())
      return false;
    return detail::type_caster_base<Type>::load(source, convert);
  }
};

/// Refuses what pybind11 leaves to Python, which by protocols 0 and 1 makes an object of pybind11's base: that ends the process.
template <typename Bound>
void refuse_pickling(Bound& bound) {
  bound.def("__reduce__", [](const pybind11::object& self) -> pybind11::object {
    const auto name = pybind11::str(pybind11::type::of(self).attr("__name__")).cast<std::string>();
    throw pybind11::type_error("cannot pickle a zwidth." + name + ": its to_dict() can be");
  });
}

}  // namespace zwidth::python

namespace pybind11::detail {
template <>
struct type_caster<zwidth::Device> : zwidth::python::ConstructedCaster<zwidth::Device> {};
template <>
struct type_caster<zwidth::CriticalStiffness> : zwidth::python::ConstructedCaster<zwidth::CriticalStiffness> {};
template <>
struct type_caster<zwidth::AbsoluteStabilityLimit> : zwidth::python::ConstructedCaster<zwidth::AbsoluteStabilityLimit> {
};
template <>
struct type_caster<zwidth::CriticalDamping> : zwidth::python::ConstructedCaster<zwidth::CriticalDamping> {};
template <>
struct type_caster<zwidth::AbsoluteStabilityDamping>
    : zwidth::python::ConstructedCaster<zwidth::AbsoluteStabilityDamping> {};
template <>
struct type_caster<zwidth::MechanismModel> : zwidth::python::ConstructedCaster<zwidth::MechanismModel> {};
template <>
struct type_caster<zwidth::MechanismModel::Reached>
    : zwidth::python::ConstructedCaster<zwidth::MechanismModel::Reached> {};
template <>
struct type_caster<zwidth::MechanismAtPose> : zwidth::python::ConstructedCaster<zwidth::MechanismAtPose> {};
template <>
struct type_caster<zwidth::MechanismJoint> : zwidth::python::ConstructedCaster<zwidth::MechanismJoint> {};
template <>
struct type_caster<zwidth::python::Answer> : zwidth::python::ConstructedCaster<zwidth::python::Answer> {};
}  // namespace pybind11::detail
