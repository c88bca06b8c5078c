// SPDX-License-Identifier: GPL-3.0-or-later
// A std::vector whose sizes and subscripts may be of any integer type: Index, Eigen::Index and int as well as
// std::size_t.
//
// Vertices, corners and triangles have signed indices, as in Eigen; std::vector takes unsigned ones, which would need a
// conversion at every subscript. A negative index converts to a huge value, which the library's assertions catch.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

namespace lsgp {

template <typename T>
class Array : public std::vector<T> {
  using Base = std::vector<T>;
  template <typename Count>
  using if_integer = std::enable_if_t<std::is_integral_v<Count>, int>;

 public:
  using Base::Base;
  Array() = default;
  explicit Array(Base elements) : Base(std::move(elements)) {}
  template <typename Count, if_integer<Count> = 0>
  explicit Array(Count count) : Base(static_cast<std::size_t>(count)) {}
  template <typename Count, if_integer<Count> = 0>
  Array(Count count, const T& value) : Base(static_cast<std::size_t>(count), value) {}

  template <typename Count, if_integer<Count> = 0>
  void assign(Count count, const T& value) {
    Base::assign(static_cast<std::size_t>(count), value);
  }
  template <typename Iterator, typename = typename std::iterator_traits<Iterator>::iterator_category>
  void assign(Iterator begin, Iterator end) {
    Base::assign(begin, end);
  }
  template <typename Count>
  void resize(Count count) {
    Base::resize(static_cast<std::size_t>(count));
  }
  template <typename Count>
  void resize(Count count, const T& value) {
    Base::resize(static_cast<std::size_t>(count), value);
  }
  template <typename Count>
  void reserve(Count count) {
    Base::reserve(static_cast<std::size_t>(count));
  }

  template <typename Integer>
  typename Base::reference operator[](Integer i) {
    return Base::operator[](static_cast<std::size_t>(i));
  }
  template <typename Integer>
  typename Base::const_reference operator[](Integer i) const {
    return Base::operator[](static_cast<std::size_t>(i));
  }
};

// The number of elements as a signed integer (std::ssize).
template <typename Container>
std::ptrdiff_t ssize(const Container& container) {
  return static_cast<std::ptrdiff_t>(container.size());
}

// Element i of a std::vector, as used in the public types, or of a std::array.
template <typename Container, typename Integer>
auto& element(Container& container, Integer i) {
  return container[static_cast<std::size_t>(i)];
}

// Sorts the elements and removes duplicates.
template <typename Container>
void sort_unique(Container& container) {
  std::sort(container.begin(), container.end());
  container.erase(std::unique(container.begin(), container.end()), container.end());
}

}  // namespace lsgp
