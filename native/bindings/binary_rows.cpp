// SPDX-License-Identifier: GPL-3.0-or-later
#include "binary_rows.hpp"

#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "arrays.hpp"

namespace py = pybind11;

namespace {

// What binary_rows returns.
using Cells = py::typing::Tuple<std::int64_t, std::int64_t, py::typing::List<Places>, py::typing::List<py::bytes>>;

// A number of up to four bytes.
std::int64_t number_of(std::string_view bytes, bool is_little, bool is_signed) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = static_cast<unsigned char>(bytes[is_little ? bytes.size() - 1 - i : i]);
    value = (value << 8) | byte;
  }
  const std::int64_t range = std::int64_t{1} << (8 * bytes.size());
  return is_signed && 2 * value >= range ? value - range : value;
}

// The rows of a table from a place in data on: each has a cell for each column, numbers of a width in bytes, one where
// the column's count width is 0; otherwise a count of that width, at most 4, negative for signed ones, tells how many.
// Returns the place after the last row, the first row that data does not hold, -1 for none, and of each wanted column
// the count of every row and all its bytes.
Cells binary_rows(const py::bytes& data, std::size_t at, std::int64_t rows, const std::vector<int>& count_widths,
                  const std::vector<int>& widths, const std::vector<std::size_t>& wanted, bool is_little) {
  const auto text = static_cast<std::string_view>(data);
  const std::size_t columns = widths.size();
  const auto are_within = [](const std::vector<int>& numbers, int least, int most) {
    return std::all_of(numbers.begin(), numbers.end(), [&](int number) { return number >= least && number <= most; });
  };
  const bool are_columns = std::all_of(wanted.begin(), wanted.end(), [&](std::size_t of) { return of < columns; });
  if (at > text.size() || count_widths.size() != columns || !are_within(count_widths, -4, 4) ||
      !are_within(widths, 1, 8) || !are_columns) {
    refuse("WRONG_PARAMETER", "There is no such table; pass a place in the data, widths of each column and columns.");
  }
  std::vector<std::size_t> place(columns, columns);  // among those wanted
  for (std::size_t i = 0; i < wanted.size(); ++i) place[wanted[i]] = i;
  std::vector<std::vector<std::int64_t>> counts(wanted.size());
  std::vector<std::string> cells(wanted.size());
  std::int64_t row = 0;
  const auto read_row = [&] {
    for (std::size_t column = 0; column < columns; ++column) {
      std::int64_t count = 1;
      if (const int signed_width = count_widths[column]; signed_width != 0) {
        const auto width = static_cast<std::size_t>(signed_width < 0 ? -signed_width : signed_width);
        if (text.size() - at < width) return false;
        count = number_of(text.substr(at, width), is_little, signed_width < 0);
        at += width;
      }
      const auto width = static_cast<std::size_t>(widths[column]);
      if (count < 0 || text.size() - at < static_cast<std::size_t>(count) * width) return false;
      const std::string_view cell = text.substr(at, static_cast<std::size_t>(count) * width);
      at += cell.size();
      if (place[column] == columns) continue;
      counts[place[column]].push_back(count);
      cells[place[column]] += cell;
    }
    return true;
  };
  // Rows without columns take no bytes: of those there may be any number.
  for (; row < rows && columns > 0; ++row) {
    if (!read_row()) break;
  }
  const bool is_whole = columns == 0 || row >= rows;
  py::typing::List<Places> all_counts;
  py::typing::List<py::bytes> all_cells;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    all_counts.append(Places(static_cast<py::ssize_t>(counts[i].size()), counts[i].data()));
    all_cells.append(py::bytes(cells[i]));
  }
  return py::make_tuple(static_cast<std::int64_t>(at), is_whole ? -1 : row, all_counts, all_cells);
}

}  // namespace

void define_binary_rows(py::module_& module) {
  using py::literals::operator""_a;
  module.def("binary_rows", &binary_rows, "data"_a, "at"_a, "rows"_a, "count_widths"_a, "widths"_a, "wanted"_a,
             "is_little"_a);
}
