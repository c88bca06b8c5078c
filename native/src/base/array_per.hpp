// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays whose type says what their elements belong to.
#pragma once

#include <utility>

#include "base/array.hpp"

namespace lsgp {

// An Array with one element for each thing of a kind, such as the vertices of a mesh, in their order. It converts to
// none of another kind, and a plain list becomes one only if asked to; it may be read as a list itself.
template <typename Kind, typename T>
class ArrayPer : public Array<T> {
  using Base = Array<T>;

 public:
  using Base::Base;
  ArrayPer() = default;
  explicit ArrayPer(Base elements) : Base(std::move(elements)) {}
  template <typename Other, typename U>
  ArrayPer(const ArrayPer<Other, U>& other) = delete;
};

}  // namespace lsgp
