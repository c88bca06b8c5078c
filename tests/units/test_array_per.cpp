// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/array_per.hpp"

#include <doctest/doctest.h>

#include <type_traits>
#include <utility>

#include "cut/cut_mesh.hpp"
#include "division/face_graph.hpp"
#include "mesh/per_element.hpp"

namespace {

using lsgp::Array, lsgp::Index, lsgp::PerCopy, lsgp::PerFace, lsgp::PerHalfedge, lsgp::PerTriangle, lsgp::PerVertex;

// No array of one kind becomes one of another, neither by itself nor if asked to.
template <typename To, typename From>
constexpr bool is_kept_apart = !std::is_convertible_v<From, To> && !std::is_constructible_v<To, From> &&
                               !std::is_constructible_v<To, From&> && !std::is_constructible_v<To, const From&> &&
                               !std::is_assignable_v<To&, From> && !std::is_assignable_v<To&, const From&>;
static_assert(is_kept_apart<PerVertex<Index>, PerTriangle<Index>>);
static_assert(is_kept_apart<PerVertex<Index>, PerCopy<Index>>);
static_assert(is_kept_apart<PerHalfedge<char>, PerVertex<char>>);
static_assert(is_kept_apart<PerTriangle<char>, PerFace<char>>);
static_assert(is_kept_apart<PerVertex<char>, PerVertex<Index>>);

// Nor by reference, as functions take them.
static_assert(!std::is_convertible_v<PerTriangle<char>&, const PerVertex<char>&>);
static_assert(!std::is_convertible_v<PerTriangle<char>&, PerVertex<char>&>);

// A list becomes one only if asked to, and any of them may be read as a list.
static_assert(!std::is_convertible_v<Array<Index>, PerVertex<Index>>);
static_assert(!std::is_assignable_v<PerVertex<Index>&, Array<Index>>);
static_assert(std::is_constructible_v<PerVertex<Index>, Array<Index>>);
static_assert(std::is_convertible_v<PerVertex<Index>&, const Array<Index>&>);

// They cost nothing.
static_assert(sizeof(PerVertex<Index>) == sizeof(Array<Index>));
static_assert(std::is_nothrow_move_constructible_v<PerVertex<Index>>);
static_assert(std::is_nothrow_move_assignable_v<PerVertex<Index>>);

}  // namespace

TEST_CASE("an array per element is made from a count, a list or another of its kind") {
  const PerVertex<Index> zeros(3), sevens(3, 7);
  CHECK(zeros == PerVertex<Index>{0, 0, 0});
  CHECK(sevens == PerVertex<Index>{7, 7, 7});
  CHECK(PerVertex<Index>(Array<Index>{1, 2}) == PerVertex<Index>{1, 2});
  PerVertex<Index> taken{4, 5}, copied(taken);
  const Index* where = taken.data();
  const PerVertex<Index> moved(std::move(taken));
  CHECK(moved.data() == where);
  CHECK(moved == copied);
}
