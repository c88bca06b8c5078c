// SPDX-License-Identifier: GPL-3.0-or-later
// The one way of arrays of numpy into the bindings. Each is read through a view that has checked its shape and, where
// elements are indices or have to be finite, these; what does not fit is refused by its name, with the errors of the
// package. The Python layer has converted arrays and refused what callers get wrong; this holds whatever it passes.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

// By rows, and aligned, which compilers take for granted; pybind11 copies others.
constexpr int array_layout = pybind11::array::c_style | pybind11::detail::npy_api::NPY_ARRAY_ALIGNED_;

// further: flags, such as that types are converted.
template <typename T, int further = 0>
using ArrayOf = pybind11::array_t<T, array_layout | further>;

// By what they hold.
using Places = ArrayOf<std::int64_t>;
using Vertices = ArrayOf<std::int32_t>;
using Numbers = ArrayOf<double>;
using Marks = ArrayOf<bool>;

// Raises InputError of the package.
[[noreturn]] void refuse(const char* code, const std::string& message);

// The shape of an array and a refusal that names it.
[[noreturn]] void refuse_shape(const char* name, const pybind11::array& array, const std::string& expected);

constexpr pybind11::ssize_t any_length = -1;

// The elements of an array with this many axes, which has to live longer. Subscripts are assertions.
template <typename T, std::size_t axes>
class View {
 public:
  using Length = pybind11::ssize_t;

  // shape: what the array has to have.
  template <int flags>
  View(const char* name, const pybind11::array_t<T, flags>& array, const std::array<Length, axes>& shape)
      : name_(name), data_(array.data()) {
    static_assert((flags & array_layout) == array_layout);
    bool fits = array.ndim() == static_cast<Length>(axes);
    for (std::size_t axis = 0; fits && axis < axes; ++axis) {
      lengths_[axis] = array.shape(static_cast<Length>(axis));
      fits = shape[axis] == any_length || shape[axis] == lengths_[axis];
    }
    if (!fits) refuse_shape(name, array, text_of(shape));
    size_ = array.size();
  }

  template <typename... Indices>
  const T& operator()(Indices... indices) const {
    static_assert(sizeof...(indices) == axes);
    Length at = 0;
    std::size_t axis = 0;
    const auto step = [&](Length index) {
      assert(index >= 0 && index < lengths_[axis]);
      at = at * lengths_[axis++] + index;
    };
    (step(static_cast<Length>(indices)), ...);
    return data_[at];
  }

  Length length(std::size_t axis = 0) const { return lengths_[axis]; }
  Length size() const { return size_; }
  const T* data() const { return data_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }

  // Refuses elements that are not from 0 to count - 1.
  void require_below(std::int64_t count) const {
    for (const T value : *this) {
      if (value >= 0 && value < count) continue;
      refuse("INDEX_OUT_OF_RANGE", std::string(name_) + " holds " + std::to_string(value) + "; pass indices below " +
                                       std::to_string(count) + ".");
    }
  }

  // Refuses numbers that are infinite or NaN, or the latter alone.
  void require_finite() const {
    require_numbers([](T value) { return std::isfinite(value); }, "finite numbers");
  }
  void require_no_nan() const {
    require_numbers([](T value) { return !std::isnan(value); }, "numbers");
  }

 private:
  template <typename IsValid>
  void require_numbers(const IsValid& is_valid, const char* expected) const {
    for (const T value : *this) {
      if (is_valid(value)) continue;
      refuse("WRONG_PARAMETER", std::string(name_) + " holds " + std::to_string(value) + "; pass " + expected + ".");
    }
  }

  static std::string text_of(const std::array<Length, axes>& shape) {
    std::string out;
    for (const Length length : shape) {
      out += (out.empty() ? "(" : ", ") + (length == any_length ? std::string("n") : std::to_string(length));
    }
    return out + (axes == 1 ? ",)" : ")");
  }

  const char* name_;
  const T* data_;
  std::array<Length, axes> lengths_{};
  Length size_ = 0;
};

// The numbers of corners of polygons, `least` at least each and `corner_count` together.
View<std::int64_t, 1> view_of_sizes(const Places& sizes, std::int64_t least, std::int64_t corner_count);
