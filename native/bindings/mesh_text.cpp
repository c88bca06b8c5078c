// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_text.hpp"

#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "arrays.hpp"

namespace py = pybind11;

namespace {

// What split_rows returns.
using TokenRows = py::typing::Tuple<Places, Places, Places, Places>;

std::string_view view_of(const py::bytes& data) { return static_cast<std::string_view>(data); }

// The values without a copy.
template <typename T>
py::array_t<T> array_of(std::vector<T> values) {
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const auto* all = owned.get();
  const py::capsule owner(owned.release(), [](void* kept) { delete static_cast<std::vector<T>*>(kept); });
  return py::array_t<T>(static_cast<py::ssize_t>(all->size()), all->data(), owner);
}

// As bytes.split() of Python.
bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Rows of tokens; see `split_rows`.
class RowSplitter {
 public:
  RowSplitter(std::string_view text, bool comments, bool continued)
      : text_(text), comments_(comments), continued_(continued) {}

  TokenRows split() {
    std::size_t at = 0;
    for (std::int64_t line = 1; at < text_.size(); ++line) {
      std::size_t end = at;
      while (end < text_.size() && text_[end] != '\n' && text_[end] != '\r') ++end;
      add_line(at, end, line);
      at = end + 1;
      if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') ++at;
    }
    return py::make_tuple(array_of(std::move(begins_)), array_of(std::move(ends_)), array_of(std::move(counts_)),
                          array_of(std::move(lines_)));
  }

 private:
  void add_line(std::size_t begin, std::size_t end, std::int64_t line) {
    if (comments_) end = std::min(end, text_.substr(0, end).find('#', begin));
    while (end > begin && is_space(text_[end - 1])) --end;
    if (begin == end) return;
    const bool goes_on = continued_ && text_[end - 1] == '\\';
    if (goes_on) --end;
    if (!joins_ && begin == end) return;
    if (!joins_) {
      counts_.push_back(0);
      lines_.push_back(line);
    }
    for (std::size_t at = begin; at < end;) {
      if (is_space(text_[at])) {
        ++at;
        continue;
      }
      begins_.push_back(static_cast<std::int64_t>(at));
      while (at < end && !is_space(text_[at])) ++at;
      ends_.push_back(static_cast<std::int64_t>(at));
      ++counts_.back();
    }
    joins_ = goes_on;
  }

  std::string_view text_;
  bool comments_, continued_;
  bool joins_ = false;  // the next line goes on with the last row
  std::vector<std::int64_t> begins_, ends_, counts_, lines_;
};

// The tokens of every line that has any, as places in data, (t) each; the number of tokens of each such row, and its
// line, from 1.  comments: a # ends what counts of a line.  continued: a line that ends in a backslash goes on with
// the next one that has something; the row has the number of its first line.
TokenRows split_rows(const py::bytes& data, bool comments, bool continued) {
  return RowSplitter(view_of(data), comments, continued).split();
}

// Tokens of a text by their places.
class Tokens {
 public:
  Tokens(const py::bytes& data, const Places& begins, const Places& ends)
      : text_(view_of(data)), begins_("begins", begins, {any_length}), ends_("ends", ends, {begins_.length()}) {}

  // picks: indices of tokens.
  View<std::int64_t, 1> picked(const Places& picks) const {
    const View<std::int64_t, 1> pick("picks", picks, {any_length});
    pick.require_below(begins_.length());
    return pick;
  }

  std::string_view operator[](std::int64_t token) const {
    const std::int64_t begin = begins_(token), end = ends_(token);
    if (begin < 0 || begin > end || end > static_cast<std::int64_t>(text_.size())) {
      refuse("INDEX_OUT_OF_RANGE", "A token is from " + std::to_string(begin) + " to " + std::to_string(end) +
                                       "; pass places in the text of " + std::to_string(text_.size()) + " bytes.");
    }
    return text_.substr(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
  }
  std::int64_t place(std::int64_t token) const { return begins_(token); }

 private:
  std::string_view text_;
  View<std::int64_t, 1> begins_, ends_;
};

// Python's own conversion: also of infinity, of what over- or underflows, and where the standard library has none.
bool parse_as_python(std::string_view token, double& out) {
  if (token.find('\0') != std::string_view::npos) return false;
  out = PyOS_string_to_double(std::string(token).c_str(), nullptr, nullptr);
  if (out != -1.0 || !PyErr_Occurred()) return true;
  PyErr_Clear();
  return false;
}

// A decimal number with few digits, which one exactly rounded operation converts (Clinger 1990). Returns false where
// the token is anything else.
bool parse_short(std::string_view token, double& out) {
  constexpr std::uint64_t exact_below = std::uint64_t{1} << 53;
  constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                               1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  std::size_t at = 0, digits = 0, decimals = 0;
  const bool negative = !token.empty() && token[0] == '-';
  if (negative) ++at;
  std::uint64_t value = 0;
  const auto read_digits = [&] {
    const std::size_t first = at;
    for (; at < token.size() && is_digit(token[at]); ++at)
      value = 10 * value + static_cast<std::uint64_t>(token[at] - '0');
    digits += at - first;
    return at - first;
  };
  read_digits();
  if (at < token.size() && token[at] == '.') {
    ++at;
    decimals = read_digits();
  }
  if (at != token.size() || digits == 0 || digits > 19 || value > exact_below) return false;
  out = static_cast<double>(value) / powers[decimals];
  if (negative) out = -out;
  return true;
}

// As float(token) of Python, correctly rounded; false where that is no number.
bool parse_number(std::string_view token, double& out) {
  if (parse_short(token, out)) return true;
#ifdef __cpp_lib_to_chars
  const std::size_t sign = !token.empty() && token[0] == '-';
  if (token.size() > sign && (is_digit(token[sign]) || token[sign] == '.')) {
    const auto result = std::from_chars(token.data(), token.data() + token.size(), out);
    if (result.ec == std::errc() && result.ptr == token.data() + token.size()) return true;
  }
#endif
  return parse_as_python(token, out);
}

// As int(token) of Python for what 64 bits hold, but without underscores.
bool parse_number(std::string_view token, std::int64_t& out) {
  if (!token.empty() && token[0] == '+') {
    token.remove_prefix(1);
    if (!token.empty() && token[0] == '-') return false;
  }
  const auto result = std::from_chars(token.data(), token.data() + token.size(), out);
  return result.ec == std::errc() && result.ptr == token.data() + token.size();
}

// The numbers that the picked tokens are, and the index in picks of the first that is none, -1 for none such.
template <typename Number>
py::typing::Tuple<py::array_t<Number>, py::ssize_t> parse_numbers(const py::bytes& data, const Places& begins,
                                                                  const Places& ends, const Places& picks) {
  const Tokens tokens(data, begins, ends);
  const View<std::int64_t, 1> pick = tokens.picked(picks);
  py::array_t<Number> out(pick.length());
  auto numbers = out.template mutable_unchecked<1>();
  for (py::ssize_t i = 0; i < pick.length(); ++i) {
    if (!parse_number(tokens[pick(i)], numbers(i))) return py::make_tuple(out, i);
  }
  return py::make_tuple(out, -1);
}

// Where the first or second of the parts between slashes of each picked token begins and ends; at most two slashes
// separate. A token without slashes has its end as second part.
py::typing::Tuple<Places, Places> slash_parts(const py::bytes& data, const Places& begins, const Places& ends,
                                              const Places& picks, int part) {
  const Tokens tokens(data, begins, ends);
  const View<std::int64_t, 1> pick = tokens.picked(picks);
  Places part_begins(pick.length()), part_ends(pick.length());
  auto begin = part_begins.mutable_unchecked<1>();
  auto end = part_ends.mutable_unchecked<1>();
  for (py::ssize_t i = 0; i < pick.length(); ++i) {
    const std::string_view token = tokens[pick(i)];
    const std::size_t head = std::min(token.find('/'), token.size());
    const std::size_t first = part == 0 ? 0 : std::min(head + 1, token.size());
    const std::size_t last = part == 0 ? head : std::min(token.find('/', first), token.size());
    begin(i) = tokens.place(pick(i)) + static_cast<std::int64_t>(first);
    end(i) = tokens.place(pick(i)) + static_cast<std::int64_t>(last);
  }
  return py::make_tuple(part_begins, part_ends);
}

// The different texts of the picked tokens, in the order in which they first appear, and which one each token is.
py::typing::Tuple<py::typing::List<py::bytes>, Places> distinct_tokens(const py::bytes& data, const Places& begins,
                                                                       const Places& ends, const Places& picks) {
  const Tokens tokens(data, begins, ends);
  const View<std::int64_t, 1> pick = tokens.picked(picks);
  Places which(pick.length());
  auto out = which.mutable_unchecked<1>();
  std::unordered_map<std::string_view, std::int64_t> known;
  py::typing::List<py::bytes> texts;
  std::string_view last;
  std::int64_t last_index = -1;
  for (py::ssize_t i = 0; i < pick.length(); ++i) {
    const std::string_view token = tokens[pick(i)];
    if (last_index < 0 || token != last) {  // statements of a kind stand together
      const auto [entry, is_new] = known.emplace(token, static_cast<std::int64_t>(known.size()));
      if (is_new) texts.append(py::bytes(token.data(), token.size()));
      last = token;
      last_index = entry->second;
    }
    out(i) = last_index;
  }
  return py::make_tuple(texts, which);
}

void append_integer(std::string& out, std::int64_t value) {
  char buffer[24];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

// The shortest text that reads back as the same number of this precision, laid out as repr() of Python does.
template <typename Real>
void append_number(std::string& out, Real value) {
#ifdef __cpp_lib_to_chars
  if (std::isfinite(value)) {
    // [-]d[.ddd]e+dd
    char buffer[40];
    const char* end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific).ptr;
    const char* at = buffer;
    if (*at == '-') out += *at++;
    const char* mark = std::find(at, end, 'e');
    int exponent = 0;
    std::from_chars(mark[1] == '+' ? mark + 2 : mark + 1, end, exponent);
    if (exponent < -4 || exponent >= 16) {
      out.append(at, end);
      return;
    }
    char digits[24];
    int count = 0;
    for (; at < mark; ++at) {
      if (*at != '.') digits[count++] = *at;
    }
    const int whole = exponent + 1;  // digits before the point
    if (whole <= 0) {
      out.append("0.").append(static_cast<std::size_t>(-whole), '0').append(digits, digits + count);
    } else if (whole >= count) {
      out.append(digits, digits + count).append(static_cast<std::size_t>(whole - count), '0').append(".0");
    } else {
      out.append(digits, digits + whole).append(1, '.').append(digits + whole, digits + count);
    }
    return;
  }
#endif
  // Without std::to_chars, as many digits as are always enough for single precision.
  const bool is_double = sizeof(Real) == sizeof(double);
  const std::unique_ptr<char, decltype(&PyMem_Free)> text(
      PyOS_double_to_string(value, is_double ? 'r' : 'g', is_double ? 0 : 9, Py_DTSF_ADD_DOT_0, nullptr), &PyMem_Free);
  if (!text) throw py::error_already_set();
  out += text.get();
}

// A line for each row of numbers, (n, k): the keyword, the numbers, and the ending.
py::bytes format_rows(const py::bytes& keyword, const Numbers& rows, const py::bytes& ending) {
  constexpr std::size_t usual_width = 20;
  const View<double, 2> numbers("rows", rows, {any_length, any_length});
  std::string out;
  out.reserve(usual_width * static_cast<std::size_t>(rows.size()));
  for (py::ssize_t i = 0; i < numbers.length(); ++i) {
    out += view_of(keyword);
    for (py::ssize_t k = 0; k < numbers.length(1); ++k) {
      out += ' ';
      append_number(out, numbers(i, k));
    }
    out += view_of(ending);
  }
  return out;
}

// Appends an element of a column.
using AppendCell = std::function<void(std::string& out, py::ssize_t row)>;

AppendCell cells_of(const py::array& column, py::ssize_t count) {
  const auto of = [&](auto type, const auto& append) -> AppendCell {
    using Type = decltype(type);
    const ArrayOf<Type, py::array::forcecast> values(column);
    return [values, append, row = View<Type, 1>("columns", values, {count})](std::string& out, py::ssize_t i) {
      append(out, row(i));
    };
  };
  const auto number = [](std::string& out, auto value) { append_number(out, value); };
  if (column.dtype().kind() != 'f') return of(std::int64_t{}, append_integer);
  return column.itemsize() == sizeof(float) ? of(float{}, number) : of(double{}, number);
}

// A line for each row of a table: numbers in the precision of their column, with spaces between them.  columns: at
// least one, (n) each.
py::bytes format_table(const std::vector<py::array>& columns) {
  constexpr std::size_t usual_width = 12;
  if (columns.empty()) refuse("WRONG_SHAPE", "columns is empty; pass one at least.");
  const py::ssize_t count = columns.front().size();
  for (const py::array& column : columns) {
    if (column.ndim() != 1 || column.size() != count) {
      refuse_shape("columns", column, "(" + std::to_string(count) + ",)");
    }
  }
  std::vector<AppendCell> cells;
  cells.reserve(columns.size());
  for (const py::array& column : columns) cells.push_back(cells_of(column, count));
  std::string out;
  out.reserve(usual_width * columns.size() * static_cast<std::size_t>(count));
  for (py::ssize_t i = 0; i < count; ++i) {
    for (const AppendCell& append : cells) {
      append(out, i);
      out += ' ';
    }
    out.back() = '\n';
  }
  return out;
}

// A line f for each polygon.  sizes: (f) corners of each.  vertices, coordinates: (c) numbers of each corner, from 1.
// mapped: (f) whether to write the coordinates.
py::bytes format_faces(const Places& sizes, const Marks& mapped, const Places& vertices, const Places& coordinates) {
  constexpr std::size_t usual_width = 16;
  const View<std::int64_t, 1> vertex("vertices", vertices, {any_length});
  const View<std::int64_t, 1> coordinate("coordinates", coordinates, {vertex.length()});
  const View<std::int64_t, 1> size = view_of_sizes(sizes, 0, vertex.length());
  const View<bool, 1> has_coordinates("mapped", mapped, {size.length()});
  std::string out;
  out.reserve(usual_width * static_cast<std::size_t>(vertices.size()));
  py::ssize_t corner = 0;
  for (py::ssize_t f = 0; f < size.length(); ++f) {
    out += 'f';
    for (const py::ssize_t end = corner + size(f); corner < end; ++corner) {
      out += ' ';
      append_integer(out, vertex(corner));
      if (!has_coordinates(f)) continue;
      out += '/';
      append_integer(out, coordinate(corner));
    }
    out += '\n';
  }
  return out;
}

// What `edit_obj` of the package does with a line of an OBJ file whose statement is plain: in one line, without a
// comment.
enum class LineKind { peculiar, other, coordinates, faces };

// Corners v, v/vt or v/vt/vn, at least one, each after blanks.
bool are_plain_corners(std::string_view text) {
  std::size_t at = 0;
  const auto skip = [&](auto accepts) {
    const std::size_t first = at;
    while (at < text.size() && accepts(text[at])) ++at;
    return at > first;
  };
  const auto skip_one = [&](auto accepts) {
    const bool found = at < text.size() && accepts(text[at]);
    at += found;
    return found;
  };
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  const auto is_sign = [](char c) { return c == '-' || c == '+'; };
  const auto is_slash = [](char c) { return c == '/'; };
  int corners = 0;
  while (skip(is_blank) && at < text.size()) {
    skip_one(is_sign);
    if (!skip(is_digit)) return false;
    for (int slashes = 0; slashes < 2 && skip_one(is_slash); ++slashes) {
      skip_one(is_sign);
      skip(is_digit);
    }
    ++corners;
  }
  return at == text.size() && corners > 0;
}

LineKind kind_of(std::string_view line) {
  if (line.find('\\') != std::string_view::npos || (!line.empty() && is_space(line[0]))) return LineKind::peculiar;
  const auto end = std::find_if(line.begin(), line.end(), [](char c) { return is_space(c) || c == '#'; });
  const std::string_view keyword = line.substr(0, static_cast<std::size_t>(end - line.begin()));
  const std::string_view rest = line.substr(keyword.size());
  if (keyword == "f" || keyword == "fo") return are_plain_corners(rest) ? LineKind::faces : LineKind::peculiar;
  if (keyword == "vt") {
    const bool is_plain = !rest.empty() && (rest[0] == ' ' || rest[0] == '\t') && rest.find('#') == rest.npos;
    return is_plain ? LineKind::coordinates : LineKind::peculiar;
  }
  const bool refers = (keyword == "l" || keyword == "surf") && rest.find('/') != rest.npos;
  return refers ? LineKind::peculiar : LineKind::other;
}

// The plain lines of one kind from a position on, up to a number: the kind, their end, and their number.
py::typing::Tuple<py::str, py::ssize_t, py::ssize_t> plain_lines(const py::bytes& data, std::size_t at,
                                                                 std::int64_t most) {
  constexpr const char* names[] = {"", "other", "coordinates", "faces"};
  const std::string_view text = view_of(data);
  LineKind kind = LineKind::peculiar;
  std::int64_t count = 0;
  while (count < most) {
    std::size_t end = at;
    while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
    if (end >= text.size()) break;  // a line without an ending gets none
    const LineKind next = kind_of(text.substr(at, end - at));
    if (next == LineKind::peculiar || (count > 0 && next != kind)) break;
    kind = next;
    ++count;
    at = end + 1;
    if (text[end] == '\r' && at < text.size() && text[at] == '\n') ++at;
  }
  return py::make_tuple(names[static_cast<int>(kind)], at, count);
}

// Lines of faces, each a keyword and corners v, v/vt or v/vt/vn, without comments, with other numbers vt, one for each
// corner; every other byte stays.
py::bytes replace_references(const py::bytes& lines, const Places& numbers) {
  constexpr std::size_t usual_width = 8;
  const std::string_view text = view_of(lines);
  const View<std::int64_t, 1> number("numbers", numbers, {any_length});
  std::string out;
  out.reserve(text.size() + usual_width * static_cast<std::size_t>(numbers.size()));
  py::ssize_t corner = 0;
  bool is_keyword = true;
  for (std::size_t at = 0; at < text.size();) {
    if (is_space(text[at])) {
      is_keyword |= text[at] == '\n' || text[at] == '\r';
      out += text[at++];
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && !is_space(text[end])) ++end;
    const std::string_view token = text.substr(at, end - at);
    at = end;
    if (is_keyword) {
      out += token;
      is_keyword = false;
      continue;
    }
    if (corner == number.length()) refuse("WRONG_SHAPE", "numbers has fewer elements than the lines have corners.");
    const std::size_t head = token.find('/');
    out += token.substr(0, head);
    out += '/';
    append_integer(out, number(corner++));
    const std::size_t tail = head == std::string_view::npos ? head : token.find('/', head + 1);
    if (tail != std::string_view::npos) out += token.substr(tail);
  }
  return out;
}

}  // namespace

void define_mesh_text(py::module_& module) {
  using py::literals::operator""_a;
  module.def("split_rows", &split_rows, "data"_a, "comments"_a, "continued"_a);
  module.def("parse_floats", &parse_numbers<double>, "data"_a, "begins"_a, "ends"_a, "picks"_a);
  module.def("parse_integers", &parse_numbers<std::int64_t>, "data"_a, "begins"_a, "ends"_a, "picks"_a);
  module.def("slash_parts", &slash_parts, "data"_a, "begins"_a, "ends"_a, "picks"_a, "part"_a);
  module.def("distinct_tokens", &distinct_tokens, "data"_a, "begins"_a, "ends"_a, "picks"_a);
  module.def("format_rows", &format_rows, "keyword"_a, "rows"_a, "ending"_a);
  module.def("format_table", &format_table, "columns"_a);
  module.def("format_faces", &format_faces, "sizes"_a, "mapped"_a, "vertices"_a, "coordinates"_a);
  module.def("plain_lines", &plain_lines, "data"_a, "at"_a, "most"_a);
  module.def("replace_references", &replace_references, "lines"_a, "numbers"_a);
}
