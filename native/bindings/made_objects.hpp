// SPDX-License-Identifier: GPL-3.0-or-later
// Refuses objects of bound classes whose __init__ never ran: for these pybind11 would hand out uninitialized memory.
#pragma once

#include <pybind11/pybind11.h>

#include "lsgp/lsgp.hpp"

namespace pybind11::detail {

template <typename T>
class made_object_caster : public type_caster_base<T> {
  friend class type_caster_generic;

  void load_value(const value_and_holder& held) {
    if (held.value_ptr() == nullptr) throw type_error(type_id<T>() + " was made without __init__");
    this->value = held.value_ptr();
  }

 public:
  bool load(handle source, bool convert) { return this->template load_impl<made_object_caster>(source, convert); }
};

template <>
class type_caster<lsgp::CompletedCones> : public made_object_caster<lsgp::CompletedCones> {};
template <>
class type_caster<lsgp::CutRouter> : public made_object_caster<lsgp::CutRouter> {};
template <>
class type_caster<lsgp::GrabbedCut> : public made_object_caster<lsgp::GrabbedCut> {};
template <>
class type_caster<lsgp::Preview> : public made_object_caster<lsgp::Preview> {};
template <>
class type_caster<lsgp::Solver> : public made_object_caster<lsgp::Solver> {};

}  // namespace pybind11::detail
